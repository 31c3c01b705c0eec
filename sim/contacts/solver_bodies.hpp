// The bodies of the solver, which are the ends of slots.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>

namespace scree::solver {

/// A free body whose many contacts would need too many colours. It is solved as several parts that share its
/// mass and get equal velocities after each sweep (mass splitting: Tonge, Benevolenski, Voroshilov 2012,
/// "Mass splitting for jitter-free parallel rigid body simulation", sec. 4). The heaviest of the bodies that
/// it touches are on the same part. Half of the mass is shared in proportion to the weights of these
/// bodies, since a part with a body that carries the hub must stop the hub: if a ball with thousands of
/// grains on it had equal shares, the body on which it lies would slow down only a thousandth of it in a
/// sweep.
struct Hub {
  std::int32_t body;
  std::int32_t first;  ///< number of its first part among the bodies of the solver
  std::int32_t parts;
};

/// Whether a slot is on a part of a hub.
SCREE_HD inline bool is_on_part(ConstView<Mobility> mobility, const Slot& slot) {
  return (mobility[slot.i] == Mobility::free && slot.end_i != slot.i) ||
         (mobility[slot.j] == Mobility::free && slot.end_j != slot.j);
}

/// Whether a slot is one of balls: each of its bodies is a sphere or not free.
SCREE_HD inline bool is_of_balls(const ConstBodyView& bodies, const Slot& slot) {
  const auto is_ball = [&](std::int32_t body) {
    return bodies.mobility[body] != Mobility::free || bodies.shape[body] == Shape::sphere;
  };
  return is_ball(slot.i) && is_ball(slot.j);
}

SCREE_HD inline bool is_ball_or_plane(Shape shape) { return shape == Shape::sphere || shape == Shape::plane; }

/// Whether a slot of balls is more than one of two balls, or of a ball and a plane that stands still.
SCREE_HD inline bool is_rare(const ConstBodyView& bodies, const Slot& slot) {
  const auto is_wall_point = [&](std::int32_t body, std::int32_t end) {
    return bodies.mobility[body] != Mobility::free && end != body;
  };
  return !is_ball_or_plane(bodies.shape[slot.i]) || !is_ball_or_plane(bodies.shape[slot.j]) ||
         is_wall_point(slot.i, slot.end_i) || is_wall_point(slot.j, slot.end_j);
}

/// The slots that have a contact: those of balls, and the others, which are counted from their first place.
struct FoundPlaces {
  ConstView<std::int32_t> balls, others;
  std::int64_t first_other;

  SCREE_HD std::int64_t size() const { return balls.size() + others.size(); }
  SCREE_HD std::int64_t operator[](std::int64_t k) const {
    return k < balls.size() ? balls[k] : first_other + others[k - balls.size()];
  }
};

/// The bodies of the solver, in this order: all bodies; padding_body, which is not free; the points of
/// turning walls that balls may touch; and the parts of the hubs. The points of walls are one body for each
/// slot, which is not free and has the velocity of the wall at the contact.
template <class Space>
class SolverBodies {
 public:
  /// Numbers the ends of new slots, which are the bodies themselves before the call. There are no hubs
  /// afterwards. The result does not depend on the order of threads.
  void number(const ConstBodyView& bodies, View<Slot> slots);
  /// Splits the hubs into parts, and numbers the ends of the slots in `places` that are found and on hubs.
  /// Returns whether there are hubs, or were before the call. The result depends on the found slots alone,
  /// and not on the order of threads.
  bool split_hubs(const ConstBodyView& bodies, const FoundPlaces& found, View<Slot> places);
  /// Whether any body has so many slots that it may become a hub.
  bool may_have_hubs() const { return may_have_hubs_; }

  std::int64_t count() const { return first_part_ + hub_of_.size(); }
  std::int32_t padding_body() const { return static_cast<std::int32_t>(first_wall_point_ - 1); }
  ConstView<Hub> hubs() const { return hubs_.view(); }
  /// Returns the number of the hub of each part.
  ConstView<std::int32_t> hub_of_parts() const { return hub_of_.view(); }
  /// Returns the share of its hub's mass of each part.
  ConstView<double> share_of_parts() const { return share_.view(); }
  std::int64_t first_wall_point() const { return first_wall_point_; }
  std::int64_t first_part() const { return first_part_; }

 private:
  void number_wall_points(const ConstBodyView& bodies, View<Slot> slots);
  bool find_hubs(const ConstBodyView& bodies, const FoundPlaces& found, ConstView<Slot> places);
  void deal_ends(const ConstBodyView& bodies, const FoundPlaces& found, View<Slot> places);

  std::int64_t first_wall_point_ = 0, first_part_ = 0;
  bool may_have_hubs_ = false;
  Array<Hub, Space> hubs_;
  Array<std::int64_t, Space> hub_number_;  // number of hubs before each body, and of all
  Array<std::int32_t, Space> hub_of_;
  Array<double, Space> share_;
};

}  // namespace scree::solver
