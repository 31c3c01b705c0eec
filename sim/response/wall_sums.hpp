// Impulses and moments of contacts on bodies that are not free, summed over a step.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>
#include <deque>
#include <vector>

namespace scree::solver {

/// Impulse and moment on a body that is not free: six numbers.
struct WallImpulse {
  static constexpr int numbers = 6;

  Vec3 impulse = Vec3::Zero();  ///< total impulse (N s)
  Vec3 moment = Vec3::Zero();   ///< about the centre of the body (N m s)

  SCREE_HD friend WallImpulse operator+(const WallImpulse& a, const WallImpulse& b) {
    return {a.impulse + b.impulse, a.moment + b.moment};
  }
};

/// The sums over all slots that have a body that is not free, listed here in the order of these bodies. Each
/// sum is a tree whose shape depends on the slots alone, so that it does not depend on the order of threads.
template <class Space>
class WallSums {
 public:
  /// Lists the bodies that are not free, and sets their totals to zero.
  void list_walls(ConstView<Mobility> mobility);
  /// Sets all totals to zero.
  void start_step();
  /// Lists the slots anew, after new candidates. If no walls are listed, nothing is summed up.
  void take(ConstView<Slot> places, const ConstBodyView& bodies);

  bool is_empty() const { return impulses_.empty(); }
  /// Returns for each place of a slot its index in this list; -1 if it is not in it.
  ConstView<std::int32_t> entry_of_place() const { return entry_of_.view(); }
  /// Sets the impulses of a substep to zero, and returns them: one for each slot in the list.
  View<WallImpulse> clear_impulses();
  /// Adds the impulses to the totals of their bodies.
  void add_up();

  /// Returns the total of the body at a place over the step; zero if the body is free.
  WallImpulse total_of(std::int32_t place) const;
  /// Returns the total of each body that is not free, in the order of their places.
  const Array<WallImpulse, Space>& totals() const { return totals_; }
  /// Returns the totals of `bodies` bodies, by place.
  std::vector<WallImpulse> totals_by_place(std::int64_t bodies) const;
  /// Sets the totals back to a copy made before.
  void restore_totals(const Array<WallImpulse, Space>& totals) { copy(totals_, totals); }

 private:
  /// A level of the tree: groups of neighbouring entries of the level below, and the sum of each group.
  struct Level {
    Array<std::int64_t, Space> begin;  ///< first entry of each group in the level below; one more than groups
    Array<std::int32_t, Space> body;   ///< body of each group
    Array<WallImpulse, Space> sums;
  };

  Array<std::int32_t, Space> walls_;  // the bodies that are not free, by place
  std::vector<std::int32_t> walls_on_host_;
  Array<std::int32_t, Space> entry_of_;
  Array<std::int32_t, Space> body_;  // body of each slot in the list
  Array<WallImpulse, Space> impulses_;
  Array<WallImpulse, Space> totals_;  // of each of walls_
  std::deque<Level> levels_;
  std::size_t used_levels_ = 0;
};

}  // namespace scree::solver
