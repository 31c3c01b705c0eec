// What the impacts of a flight mean for a contact and for a body in it, in either space.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/contact.hpp"
#include "sim/impacts/flight_stage.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/laws/separated_flight.hpp"
#include "sim/observe/observation.hpp"

#include <algorithm>

namespace scree {

/// Bodies after their impacts. What the response will do comes after: their flight is straight, with all of
/// the substep's kick.
struct StruckFlights {
  FlightStage stage;

  /// When a pair is to be seen, into the substep (s), if that is after the midpoint.
  SCREE_HD double time_of(std::int32_t i, std::int32_t j) const {
    return std::max(stage.clock[i], stage.clock[j]);
  }
  SCREE_HD BodyInstant at(std::int32_t body, double time) const {
    BodyFlight flight = stage.flight(body);
    flight.velocity = flight.velocity_at(stage.terms.step);
    flight.acceleration.setZero();
    return instant_of(flight, time);
  }
};

/// Gives a contact at an edge the normal of a plane along a face that separates its bodies all the while, if
/// there is one: where a flat surface goes on in other bodies, their edges are no features of it. A contact
/// whose rows would not hold the flights apart is left as it is, and so is one of a face that the bodies
/// approach no faster than that plane.
[[gnu::noinline]] SCREE_HD inline void take_normal_of_face(const StruckFlights& struck, std::int32_t i,
                                                           std::int32_t j, int count, ContactPoint* points,
                                                           Vec3& normal) {
  const FlightStage& stage = struck.stage;
  const double begin = struck.time_of(i, j);
  const double seen = std::max(0.5 * stage.terms.step, begin);
  const double left = 1.5 * stage.terms.step - seen;
  BodyInstant at_i = struck.at(i, seen);
  BodyInstant at_j = struck.at(j, seen);
  stage.bodies.period.bring_near(points[0].position, at_i.solid.position);
  stage.bodies.period.bring_near(points[0].position, at_j.solid.position);
  bool pushes = false;
  for (int k = 0; k < count; ++k) {
    const double closing = closing_speed(normal, points[k].position, at_i, at_j);
    pushes = pushes || (closing > 0 && closing * left > tolerance::likely_closing * points[k].gap);
  }
  if (!pushes) return;
  PairFlight pair = stage.pair_of(i, j, 1.5 * stage.terms.step);
  stage.bodies.period.bring_near(points[0].position, pair.i.position);
  stage.bodies.period.bring_near(points[0].position, pair.j.position);
  const SeparatingFace face = separating_face(pair, begin, pair.until, at_i.solid, at_j.solid);
  if (!face.exists()) return;
  double least = points[0].gap;
  double approach = 0;
  const BodyInstant from_i{at_i.solid, pair.i.velocity, at_i.spin};
  const BodyInstant from_j{at_j.solid, pair.j.velocity, at_j.spin};
  for (int k = 0; k < count; ++k) {
    least = std::min(least, points[k].gap);
    const double closing = closing_speed(normal, points[k].position, from_i, from_j);
    approach = std::max(approach, (pair.until - begin) * closing);
  }
  const double rounding = tolerance::touching_gap * pair.smaller_size();
  if (count > 1 &&
      ((face.normal - normal).norm() <= tolerance::same_feature || approach <= face.approach + rounding))
    return;
  normal = face.normal;
  for (int k = 0; k < count; ++k) points[k].gap += face.separation - least;
  // A ball has its contact on the normal.
  const auto place = [&](const BodyFlight& ball, const Vec3& centre, double side) {
    if (ball.is_ball()) points[0].position = centre + side * (ball.size.x() + 0.5 * face.separation) * normal;
  };
  place(pair.i, at_i.solid.position, 1.0);
  place(pair.j, at_j.solid.position, -1.0);
}

/// How the response is to see a contact.
struct ContactFlight {
  double delay;  ///< how long after the midpoint its geometry is of (s)
  bool flying;   ///< known not to meet in this substep: its rows only guard what the flight leaves free
};

namespace detail {

/// Whether the rows of a contact would hold its bodies apart, though they touch nowhere yet; as it was seen
/// at the time `seen` (s).
template <class Header>
SCREE_HD bool would_push_apart(const StruckFlights& struck, const Header& m, const ContactPoint* points,
                               double size, double seen) {
  const FlightStage& stage = struck.stage;
  const double left = 1.5 * stage.terms.step - seen;
  // A point nearer than its size to a body moves at most twice as fast as its surface may.
  const double fastest =
      2 * (stage.top_speed[m.i] + stage.top_speed[m.j]) + stage.terms.step * stage.parameters.gravity.norm();
  bool may_close = false;
  for (int k = 0; k < m.count; ++k) {
    const double gap = points[k].gap;
    may_close = may_close || (gap > 0 && (gap > size || gap < left * fastest));
  }
  if (!may_close) return false;
  BodyInstant i = struck.at(m.i, seen);
  BodyInstant j = struck.at(m.j, seen);
  stage.bodies.period.bring_near(points[0].position, i.solid.position);
  stage.bodies.period.bring_near(points[0].position, j.solid.position);
  bool pushes = false;
  for (int k = 0; k < m.count; ++k) {
    const double closing = closing_speed(m.normal, points[k].position, i, j);
    if (closing <= 0 || closing * left <= tolerance::likely_closing * points[k].gap) continue;
    if (points[k].gap <= 0) return false;  // touches: no impact is to come
    pushes = true;
  }
  return pushes;
}

}  // namespace detail

/// Of a Manifold. Two bodies that the rows would hold apart, though
/// nothing else has touched them, may pass by each other: the normal of the midpoint says nothing of it. Or
/// they meet later, in an impact that will bounce; in a crowd they bounce now. `size`: the smaller
/// smallest_size of the two (m); `loaded`: whether the pair's part carried an impulse in the last substep.
template <class Header>
SCREE_HD ContactFlight flight_of_contact(const StruckFlights& struck, const Header& m,
                                         const ContactPoint* points, double size, bool loaded) {
  const FlightStage& stage = struck.stage;
  const double step = stage.terms.step;
  const double seen = std::max(0.5 * step, struck.time_of(m.i, m.j));
  ContactFlight contact{.delay = seen - 0.5 * step, .flying = false};
  if (loaded || !detail::would_push_apart(struck, m, points, size, seen)) return contact;
  PairFlight pair = stage.pair_of(m.i, m.j, 1.5 * step);
  pair.slowest[m.part] = 0;
  const bool bounces =
      !stage.both_bore_load(m.i, m.j) && fastest_approach(pair) > stage.slowest_bounce(m.i, m.j);
  const Meeting meeting = next_meeting(pair, struck.time_of(m.i, m.j), bounces ? step : HUGE_VAL);
  const bool bounces_later = bounces && meeting.time > step;
  contact.flying = meeting.time == HUGE_VAL || bounces_later;
  return contact;
}

/// Angular momentum (kg m^2/s) that an impulse on a free body adds by acting `delay` after the midpoint (s):
/// beside it by as much as the body flies until then. `total`: all that the response gave to the body (N s).
/// Of many impulses the sum may be given, each times its delay, with a delay of 1 s.
SCREE_HD inline Vec3 moment_of_delay(const BodyView& bodies, std::int32_t body, const Vec3& total,
                                     double delay, const Vec3& impulse) {
  const Vec3 before = bodies.velocity[body] - bodies.inverse_mass[body] * total;
  return -delay * before.cross(impulse);
}

/// After the response: a free body that was struck late has been where it was until then, so its midpoint
/// moves to that from which its new flight leads on from its last impact. Returns what that moved; for others
/// it does nothing. `total`: as above.
SCREE_HD inline Ledger shift_after_late_impact(const FlightStage& stage, std::int32_t body,
                                               const Vec3& total) {
  if (!stage.has_late_impact(body)) return {};
  const BodyView& bodies = stage.bodies;
  Vec3 moment = (stage.clock[body] - 0.5 * stage.terms.step) * total;
  hold_to_guide(stage.parameters.guides, body, moment);
  bodies.position[body] -= bodies.inverse_mass[body] * moment;
  Ledger ledger;
  ledger.correction = -moment.dot(stage.parameters.acceleration_of(body));
  ledger.angular_correction = -moment.cross(bodies.velocity[body]);
  return ledger;
}

}  // namespace scree
