// Visits to contacts on Host: a visit works on eight contacts that lie side by side, with the widest vector
// instructions of the processor.
#pragma once

#include "core/space.hpp"
#include "sim/contacts/ball_blocks.hpp"
#include "sim/contacts/rolling_visits.hpp"
#include "sim/contacts/sweeps.hpp"

#include <cstdint>
#include <type_traits>

namespace scree::solver {

/// Number of contacts on which one visit works.
template <class Space>
inline constexpr int visit_width = std::is_same_v<Space, Host> ? simd::width : 1;

/// Whether contacts of balls are found, and their energy is added up, by kernels for several side by side.
template <class Space, class Real>
inline constexpr bool has_ball_kernels = false;
template <>
inline constexpr bool has_ball_kernels<Host, double> = true;

template <class Real>
using RollBalls = Roll<Real, BallContacts<Real>, TurnBalls>;
template <class Real>
using RollPoints = Roll<Real, PointContacts<Real>, TurnPoints>;
template <class Real>
using PushRollingBalls = PushRolling<Real, BallContacts<Real>, TurnBalls>;
template <class Real>
using PushRollingPoints = PushRolling<Real, PointContacts<Real>, TurnPoints>;

/// A range of consecutive blocks of contacts (simd::width contacts each).
struct Blocks {
  std::int64_t first;  ///< place of the first contact
  std::int64_t count;  ///< number of blocks
  SCREE_LAW std::int64_t place(std::int64_t block) const { return first + block * simd::width; }
};

/// The visits of one instruction set, in one precision. Each function makes its visit to the contacts of some
/// blocks of one colour, and returns the sum over them.
template <class Real>
struct VisitKernels {
  void (*push_balls)(const PushBalls<Real>&, Blocks);
  void (*push_points)(const PushPoints<Real>&, Blocks);
  void (*push_rolling_balls)(const PushRollingBalls<Real>&, Blocks);
  void (*push_rolling_points)(const PushRollingPoints<Real>&, Blocks);
  SweepChange (*sweep_balls)(const SweepBalls<Real>&, Blocks, Real beta);
  SweepChange (*sweep_points)(const SweepPoints<Real>&, Blocks, Real beta);
  SweepChange (*roll_balls)(const RollBalls<Real>&, Blocks, Real beta);
  SweepChange (*roll_points)(const RollPoints<Real>&, Blocks, Real beta);
  Overlaps (*correct_balls)(const CorrectBalls<Real>&, Blocks, Real beta);
  Overlaps (*correct_points)(const CorrectPoints<Real>&, Blocks, Real beta);
  /// Extrapolates the velocities of the bodies from `begin` to before `end`.
  void (*accelerate)(const Accelerate<Real>&, std::int64_t begin, std::int64_t end, Real beta);

  void operator()(const PushBalls<Real>& visit, Blocks blocks) const { push_balls(visit, blocks); }
  void operator()(const PushPoints<Real>& visit, Blocks blocks) const { push_points(visit, blocks); }
  void operator()(const PushRollingBalls<Real>& visit, Blocks blocks) const {
    push_rolling_balls(visit, blocks);
  }
  void operator()(const PushRollingPoints<Real>& visit, Blocks blocks) const {
    push_rolling_points(visit, blocks);
  }
  SweepChange operator()(const SweepBalls<Real>& visit, Blocks blocks, Real beta) const {
    return sweep_balls(visit, blocks, beta);
  }
  SweepChange operator()(const SweepPoints<Real>& visit, Blocks blocks, Real beta) const {
    return sweep_points(visit, blocks, beta);
  }
  SweepChange operator()(const RollBalls<Real>& visit, Blocks blocks, Real beta) const {
    return roll_balls(visit, blocks, beta);
  }
  SweepChange operator()(const RollPoints<Real>& visit, Blocks blocks, Real beta) const {
    return roll_points(visit, blocks, beta);
  }
  Overlaps operator()(const CorrectBalls<Real>& visit, Blocks blocks, Real beta) const {
    return correct_balls(visit, blocks, beta);
  }
  Overlaps operator()(const CorrectPoints<Real>& visit, Blocks blocks, Real beta) const {
    return correct_points(visit, blocks, beta);
  }
};

/// The kernels of contacts of one instruction set.
struct ContactKernels {
  VisitKernels<double> in_double;
  VisitKernels<float> in_float;
  /// Returns a bit for each of `look` slots: whether its two bodies are within their reaches. `reach` also
  /// has an element -1, for empty slots, which is near nothing.
  std::uint64_t (*near)(const Reach* reach, const Slot* slots, const Period* period);
  /// Sets the fields of the contacts of a block that begins at `place`. Returns a bit for each contact whose
  /// bodies may be held apart (FindStage::may_be_held_apart).
  std::uint32_t (*prepare_balls)(const PrepareBalls&, const BallBlock&, std::int64_t place);
  BlockTotals (*account_balls)(const AccountBlocks&, Blocks);

  template <class Real>
  const VisitKernels<Real>& visits() const {
    if constexpr (std::is_same_v<Real, double>) {
      return in_double;
    } else {
      return in_float;
    }
  }
};

/// Returns the kernels of an instruction set, which is one of the names in simd::supported_kernels(). The
/// results of all of them have the same bits.
const ContactKernels& contact_kernels(const char* instruction_set);
/// Returns the kernels of the widest instruction set of this processor.
const ContactKernels& contact_kernels();

// One table for each way in which visit_kernels.cpp is compiled; not all of them exist on every processor.
namespace baseline {
extern const ContactKernels contact_kernels;
}
namespace avx2 {
extern const ContactKernels contact_kernels;
}
namespace avx512 {
extern const ContactKernels contact_kernels;
}

}  // namespace scree::solver
