// The bodies of the solver, which are the ends of slots.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>

namespace scree::solver {

/// A free body with so many slots that they would make too many colours. It is solved as several parts that
/// share its mass, and that move alike after each sweep (mass splitting: Tonge, Benevolenski, Voroshilov
/// 2012, "Mass splitting for jitter-free parallel rigid body simulation", sec. 4). The heaviest of what it
/// may touch are on the same part, and half of the mass is shared out by what they weigh, since a part that
/// carries the hub must stop it: with equal shares of a ball with thousands of grains on it, what it lies on
/// would slow a thousandth of it in a sweep.
struct Hub {
  std::int32_t body;
  std::int32_t first;  ///< of its parts among the bodies of the solver
  std::int32_t parts;
};

/// Whether a slot is on a part of a hub.
SCREE_HD inline bool is_on_part(ConstView<Mobility> mobility, const Slot& slot) {
  return (mobility[slot.i] == Mobility::free && slot.end_i != slot.i) ||
         (mobility[slot.j] == Mobility::free && slot.end_j != slot.j);
}

/// Balls on balls, or on what is not free.
SCREE_HD inline bool is_of_balls(const ConstBodyView& bodies, const Slot& slot) {
  const auto is_ball = [&](std::int32_t body) {
    return bodies.mobility[body] != Mobility::free || bodies.shape[body] == Shape::sphere;
  };
  return is_ball(slot.i) && is_ball(slot.j);
}

/// First all bodies, then padding_body, a body that is not free, then the parts of the hubs, then what balls
/// touch of walls that turn: a body for each slot, which is not free, and moves as the wall does there.
template <class Space>
class SolverBodies {
 public:
  /// Gives the slots their ends, which are the slots' bodies until then. The result does not depend on the
  /// order of threads.
  void number(const ConstBodyView& bodies, View<Slot> slots);

  std::int64_t count() const { return count_; }
  std::int32_t padding_body() const { return static_cast<std::int32_t>(first_part() - 1); }
  ConstView<Hub> hubs() const { return hubs_.view(); }
  /// Number of its hub, of each part of hubs.
  ConstView<std::int32_t> hub_of_parts() const { return hub_of_.view(); }
  /// Share of its hub's mass, of each part.
  ConstView<double> share_of_parts() const { return share_.view(); }
  std::int64_t first_part() const { return first_wall_point_ - hub_of_.size(); }
  std::int64_t first_wall_point() const { return first_wall_point_; }

 private:
  void split_hubs(const ConstBodyView& bodies, View<Slot> slots);
  void number_wall_points(const ConstBodyView& bodies, View<Slot> slots);

  std::int64_t count_ = 0, first_wall_point_ = 0;
  Array<Hub, Space> hubs_;
  Array<std::int32_t, Space> hub_of_;
  Array<double, Space> share_;
};

}  // namespace scree::solver
