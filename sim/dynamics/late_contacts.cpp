#include "sim/dynamics/late_contacts.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

bool is_late(const FlightStage& stage, const StruckBody& body) {
  return stage.clock[body.body] > 0.5 * stage.problem.step;
}

struct MarkFlights {
  FlightStage stage;
  StruckBodies struck;
  Manifolds manifolds;
  View<Contact> contacts;

  /// Two bodies that the rows would hold apart, though nothing else has touched them, may pass by each other:
  /// the normal of the midpoint says nothing of it. Or they meet later, in an impact that will bounce.
  void operator()(std::int64_t index) const {
    Contact& contact = contacts[index];
    const ManifoldHeader& m = manifolds.headers[index];
    const double step = stage.problem.step;
    const double seen = std::max(0.5 * step, struck.time_of(m.i, m.j));
    contact.lead = seen - 0.5 * step;
    if (contact.loaded || !would_push_apart(m, contact.size, seen)) return;
    PairFlight pair = stage.pair_of(m.i, m.j, 1.5 * step);
    pair.slowest[m.part] = 0;
    const Meeting meeting = next_meeting(pair, std::max(stage.clock[m.i], stage.clock[m.j]));
    contact.flying = meeting.time == HUGE_VAL ||
                     (meeting.time > step && fastest_approach(pair) > stage.slowest_bounce(m.i, m.j));
  }

  bool would_push_apart(const ManifoldHeader& m, double size, double seen) const {
    const double left = 1.5 * stage.problem.step - seen;
    const ContactPoint* points = manifolds.points_of(m);
    // A point nearer than its size to a body moves at most twice as fast as its surface may.
    const double fastest = 2 * (stage.top_speed[m.i] + stage.top_speed[m.j]) +
                           stage.problem.step * stage.parameters.gravity.norm();
    const auto may_close = [&](const ContactPoint& point) {
      return point.gap > 0 && (point.gap > size || point.gap < left * fastest);
    };
    if (std::none_of(points, points + m.count, may_close)) return false;
    const BodyInstant i = struck.at(m.i, seen);
    const BodyInstant j = struck.at(m.j, seen);
    bool pushes = false;
    for (int k = 0; k < m.count; ++k) {
      const double closing = closing_speed(m.normal, points[k].position, i, j);
      if (closing <= 0 || closing * left <= tolerance::likely_closing * points[k].gap) continue;
      if (points[k].gap <= 0) return false;  // touches: no impact is to come
      pushes = true;
    }
    return pushes;
  }
};

}  // namespace

double StruckBodies::time_of(std::int32_t i, std::int32_t j) const {
  return std::max(stage_.clock[i], stage_.clock[j]);
}

BodyInstant StruckBodies::at(std::int32_t body, double time) const {
  BodyFlight flight = stage_.flight(body);
  flight.velocity = flight.velocity_at(stage_.problem.step);
  flight.acceleration.setZero();
  return instant_of(flight, time);
}

bool any_is_late(const FlightStage& stage, const std::vector<StruckBody>& struck) {
  return std::any_of(struck.begin(), struck.end(),
                     [&](const StruckBody& body) { return is_late(stage, body); });
}

void mark_flights(const FlightStage& stage, const Manifolds& manifolds, ContactSet& set) {
  parallel::for_each<Host>("impact.flights", set.contacts.size(),
                           MarkFlights{stage, StruckBodies(stage), manifolds, set.contacts.view()});
}

Ledger shift_late(const FlightStage& stage, const std::vector<StruckBody>& struck, const ContactSet& set,
                  std::vector<Vec3>& total) {
  if (!any_is_late(stage, struck)) return {};
  const BodyView& bodies = stage.bodies;
  const auto for_each_end = [&](const Contact& c, auto&& act) {
    const Vec3 impulse = set.impulse_of(c);
    if (bodies.mobility[c.i] == Mobility::free) act(c.i, Vec3(-impulse));
    if (bodies.mobility[c.j] == Mobility::free) act(c.j, impulse);
  };
  total.assign(static_cast<std::size_t>(bodies.count()), Vec3::Zero());
  for (const Contact& c : set.contacts.view()) {
    for_each_end(
        c, [&](std::int32_t body, const Vec3& impulse) { total[static_cast<std::size_t>(body)] += impulse; });
  }
  Ledger ledger;
  // An impulse at a contact's time acts beside the midpoint by as much as the body flies until then.
  for (const Contact& c : set.contacts.view()) {
    if (c.lead == 0) continue;
    for_each_end(c, [&](std::int32_t body, const Vec3& impulse) {
      const Vec3 before =
          bodies.velocity[body] - bodies.inverse_mass[body] * total[static_cast<std::size_t>(body)];
      ledger.angular_correction -= c.lead * before.cross(impulse);
    });
  }
  for (const StruckBody& saved : struck) {
    const std::int32_t body = saved.body;
    const double lead = stage.clock[body] - 0.5 * stage.problem.step;
    const Vec3 moment = lead * total[static_cast<std::size_t>(body)];
    if (!is_late(stage, saved)) continue;
    bodies.position[body] -= bodies.inverse_mass[body] * moment;
    ledger.correction -= moment.dot(stage.parameters.acceleration_of(body));
    ledger.angular_correction -= moment.cross(bodies.velocity[body]);
  }
  return ledger;
}

}  // namespace scree
