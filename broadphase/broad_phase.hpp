// The interface of the broad phase: its input is closed float boxes, its output the potentially colliding set
// (PCS).
#pragma once

#include "broadphase/settings.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"

#include <cstdint>
#include <memory>

namespace scree {

/// A closed axis-aligned box (m, relative to the local origin): boxes that only touch overlap.
struct Aabb {
  float lo[3];
  float hi[3];
};

/// Two bodies whose boxes overlap; i < j.
struct Pair {
  std::int32_t i;
  std::int32_t j;
};

struct BroadPhaseStats {
  int levels = 0;               ///< grid levels in use; 1 if bricks are used
  std::int64_t bricks = 0;      ///< number of bricks; 0 if the grid was searched as a whole
  std::int64_t candidates = 0;  ///< number of box tests made
  std::int64_t pairs = 0;       ///< number of pairs found
};

/// A method that finds the PCS in a space.
template <class Space>
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;

  /// Returns all pairs of overlapping boxes in which at least one body is not fixed (`mobility`). Each pair
  /// is there once and none is missing; their order depends on the input alone. The view is valid until the
  /// next call. Throws RunError naming the body if a bound is NaN, infinite or inverted, or with the number
  /// of bytes needed if the pairs do not fit in memory.
  virtual ConstView<Pair> find(ConstView<Aabb> bounds, ConstView<Mobility> mobility) = 0;

  /// Returns the statistics of the last call of find().
  virtual const BroadPhaseStats& stats() const = 0;
};

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_broad_phase(const BroadPhaseSettings& settings);

}  // namespace scree
