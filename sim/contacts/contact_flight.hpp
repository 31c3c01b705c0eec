// The effect of the impacts of a flight on contacts and on bodies, in either space.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/contact.hpp"
#include "sim/impacts/flight_stage.hpp"
#include "sim/laws/displace.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/laws/rotation.hpp"
#include "sim/laws/separated_flight.hpp"
#include "sim/observe/observation.hpp"

#include <algorithm>

namespace scree {

/// The flights of bodies after their impacts, without the changes by the response, which comes later: each
/// flight is straight, and its velocity has all of the substep's kick.
struct StruckFlights {
  FlightStage stage;

  /// Returns the time of the last impact of the two bodies, into the substep (s). If it is after the
  /// midpoint, the contact of the pair is found at this time.
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

/// Gives a contact at an edge the normal of a plane along a face that separates its bodies during their whole
/// flight, if there is such a plane. The reason: where a flat surface continues across several bodies, their
/// edges are no features of it. The contact stays as it is if its rows would not hold the bodies apart in
/// their flight. A contact of several points also stays as it is if the bodies approach along its normal no
/// faster than along that of the plane.
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
  // The contact point of a ball lies on the normal through its centre.
  const auto place = [&](const BodyFlight& ball, const Vec3& centre, double side) {
    if (ball.is_ball()) points[0].position = centre + side * (ball.size.x() + 0.5 * face.separation) * normal;
  };
  place(pair.i, at_i.solid.position, 1.0);
  place(pair.j, at_j.solid.position, -1.0);
}

/// How the response treats a contact.
struct ContactFlight {
  double delay;  ///< time after the midpoint at which the contact is found (s)
  bool flying;   ///< the bodies are known not to meet in this substep; the rows only keep them from closing
                 ///< faster than their flight does
};

namespace detail {

/// Whether the rows of a contact, as found at the time `seen` (s), would hold its bodies apart although they
/// do not touch anywhere yet.
template <class Header>
SCREE_HD bool would_push_apart(const StruckFlights& struck, const Header& m, const ContactPoint* points,
                               double size, double seen) {
  const FlightStage& stage = struck.stage;
  const double left = 1.5 * stage.terms.step - seen;
  // A point that is nearer to a body than the body's size moves at most twice as fast as the body's surface
  // may.
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
    if (points[k].gap <= 0) return false;  // the bodies touch: no impact is to come
    pushes = true;
  }
  return pushes;
}

}  // namespace detail

/// Decides how the response treats a contact (Header is Manifold). Two bodies that the rows would hold apart,
/// although they do not touch anywhere yet, may pass by each other: the normal at the midpoint says nothing
/// about this. Or they meet later in an impact in which they bounce; two bodies that both bear load bounce in
/// the response instead. `size`: the smaller smallest_size of the two bodies (m); `loaded`: whether the
/// pair's part carried an impulse in the last substep.
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

/// Returns the angular momentum (kg m^2/s) that an impulse on a free body adds because it acts `delay` after
/// the midpoint (s): its line of action is shifted by the distance that the body flies until then. `total`:
/// the sum of all impulses of the response on the body (N s). For many impulses, the sum of each impulse
/// times its delay may be passed, with a delay of 1 s.
SCREE_HD inline Vec3 moment_of_delay(const BodyView& bodies, std::int32_t body, const Vec3& total,
                                     double delay, const Vec3& impulse) {
  const Vec3 before = bodies.velocity[body] - bodies.inverse_mass[body] * total;
  return -delay * before.cross(impulse);
}

/// Moves and turns a free body with a late impact at the midpoint, after the response. Until that impact the
/// body has flown as it did without the response, so its place and its orientation at the midpoint become
/// those from which the new flight leads through its state at the impact. Returns the ledger of this shift;
/// for other bodies nothing is done. `total`: the sum of all impulses of the response on the body (N s);
/// `spin_before`: its spin before the response (rad/s).
SCREE_HD inline Ledger shift_after_late_impact(const FlightStage& stage, std::int32_t body, const Vec3& total,
                                               const Vec3& spin_before) {
  if (!stage.has_late_impact(body)) return {};
  const BodyView& bodies = stage.bodies;
  const double delay = stage.clock[body] - 0.5 * stage.terms.step;
  Vec3 moment = delay * total;
  hold_to_guide(stage.parameters.guides, body, moment);
  bodies.position[body] -= bodies.inverse_mass[body] * moment;
  Ledger ledger;
  ledger.correction = -moment.dot(stage.parameters.acceleration_of(body));
  ledger.angular_correction = -moment.cross(bodies.velocity[body]);
  if (!stage.parameters.rotation || bodies.spin[body] == spin_before) return ledger;
  const Vec3& inverse_inertia = bodies.inverse_inertia[body];
  Quat at_impact = bodies.orientation[body], ahead = at_impact;
  Vec3 old_spin = spin_before, spin_there = bodies.spin[body];
  rotate_freely(at_impact, old_spin, inverse_inertia, delay);
  // The spin of the new flight at the impact is found as if the body had not been turned yet.
  rotate_freely(ahead, spin_there, inverse_inertia, delay);
  rotate_freely(at_impact, spin_there, inverse_inertia, -delay);
  return ledger + turn_to(bodies, body, at_impact);
}

}  // namespace scree
