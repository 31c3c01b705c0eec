// Bodies that come and go.
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

/// What potential energies are of.
struct PotentialField {
  Vec3 gravity;    ///< m/s^2
  Vec3 reference;  ///< where they are 0 (m)
};

/// Who is there in the state of which step. A body that is not has Mobility::absent and no mass; until it
/// appears the rest of its state waits as the scene gives it.
class Presence {
 public:
  Presence(const Scene& scene, const TimeGrid& grid);

  bool holds(std::int32_t body, std::int64_t step) const;
  /// First step in whose state the body is there, if it is no emitter's.
  std::int64_t first_step(std::int32_t body) const;
  std::int64_t count() const { return count_; }  ///< bodies that are there
  std::int64_t requested() const;                ///< of all emitters so far
  std::int64_t emitted() const;
  void archive(Archive& archive);

  /// To be called at t = 0, if some body is not there: takes out those that come later.
  void begin(Bodies<Host>& bodies) const;

  /// Whether bodies come or go as a step is reached.
  bool changes(std::int64_t step) const;
  struct Change {
    Exchange exchange;
    double first_potential = 0;  ///< of those that came, when they appear, less that of those that went (J)
  };
  /// The state of a step has been reached: takes out the bodies whose time is over, and brings in those whose
  /// time has come.
  Change update(std::int64_t step, const Scene& scene, const PotentialField& field, Bodies<Host>& bodies);
  /// These were taken out for another reason, as they are.
  Change take_leave_of(const BodyTable& gone, const Scene& scene, const PotentialField& field);
  /// These, of an emission, were brought in.
  Change welcome(const BodyTable& come, const Scene& scene, const PotentialField& field);
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
  std::vector<Emission> emissions_;  // likewise
  std::int64_t count_;
};

}  // namespace scree
