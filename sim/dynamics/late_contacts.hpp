// Contacts of bodies that have had an impact after the midpoint, on the host.
#pragma once

#include "narrowphase/narrow_phase.hpp"
#include "sim/dynamics/contact_flight.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/impact.hpp"

#include <vector>

namespace scree {

/// Pairs of bodies after their impacts, for the narrow phase.
class StruckBodies final : public LateBodies {
 public:
  explicit StruckBodies(const FlightStage& stage) : struck_{stage} {}

  double time_of(std::int32_t i, std::int32_t j) const override { return struck_.time_of(i, j); }
  double now() const override { return 0.5 * struck_.stage.terms.step; }
  Solid solid_at(std::int32_t body, double time) const override { return struck_.at(body, time).solid; }

 private:
  StruckFlights struck_;
};

/// Whether one of them was struck after the midpoint.
bool any_is_late(const FlightStage& stage, const std::vector<StruckBody>& struck);

/// As take_normal_of_face(), of all that are at an edge.
void take_normals_of_faces(const FlightStage& stage, View<ManifoldHeader> headers, View<ContactPoint> points);

/// Sets Contact::flying and Contact::lead, and which of the pairs that touch fly.
void mark_flights(const FlightStage& stage, const Manifolds& manifolds, ContactSet& set, BallPairs& balls);

/// As the function of this name, of all bodies struck. `total`: scratch.
Ledger shift_late(const FlightStage& stage, const std::vector<StruckBody>& struck, const ContactSet& set,
                  std::vector<Vec3>& total);

}  // namespace scree
