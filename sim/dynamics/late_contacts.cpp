#include "sim/dynamics/late_contacts.hpp"

#include "core/parallel_loops.hpp"

#include <algorithm>
#include <iterator>

namespace scree {

namespace {

struct TakeNormals {
  StruckFlights struck;
  View<ManifoldHeader> headers;
  View<ContactPoint> points;
  void operator()(std::int64_t index) const {
    ManifoldHeader& m = headers[index];
    if (m.at_edge) take_normal_of_face(struck, m.i, m.j, m.count, &points[m.first_point], m.normal);
  }
};

struct MarkFlights {
  StruckFlights struck;
  Manifolds manifolds;
  View<Contact> contacts;
  void operator()(std::int64_t index) const {
    Contact& contact = contacts[index];
    const ManifoldHeader& m = manifolds.headers[index];
    const ContactFlight flight =
        flight_of_contact(struck, m, manifolds.points_of(m), contact.size, contact.loaded);
    contact.lead = flight.lead;
    contact.flying = flight.flying;
  }
};

struct MarkPairs {
  StruckFlights struck;
  BallPairs* balls;
  void operator()(std::int64_t index) const {
    const std::int32_t candidate = balls->fresh()[static_cast<std::size_t>(index)];
    const auto [i, j] = balls->pair(candidate);
    const BodyView& bodies = struck.stage.bodies;
    if (!closes(i, j)) {
      balls->set_flying(candidate, false);
      return;
    }
    Manifold found[max_pair_manifolds];
    Solid of_j = solid(j);
    bodies.period.bring_near(bodies.position[i], of_j.position);
    find_pair_contacts(bodies.shape[i], solid(i), bodies.shape[j], of_j, HUGE_VAL, found);
    found[0].i = i;
    found[0].j = j;
    const double size = struck.stage.terms.laws.smaller_size(i, j);
    balls->set_flying(candidate, flight_of_contact(struck, found[0], found[0].points, size, false).flying);
  }
  /// Whether two balls come closer in the flight after the kick: their turning closes nothing. Of a plane,
  /// always.
  bool closes(std::int32_t i, std::int32_t j) const {
    const FlightStage& stage = struck.stage;
    const BodyView& bodies = stage.bodies;
    if (is_boundary(bodies.shape[i]) || is_boundary(bodies.shape[j])) return true;
    Vec3 w = bodies.velocity[j] - bodies.velocity[i];
    if (stage.is_free(i)) w -= stage.terms.step * stage.parameters.acceleration_of(i);
    if (stage.is_free(j)) w += stage.terms.step * stage.parameters.acceleration_of(j);
    return w.dot(bodies.period.nearest(bodies.position[j] - bodies.position[i])) < 0;
  }
  Solid solid(std::int32_t k) const {
    const BodyView& bodies = struck.stage.bodies;
    return {bodies.position[k], bodies.orientation[k], bodies.size[k]};
  }
};

}  // namespace

bool any_is_late(const FlightStage& stage, const std::vector<StruckBody>& struck) {
  return std::any_of(struck.begin(), struck.end(),
                     [&](const StruckBody& body) { return stage.is_late(body.body); });
}

void take_normals_of_faces(const FlightStage& stage, View<ManifoldHeader> headers,
                           View<ContactPoint> points) {
  parallel::for_each<Host>("contacts.faces", headers.size(),
                           TakeNormals{StruckFlights{stage}, headers, points});
}

void mark_flights(const FlightStage& stage, const Manifolds& manifolds, ContactSet& set, BallPairs& balls) {
  const StruckFlights struck{stage};
  parallel::for_each<Host>("impact.flights", set.contacts.size(),
                           MarkFlights{struck, manifolds, set.contacts.view()});
  parallel::for_each<Host>("impact.flights", std::ssize(balls.fresh()), MarkPairs{struck, &balls});
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
  for (const Contact& c : set.contacts.view()) {
    if (c.lead == 0) continue;
    for_each_end(c, [&](std::int32_t body, const Vec3& impulse) {
      ledger.angular_correction +=
          moment_of_lead(bodies, body, total[static_cast<std::size_t>(body)], c.lead, impulse);
    });
  }
  for (const StruckBody& saved : struck)
    ledger = ledger + shift_late(stage, saved.body, total[static_cast<std::size_t>(saved.body)]);
  return ledger;
}

}  // namespace scree
