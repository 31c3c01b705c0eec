// Compiled once for each instruction set; SCREE_LANES names it. It calls nothing that other sources share, so
// that no function of theirs is compiled for more than the program may use.
#include "sim/dynamics/lanes/kernels/books.hpp"
#include "sim/dynamics/lanes/kernels/finding.hpp"
#include "sim/dynamics/lanes/kernels/parting.hpp"
#include "sim/dynamics/lanes/kernels/rolling.hpp"
#include "sim/dynamics/lanes/kernels/sweeps.hpp"
#include "sim/dynamics/lanes/kernels/turning.hpp"
#include "sim/dynamics/lanes/lanes.hpp"

namespace scree::lanes::SCREE_LANES {

extern const Kernels kernels = {.rough = {sweep_balls, sweep_points<true>},
                                .smooth = {sweep_smooth_balls, sweep_points<false>},
                                .touch_balls = touch_balls,
                                .touch_planes = touch_planes,
                                .prepare_balls = prepare_balls,
                                .roll_balls = roll_balls,
                                .roll_points = roll_points,
                                .prepare_points = prepare_points,
                                .book_balls = book_balls,
                                .book_points = book_points,
                                .square_of_balls = square_of_balls,
                                .square_of_points = square_of_points,
                                .book_rolling = book_rolling,
                                .square_of_rolling = square_of_rolling,
                                .fly_balls = fly_balls,
                                .fly_points = fly_points,
                                .turn = turn,
                                .accelerate = accelerate,
                                .push_balls = push_balls,
                                .push_points = push_points,
                                .push_rolling_balls = push_rolling_balls,
                                .push_rolling_points = push_rolling_points,
                                .part_balls = part_balls,
                                .part_points = part_points};

}  // namespace scree::lanes::SCREE_LANES
