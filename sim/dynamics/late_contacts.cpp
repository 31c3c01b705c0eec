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

/// Two bodies that the rows would hold apart, though nothing else has touched them, may pass by each other:
/// the normal of the midpoint says nothing of it. Or they meet later, in an impact that will bounce.
struct Flights {
  FlightStage stage;
  StruckBodies struck;

  double seen(std::int32_t i, std::int32_t j) const {
    return std::max(0.5 * stage.problem.step, struck.time_of(i, j));
  }

  bool fly(const ManifoldHeader& m, const ContactPoint* points, double size) const {
    const double step = stage.problem.step;
    if (!would_push_apart(m, points, size, seen(m.i, m.j))) return false;
    PairFlight pair = stage.pair_of(m.i, m.j, 1.5 * step);
    pair.slowest[m.part] = 0;
    const Meeting meeting = next_meeting(pair, std::max(stage.clock[m.i], stage.clock[m.j]));
    return meeting.time == HUGE_VAL ||
           (meeting.time > step && fastest_approach(pair) > stage.slowest_bounce(m.i, m.j));
  }

  bool would_push_apart(const ManifoldHeader& m, const ContactPoint* points, double size, double seen) const {
    const double left = 1.5 * stage.problem.step - seen;
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

struct MarkFlights {
  Flights flights;
  Manifolds manifolds;
  View<Contact> contacts;
  void operator()(std::int64_t index) const {
    Contact& contact = contacts[index];
    const ManifoldHeader& m = manifolds.headers[index];
    contact.lead = flights.seen(m.i, m.j) - 0.5 * flights.stage.problem.step;
    contact.flying = !contact.loaded && flights.fly(m, manifolds.points_of(m), contact.size);
  }
};

struct MarkPairs {
  Flights flights;
  BallPairs* balls;
  void operator()(std::int64_t index) const {
    const std::int32_t candidate = balls->fresh()[static_cast<std::size_t>(index)];
    const auto [i, j] = balls->pair(candidate);
    const BodyView& bodies = flights.stage.bodies;
    if (!closes(i, j)) {
      balls->set_flying(candidate, false);
      return;
    }
    Manifold found[max_pair_manifolds];
    find_pair_contacts(bodies.shape[i], solid(i), bodies.shape[j], solid(j), HUGE_VAL, found);
    const ManifoldHeader header{
        .i = i, .j = j, .part = 0, .count = 1, .first_point = 0, .normal = found[0].normal};
    balls->set_flying(candidate,
                      flights.fly(header, found[0].points, flights.stage.problem.laws.smaller_size(i, j)));
  }
  /// Whether two balls come closer in the flight after the kick: their turning closes nothing. Of a plane,
  /// always.
  bool closes(std::int32_t i, std::int32_t j) const {
    const FlightStage& stage = flights.stage;
    const BodyView& bodies = stage.bodies;
    if (is_boundary(bodies.shape[i]) || is_boundary(bodies.shape[j])) return true;
    Vec3 w = bodies.velocity[j] - bodies.velocity[i];
    if (stage.is_free(i)) w -= stage.problem.step * stage.parameters.acceleration_of(i);
    if (stage.is_free(j)) w += stage.problem.step * stage.parameters.acceleration_of(j);
    return w.dot(bodies.position[j] - bodies.position[i]) < 0;
  }
  Solid solid(std::int32_t k) const {
    const BodyView& bodies = flights.stage.bodies;
    return {bodies.position[k], bodies.orientation[k], bodies.size[k]};
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

void mark_flights(const FlightStage& stage, const Manifolds& manifolds, ContactSet& set, BallPairs& balls) {
  const Flights flights{stage, StruckBodies(stage)};
  parallel::for_each<Host>("impact.flights", set.contacts.size(),
                           MarkFlights{flights, manifolds, set.contacts.view()});
  parallel::for_each<Host>("impact.flights", std::ssize(balls.fresh()), MarkPairs{flights, &balls});
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
