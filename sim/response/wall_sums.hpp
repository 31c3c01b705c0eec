// What contacts give to bodies that are not free, added up over a step.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>
#include <deque>

namespace scree::solver {

/// On a body that is not free.
struct WallImpulse {
  Vec3 impulse = Vec3::Zero();  ///< N s
  Vec3 moment = Vec3::Zero();   ///< about the centre of the body (N m s)

  SCREE_HD friend WallImpulse operator+(const WallImpulse& a, const WallImpulse& b) {
    return {a.impulse + b.impulse, a.moment + b.moment};
  }
};

/// Slots with such a body, side by side in the order of these bodies. Their sums are trees whose shapes
/// depend on the slots alone.
template <class Space>
class WallSums {
 public:
  /// Nothing has been given to any body yet.
  void start_step(std::int64_t bodies);
  /// The slots are others.
  void take(ConstView<Slot> places, const ConstBodyView& bodies);

  bool is_empty() const { return impulses_.empty(); }
  /// Of each place, the number of its slot here; -1 for most.
  ConstView<std::int32_t> entry_of_place() const { return entry_of_.view(); }
  /// Of each slot here, of a substep: none yet.
  View<WallImpulse> clear_impulses();
  /// Adds the impulses to the totals of their bodies.
  void add_up();

  /// Of each body over the step, by place.
  const Array<WallImpulse, Space>& totals() const { return totals_; }
  /// Back to what they were.
  void restore_totals(const Array<WallImpulse, Space>& totals) { copy(totals_, totals); }

 private:
  /// Neighbours that are added up at once, and the body of each such group.
  struct Level {
    Array<std::int64_t, Space> begin;  ///< of each group in the level below; one more than groups
    Array<std::int32_t, Space> body;
    Array<WallImpulse, Space> sums;
  };

  Array<std::int32_t, Space> entry_of_;
  Array<std::int32_t, Space> body_;  // of each slot here
  Array<WallImpulse, Space> impulses_, totals_;
  std::deque<Level> levels_;
  std::size_t used_levels_ = 0;
};

}  // namespace scree::solver
