// Bodies in free flight through a substep, alone and in pairs.
#pragma once

#include "core/bodies.hpp"
#include "core/shape_data.hpp"
#include "narrowphase/solid.hpp"
#include "sim/laws/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

/// The free flight of a body through a substep, given by its state at the midpoint.
struct BodyFlight {
  Shape shape;
  Vec3 size;             ///< size as Shape defines it (m)
  Vec3 inverse_inertia;  ///< inverse principal moments of inertia, 1/(kg m^2)
  Vec3 position;         ///< position at the midpoint, without the displacement by the acceleration (m)
  Quat orientation;      ///< orientation at the midpoint
  Vec3 velocity;         ///< velocity at the start (m/s)
  Vec3 spin;             ///< spin at the midpoint (rad/s)
  Vec3 acceleration;     ///< constant acceleration (m/s^2)
  double midpoint;       ///< time of the midpoint, into the substep (s)

  /// Returns the position at the time s into the substep (s).
  SCREE_HD Vec3 position_at(double s) const {
    return position + (s - midpoint) * velocity + (0.5 * s * s) * acceleration;
  }
  SCREE_HD Vec3 velocity_at(double s) const { return velocity + s * acceleration; }

  SCREE_HD bool is_ball() const { return shape == Shape::sphere; }
  SCREE_HD Vec3 axis() const { return orientation * Vec3::UnitZ(); }
  /// Returns the part of a boundary's spin that moves its surfaces (rad/s): all but the spin about its own
  /// axis. Returns exactly 0 if only the rounding of the axis tells the spin from one about it.
  SCREE_HD Vec3 tilting_spin() const {
    constexpr double rounding = 10 * tolerance::unit_length;
    const Vec3 up = axis();
    const Vec3 tilting = spin - up.dot(spin) * up;
    return tilting.norm() > rounding * spin.norm() ? tilting : Vec3(Vec3::Zero());
  }
};

/// A body at one instant of its flight.
struct BodyInstant {
  Solid solid;
  Vec3 velocity;  ///< m/s
  Vec3 spin;      ///< rad/s

  SCREE_HD Vec3 velocity_at(const Vec3& point) const { return velocity + spin.cross(point - solid.position); }
};

SCREE_HD inline BodyInstant instant_of(const BodyFlight& flight, double s) {
  BodyInstant now{
      {flight.position_at(s), flight.orientation, flight.size}, flight.velocity_at(s), flight.spin};
  if (!flight.spin.isZero(0)) {
    rotate_freely(now.solid.orientation, now.spin, flight.inverse_inertia, s - flight.midpoint);
  }
  return now;
}

/// Returns the speed at which the bodies close at a point along the normal (m/s); negative where they
/// separate.
SCREE_HD inline double closing_speed(const Vec3& normal, const Vec3& point, const BodyInstant& i,
                                     const BodyInstant& j) {
  return normal.dot(i.velocity_at(point) - j.velocity_at(point));
}

/// Returns whether two bodies may touch elsewhere than at one smooth surface (at an edge or a corner).
SCREE_HD inline bool have_edges(Shape a, Shape b) {
  return !is_boundary(a) && !is_boundary(b) && (a != Shape::sphere || b != Shape::sphere);
}

/// Returns what the accelerations add in a substep to the relative velocity of two bodies with edges (m/s). A
/// body that rests on a surface made of several bodies may run against an edge of one of them at this speed,
/// since nothing holds it in flight. Returns 0 for bodies without edges.
SCREE_HD inline Vec3 sinking_velocity(const BodyFlight& i, const BodyFlight& j) {
  if (!have_edges(i.shape, j.shape)) return Vec3::Zero();
  return 2 * i.midpoint * (j.acceleration - i.acceleration);
}

/// Two bodies in flight, and which of their meetings count.
struct PairFlight {
  static constexpr int parts = 3;  ///< largest number of surfaces of a pair (Manifold::part)

