// Contacts of bodies that have had an impact after the midpoint.
#pragma once

#include "narrowphase/narrow_phase.hpp"
#include "sim/dynamics/flight_stage.hpp"

#include <vector>

namespace scree {

/// A body before its first impact of the flight.
struct StruckBody {
  std::int32_t body;
  Vec3 position;
  Quat orientation;
  Vec3 velocity, spin;
  double clock;
};

/// Pairs of bodies after their impacts. What the response will do comes after: their flight is straight, with
/// all of the substep's kick.
class StruckBodies final : public LateBodies {
 public:
  explicit StruckBodies(const FlightStage& stage) : stage_(stage) {}

  double time_of(std::int32_t i, std::int32_t j) const override;
  double now() const override { return 0.5 * stage_.problem.step; }
  Solid solid_at(std::int32_t body, double time) const override { return at(body, time).solid; }

  BodyInstant at(std::int32_t body, double time) const;

 private:
  FlightStage stage_;
};

/// Whether one of them was struck after the midpoint.
bool any_is_late(const FlightStage& stage, const std::vector<StruckBody>& struck);

/// Sets Contact::flying and Contact::lead, and which of the pairs that touch fly.
void mark_flights(const FlightStage& stage, const Manifolds& manifolds, ContactSet& set, BallPairs& balls);

/// After the response: a body that was struck late has been where it was until then, so its midpoint moves
/// to that from which its new flight leads on from its last impact. Returns what that moved. `total`:
/// scratch.
Ledger shift_late(const FlightStage& stage, const std::vector<StruckBody>& struck, const ContactSet& set,
                  std::vector<Vec3>& total);

}  // namespace scree
