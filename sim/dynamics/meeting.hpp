// When two bodies in flight meet: at any speed, linear or angular.
#pragma once

#include "core/bodies.hpp"
#include "narrowphase/contact.hpp"
#include "narrowphase/solid.hpp"

#include <cmath>

namespace scree {

/// Free flight of a body through a substep, told by where it is at the midpoint.
struct BodyFlight {
  Shape shape;
  Vec3 size;             ///< see Shape (m)
  Vec3 inverse_inertia;  ///< principal, 1/(kg m^2)
  Vec3 position;         ///< at the midpoint, without what the acceleration moves it (m)
  Quat orientation;      ///< at the midpoint
  Vec3 velocity;         ///< at the start (m/s)
  Vec3 spin;             ///< at the midpoint (rad/s)
  Vec3 acceleration;     ///< m/s^2
  double midpoint;       ///< time of the midpoint, into the substep (s)

  /// At the time s into the substep (s).
  Vec3 position_at(double s) const {
    return position + (s - midpoint) * velocity + (0.5 * s * s) * acceleration;
  }
  Vec3 velocity_at(double s) const { return velocity + s * acceleration; }
};

/// A body at one instant of its flight.
struct BodyInstant {
  Solid solid;
  Vec3 velocity;  ///< m/s
  Vec3 spin;      ///< rad/s

  Vec3 velocity_at(const Vec3& point) const { return velocity + spin.cross(point - solid.position); }
};
BodyInstant instant_of(const BodyFlight& flight, double s);

/// Two bodies in flight, and which of their meetings count.
struct PairFlight {
  static constexpr int parts = 3;  ///< most surfaces of a pair, Manifold::part

  BodyFlight i, j;
  double until;           ///< end of the search, into the substep (s)
  double slowest[parts];  ///< approach that counts at each part (m/s); infinite: none does
  double farthest =
      HUGE_VAL;  ///< an approach that would go on for more than this until the end counts too (m)

  bool counts(int part, double approach, double s) const {
    return approach > slowest[part] || approach * (until - s) > farthest;
  }
};

struct Meeting {
  double time = HUGE_VAL;  ///< into the substep (s); infinite: none
  int part = 0;            ///< Manifold::part
};

/// Bound on how fast any two points of the bodies near one another approach, until the search ends (m/s).
double fastest_approach(const PairFlight& pair);

/// Bound on the speed that turning gives any point of a body's surface (m/s); infinite for a boundary that
/// turns over.
double fastest_turn(const BodyFlight& flight);

/// The first meeting that counts, at `earliest` (s) or later. Balls, and balls with planes and tubes that do
/// not turn over, have closed forms. For the others it is conservative advancement (Mirtich 1996, sec. 2.3):
/// no step is longer than the gap over the fastest approach; near the contact Newton's steps replace it, and
/// an overlap is bisected.
Meeting next_meeting(const PairFlight& pair, double earliest);

/// The contact of two bodies at an instant, on the part given: of its manifolds the one with the smallest gap
/// at a point that closes, or of all if none does. False if there is none within `reach` (m).
bool contact_at(const BodyInstant& i, Shape shape_i, const BodyInstant& j, Shape shape_j, int part,
                double reach, Manifold& out);

/// Speed at which the bodies close at a point along the normal (m/s); negative: they part.
double closing_speed(const Vec3& normal, const Vec3& point, const BodyInstant& i, const BodyInstant& j);

}  // namespace scree
