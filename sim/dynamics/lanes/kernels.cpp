// Compiled once for each instruction set; SCREE_LANES names it. It calls nothing that other sources share, so
// that no function of theirs is compiled for more than the program may use.
#include "sim/dynamics/lanes/kernels/turning.hpp"
#include "sim/dynamics/lanes/lanes.hpp"

namespace scree::lanes::SCREE_LANES {

extern const Kernels kernels = {.turn = turn};

}  // namespace scree::lanes::SCREE_LANES
