// The inside of a tube: its wall and its caps. A tube has an inner side only: bodies outside do not touch it.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/solid.hpp"

namespace scree {

/// Values of Manifold::part for contacts with a tube: the wall, or the cap at the negative or positive end of
/// its axis. Each is a separate surface: a ball that rests on the wall still bounces off a cap.
enum TubePart : std::int32_t { tube_wall, tube_cap_below, tube_cap_above };

namespace detail {

// All positions here are relative to the tube's centre.

SCREE_HD inline Solid relative_to(const Solid& tube, const Solid& body) {
  return {body.position - tube.position, body.orientation, body.size};
}

/// Moves the contact points of `count` manifolds back to where the tube is, and returns that number.
SCREE_HD inline int place_at(const Solid& tube, int count, Manifold* out) {
  for (int m = 0; m < count; ++m) {
    for (int k = 0; k < out[m].count; ++k) out[m].points[k].position += tube.position;
  }
  return count;
}

/// Returns whether a body with this centre is in the tube with the given axes. A body that is beyond the wall
/// or a cap by no more than the margin has come from inside since the step began, and is held.
SCREE_HD inline bool is_in_tube(const Solid& tube, const Mat3& axes, const Vec3& centre, double margin) {
  const Vec3 at = axes.transpose() * centre;
  return hypot(at.x(), at.y()) <= tube.size.x() + margin && fabs(at.z()) <= tube.size.z() + margin;
}

/// Finds the contact of a ball with the wall, or of a point if the radius is 0. A ball that is wider than the
/// tube overlaps it wherever it is.
SCREE_HD inline bool wall_contact(const Solid& tube, const Mat3& axes, const Vec3& centre, double radius,
                                  BoxFeature feature, double margin, Manifold& out) {
  const Vec3 at = axes.transpose() * centre;
  const double from_axis = hypot(at.x(), at.y());
  const double to_wall = tube.size.x() - from_axis;
  const double gap = to_wall - radius;
  if (gap > margin) return false;
  // On the axis no direction to the wall is shorter than another; any fixed one will do.
  const Vec3 outward = from_axis > tolerance::coincident * tube.size.x()
                           ? Vec3(axes * (Vec3(at.x(), at.y(), 0.0) / from_axis))
                           : Vec3(axes.col(0));
  set_single(out, outward, {centre + 0.5 * (radius + to_wall) * outward, gap, feature});
  out.part = tube_wall;
  return true;
}

/// Returns the plane in which a cap lies.
SCREE_HD inline Solid tube_cap(const Solid& tube, const Mat3& axes, TubePart part) {
  const Quat half_turn(0, 1, 0, 0);
  const bool below = part == tube_cap_below;
  return {(below ? -tube.size.z() : tube.size.z()) * axes.col(2),
          below ? tube.orientation : tube.orientation * half_turn, Vec3::Zero()};
}

}  // namespace detail

}  // namespace scree
