// Visits to contacts on Host in double precision: a visit works on eight contacts that lie side by side, with
// the widest vector instructions of the processor.
#pragma once

#include "core/space.hpp"
#include "sim/contacts/ball_blocks.hpp"
#include "sim/contacts/rolling_visits.hpp"
#include "sim/contacts/sweeps.hpp"

#include <cstdint>

namespace scree::solver {

/// Number of contacts on which one visit works.
template <class Space, class Real>
inline constexpr int visit_width = 1;
template <>
inline constexpr int visit_width<Host, double> = simd::width;

using RollBalls = Roll<double, BallContacts<double>, TurnBalls>;
using RollPoints = Roll<double, PointContacts<double>, TurnPoints>;
using PushRollingBalls = PushRolling<double, BallContacts<double>, TurnBalls>;
using PushRollingPoints = PushRolling<double, PointContacts<double>, TurnPoints>;

/// A range of consecutive blocks of contacts (simd::width contacts each).
struct Blocks {
  std::int64_t first;  ///< place of the first contact
  std::int64_t count;  ///< number of blocks
  SCREE_LAW std::int64_t place(std::int64_t block) const { return first + block * simd::width; }
};

/// The kernels of one instruction set. Each function makes its visit to the contacts of some blocks of one
/// colour, and returns the sum over them.
struct VisitKernels {
  void (*push_balls)(const PushBalls<double>&, Blocks);
  void (*push_points)(const PushPoints<double>&, Blocks);
  void (*push_rolling_balls)(const PushRollingBalls&, Blocks);
  void (*push_rolling_points)(const PushRollingPoints&, Blocks);
  SweepChange (*sweep_balls)(const SweepBalls<double>&, Blocks, double beta);
  SweepChange (*sweep_points)(const SweepPoints<double>&, Blocks, double beta);
  SweepChange (*roll_balls)(const RollBalls&, Blocks, double beta);
  SweepChange (*roll_points)(const RollPoints&, Blocks, double beta);
  Overlaps (*correct_balls)(const CorrectBalls<double>&, Blocks, double beta);
  Overlaps (*correct_points)(const CorrectPoints<double>&, Blocks, double beta);
  /// Returns a bit for each of `look` slots: whether its two bodies are within their reaches. `reach` also
  /// has an element -1, for empty slots, which is near nothing.
  std::uint64_t (*near)(const Reach* reach, const Slot* slots, const Period* period);
  /// Sets the fields of the contacts of a block that begins at `place`. Returns a bit for each contact whose
  /// bodies may be held apart (FindStage::may_be_held_apart).
  std::uint32_t (*prepare_balls)(const PrepareBalls&, const BallBlock&, std::int64_t place);
  BlockTotals (*account_balls)(const AccountBlocks&, Blocks);
  /// Extrapolates the velocities of the bodies from `begin` to before `end`.
  void (*accelerate)(const Accelerate<double>&, std::int64_t begin, std::int64_t end, double beta);

  void operator()(const PushBalls<double>& visit, Blocks blocks) const { push_balls(visit, blocks); }
  void operator()(const PushPoints<double>& visit, Blocks blocks) const { push_points(visit, blocks); }
  void operator()(const PushRollingBalls& visit, Blocks blocks) const { push_rolling_balls(visit, blocks); }
  void operator()(const PushRollingPoints& visit, Blocks blocks) const { push_rolling_points(visit, blocks); }
  SweepChange operator()(const SweepBalls<double>& visit, Blocks blocks, double beta) const {
    return sweep_balls(visit, blocks, beta);
  }
  SweepChange operator()(const SweepPoints<double>& visit, Blocks blocks, double beta) const {
    return sweep_points(visit, blocks, beta);
  }
  SweepChange operator()(const RollBalls& visit, Blocks blocks, double beta) const {
    return roll_balls(visit, blocks, beta);
  }
  SweepChange operator()(const RollPoints& visit, Blocks blocks, double beta) const {
    return roll_points(visit, blocks, beta);
  }
  Overlaps operator()(const CorrectBalls<double>& visit, Blocks blocks, double beta) const {
    return correct_balls(visit, blocks, beta);
  }
  Overlaps operator()(const CorrectPoints<double>& visit, Blocks blocks, double beta) const {
    return correct_points(visit, blocks, beta);
  }
};

/// Returns the kernels of an instruction set, which is one of the names in simd::supported_kernels(). The
/// results of all of them have the same bits.
const VisitKernels& visit_kernels(const char* instruction_set);
/// Returns the kernels of the widest instruction set of this processor.
const VisitKernels& visit_kernels();

// One table for each way in which visit_kernels.cpp is compiled; not all of them exist on every processor.
namespace baseline {
extern const VisitKernels visit_kernels;
}
namespace avx2 {
extern const VisitKernels visit_kernels;
}
namespace avx512 {
extern const VisitKernels visit_kernels;
}

}  // namespace scree::solver