  BodyFlight i, j;
  double until;           ///< end of the search, into the substep (s)
  double slowest[parts];  ///< speed over which an approach counts at each part (m/s); infinite: none does
  /// An approach that would go on for more than this until the end counts too (m).
  double farthest = HUGE_VAL;
  PairShapes shapes = {};  ///< shape data of i and j
  /// The sinking_velocity() of the two, if an approach must be faster by its normal part to count (m/s).
  Vec3 sinking = Vec3::Zero();

  /// Returns the magnitude of the relative acceleration along a unit normal (m/s^2).
  SCREE_HD double acceleration_along(const Vec3& normal) const {
    return fabs(normal.dot(j.acceleration - i.acceleration));
  }
  /// Returns whether an approach along the normal counts at the time s. What the accelerations have added to
  /// it in this flight cannot make it deep: the rows of the contact hold the bodies against that, and
  /// otherwise a body that is thinner than the distance it falls in a substep would never come to rest.
  SCREE_HD bool counts(int part, const Vec3& normal, double approach, double s) const {
    if (approach > slowest[part] + fabs(normal.dot(sinking))) return true;
    return (approach - s * acceleration_along(normal)) * (until - s) > farthest;
  }
  /// Returns the smaller smallest_size() of the two (m).
  SCREE_HD double smaller_size() const {
    return std::min(smallest_size(i.shape, i.size), smallest_size(j.shape, j.size));
  }
};

/// Returns a bound on how fast rotation moves a body's surface where it is nearest to a partner, if every
/// point of the partner is within `far` of the body's centre (m/s).
SCREE_HD inline double fastest_turn(const BodyFlight& body, double far) {
  if (body.is_ball()) return 0;
  if (is_boundary(body.shape)) return body.tilting_spin().norm() * far;
  return fastest_spin(body.orientation, body.spin, body.inverse_inertia) *
         bounding_radius(body.shape, body.size);
}

/// Returns a bound on the speed that rotation gives any point of a body's surface (m/s); infinite for a
/// boundary that tilts.
SCREE_HD inline double fastest_turn(const BodyFlight& flight) {
  if (is_boundary(flight.shape) && !flight.tilting_spin().isZero(0)) return HUGE_VAL;
  return fastest_turn(flight, 0.0);
}

/// A bound on how fast any two points of the bodies near one another approach, until the search ends (m/s).
struct ApproachBound {
  double linear;                ///< part of the centres' motion
  double turning_i, turning_j;  ///< parts of the surfaces' motion about the centres

  SCREE_HD double turning() const { return turning_i + turning_j; }
  SCREE_HD double speed() const { return linear + turning_i + turning_j; }
};
SCREE_HD inline ApproachBound bound_approach(const PairFlight& pair) {
  // Only motion along the normal counts towards a plane that keeps its normal.
  Vec3 normal = Vec3::Zero();
  for (const BodyFlight* body : {&pair.i, &pair.j}) {
    if (body->shape == Shape::plane && body->tilting_spin().isZero(0)) normal = body->axis();
  }
  const auto speed = [&normal](const Vec3& v) { return normal.isZero(0) ? v.norm() : fabs(normal.dot(v)); };
  const double linear = speed(pair.j.velocity - pair.i.velocity) +
                        speed(pair.j.acceleration - pair.i.acceleration) * pair.until;
  // How far the partner may be from the centre of a boundary that tilts. For other bodies fastest_turn()
  // ignores it.
  const auto far = [&](const BodyFlight& partner) {
    return is_boundary(partner.shape) ? 0.0
                                      : (pair.j.position - pair.i.position).norm() + linear * pair.until +
                                            bounding_radius(partner.shape, partner.size);
  };
  return {linear, fastest_turn(pair.i, far(pair.j)), fastest_turn(pair.j, far(pair.i))};
}
SCREE_HD inline double fastest_approach(const PairFlight& pair) { return bound_approach(pair).speed(); }

}  // namespace scree
