#include "sim/dynamics/late_contacts.hpp"

#include "core/parallel.hpp"

#include <algorithm>

namespace scree {

namespace {

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

}  // namespace

bool any_is_late(const FlightStage& stage, const std::vector<StruckBody>& struck) {
  return std::any_of(struck.begin(), struck.end(),
                     [&](const StruckBody& body) { return stage.is_late(body.body); });
}

void mark_flights(const FlightStage& stage, const Manifolds& manifolds, ContactSet& set) {
  parallel::for_each<Host>("impact.flights", set.contacts.size(),
                           MarkFlights{{stage}, manifolds, set.contacts.view()});
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
