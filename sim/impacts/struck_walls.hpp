// The points of an impact in which a body strikes several bodies that are not free ("walls") at once, because
// they make one flat surface, in either space.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/contact.hpp"
#include "sim/impacts/flight_stage.hpp"
#include "sim/impacts/meeting.hpp"

namespace scree {

/// The points of one plane at which a body strikes others.
struct StruckPoints {
  static constexpr int most = 4 * Manifold::max_points;
  static constexpr std::int32_t own = -1;

  Vec3 at[most];            ///< places of the points (m)
  std::int32_t wall[most];  ///< the body that is struck there; own: the wall of the pair that meets
  int count = 0;

  SCREE_HD void add(const Vec3& normal, const Vec3& point, std::int32_t of) {
    if (count == most) keep_farthest(normal);
    at[count] = point;
    wall[count++] = of;
  }

  /// Keeps at most as many points as a manifold has, which span the most area: if these separate as Newton's
  /// law says, the points between them do so too.
  SCREE_HD void keep_widest(const Vec3& normal) {
    if (count <= Manifold::max_points) return;
    const auto distance = [this](const Vec3& p) { return (p - at[0]).squaredNorm(); };
    const auto doubled_area = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      return normal.dot((b - a).cross(c - a));
    };
    bring_to(0, distance);
    bring_to(1, distance);
    bring_to(2, [&](const Vec3& p) { return fabs(doubled_area(at[0], at[1], p)); });
    const double turn = doubled_area(at[0], at[1], at[2]) < 0 ? -1.0 : 1.0;
    bring_to(3, [&](const Vec3& p) {
      return fmax(-turn * doubled_area(at[0], at[1], p),
                  fmax(-turn * doubled_area(at[1], at[2], p), -turn * doubled_area(at[2], at[0], p)));
    });
    count = Manifold::max_points;
  }

 private:
  /// Keeps the points that reach farthest along eight directions, 45 degrees apart. Corners of less than 135
  /// degrees are among them, whatever points are added later.
  SCREE_HD void keep_farthest(const Vec3& normal) {
    constexpr int directions = 8;
    const Vec3 x = tangent_of(normal);
    const Vec3 y = normal.cross(x);
    std::uint32_t farthest = 0;
    for (int d = 0; d < directions; ++d) {
      const double angle = 2 * pi * d / directions;
      const Vec3 along = cos(angle) * x + sin(angle) * y;
      int best = 0;
      for (int k = 1; k < count; ++k)
        if (along.dot(at[k]) > along.dot(at[best])) best = k;
      farthest |= 1u << best;
    }
    int kept = 0;
    for (int k = 0; k < count; ++k) {
      if ((farthest >> k & 1u) == 0) continue;
      at[kept] = at[k];
      wall[kept++] = wall[k];
    }
    count = kept;
  }

  /// Exchanges the point in a place with the one for which `value` is largest, among it and the points after
  /// it.
  template <class Value>
  SCREE_HD void bring_to(int place, const Value& value) {
    int best = place;
    for (int k = place + 1; k < count; ++k)
      if (value(at[k]) > value(at[best])) best = k;
    const Vec3 point = at[place];
    const std::int32_t of = wall[place];
    at[place] = at[best];
    wall[place] = wall[best];
    at[best] = point;
    wall[best] = of;
  }
};

/// A body that strikes a wall, that is, a body that is not free.
struct WallStrike {
  std::int32_t body, wall;
  Vec3 normal;  ///< unit normal, from the wall to the body
  double time;  ///< time into the substep (s)
  BodyFlight flight;
  BodyInstant at_body, at_wall;
};

/// Adds the points at which the body closes with another wall, on a part, if the surface of the first wall
/// goes on there: in one plane, with the same law and velocity. A face that falls flat on a seam strikes both
/// sides at once; two impacts one after the other would turn the body.
[[gnu::noinline]] SCREE_HD inline void add_wall(const FlightStage& stage, const WallStrike& strike,
                                                std::int32_t wall, int part, StruckPoints& points) {
  const ContactLaws& laws = stage.terms.laws;
  const PairLaw& law = laws.between(wall, strike.body);
  const PairLaw& first_law = laws.between(strike.wall, strike.body);
  if (law.restitution != first_law.restitution || law.friction != first_law.friction ||
      law.rolling_friction != first_law.rolling_friction)
    return;
  BodyFlight flight = stage.flight(wall);
  stage.bodies.period.bring_near(strike.flight.position, flight.position);
  const BodyInstant at_wall = instant_of(flight, strike.time);
  const bool wall_first = wall < strike.body;
  const double touching = tolerance::closed_gap * laws.smaller_size(wall, strike.body);
  Manifold m;
  const bool touches = wall_first ? contact_at(at_wall, flight.shape, strike.at_body, strike.flight.shape,
                                               stage.shapes_of(wall, strike.body), part, touching, m)
                                  : contact_at(strike.at_body, strike.flight.shape, at_wall, flight.shape,
                                               stage.shapes_of(strike.body, wall), part, touching, m);
  if (!touches) return;
  const Vec3 normal = wall_first ? m.normal : Vec3(-m.normal);
  if ((normal - strike.normal).norm() > tolerance::same_feature) return;
  for (int k = 0; k < m.count; ++k) {
    const Vec3& point = m.points[k].position;
    const double closing = closing_speed(strike.normal, point, at_wall, strike.at_body);
    const Vec3 sliding = at_wall.velocity_at(point) - strike.at_wall.velocity_at(point);
    if (closing > 0 && sliding.norm() <= tolerance::impact_rounding * closing)
      points.add(strike.normal, point, wall);
  }
}

}  // namespace scree
