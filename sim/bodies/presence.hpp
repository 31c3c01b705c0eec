// The presence of bodies: which of them are in the scene in which step, and what they bring and take.
#pragma once

#include "core/archive.hpp"
#include "core/bodies.hpp"
#include "sim/bodies/emission.hpp"
#include "sim/observe/observation.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// The gravity and the reference point of potential energies.
struct PotentialField {
  Vec3 gravity;    ///< m/s^2
  Vec3 reference;  ///< where potential energies are 0 (m)
};

/// The bodies that are present in the state of each step. A body that is not present has Mobility::absent and
/// no mass; until it appears, the rest of its state is as the scene gives it.
class Presence {
 public:
  Presence(const Scene& scene, const TimeGrid& grid);

  bool holds(std::int32_t body, std::int64_t step) const;
  /// Returns the first step in whose state the body is present; not for the bodies of emitters.
  std::int64_t first_step(std::int32_t body) const;
  std::int64_t count() const { return count_; }  ///< number of bodies that are present
  std::int64_t requested() const;                ///< number of bodies that all emitters were to send so far
  std::int64_t emitted() const;
  void archive(Archive& archive);

  /// Makes the bodies that come later absent. Must be called at t = 0 if some body is not present then.
  void begin(Bodies<Host>& bodies) const;

  /// Returns whether the lifetime of a body begins or ends as a step is reached.
  bool changes(std::int64_t step) const;
  struct Change {
    Exchange exchange;
    /// Potential energy that bodies have when they appear: sum over those that came, less those that went
    /// (J).
    double first_potential = 0;
  };
  /// Must be called when the state of a step has been reached: removes the bodies whose lifetime is over, and
  /// brings in those whose lifetime begins. Returns the change of the accounts.
  Change update(std::int64_t step, const Scene& scene, const PotentialField& field, Bodies<Host>& bodies);
  /// Accounts for bodies that were removed for another reason, in the state that they had.
  Change account_for_removed(const BodyTable& gone, const Scene& scene, const PotentialField& field);
  /// Accounts for bodies of an emission that were brought in.
  Change account_for_added(const BodyTable& come, const Scene& scene, const PotentialField& field);
  std::vector<Emission>& emissions() { return emissions_; }

 private:
  struct Window {
    BodyRange bodies;
    TimeGrid::Steps steps;
    bool changes_at(std::int64_t step) const { return steps.first == step || steps.end == step; }
  };
  const Window* window_of(std::int32_t body) const;
  const Emission* emission_of(std::int32_t body) const;
  void account(const ConstBodyView& bodies, std::int64_t k, double sign, const Scene& scene,
               const PotentialField& field, Change& change);
  Change account_all(const BodyTable& table, double sign, const Scene& scene, const PotentialField& field);

  std::vector<Window> windows_;      // by ascending body
  std::vector<Emission> emissions_;  // by ascending body
  std::int64_t count_;
};

}  // namespace scree
