// The quantities by which a run is judged. They are computed in the same way for every engine, from the
// bodies' positions, orientations and velocities alone.
#pragma once

#include "core/bodies.hpp"
#include "narrowphase/candidates.hpp"
#include "sim/observe/observation.hpp"
#include "sim/pairs/pair_finder.hpp"
#include "sim/scene/scene.hpp"

#include <memory>

namespace scree::bench {

struct Findings {
  BodyTable newest;          ///< newest state
  double time = 0;           ///< time of the newest state (s)
  double spin_energy = 0;    ///< kinetic energy of rotation in the newest state (J)
  double energy_change = 0;  ///< change of K + U of the free bodies from the first state to the newest (J)
  double worst_energy_change = 0;  ///< largest absolute value of the change of energy so far (J)
  Penetration penetration;         ///< penetration in the newest state, for the true geometry
  double squared_penetration = 0;  ///< sum of squared depths over the newest state's contact points (m^2); a
                                   ///< pair with a sphere has one each
  double worst_penetration = 0;    ///< largest penetration of all states (m)
  double rms_speed = 0;            ///< sqrt(2 K / mass), spin included, in the newest state (m/s)
  double worst_drift = 0;          ///< largest drift of the last body, at right angles to gravity (m)
};

/// Judges the states of one run, the first of which is the scene's own.
class Judge {
 public:
  explicit Judge(const Scene& scene);
  void see(const BodyTable& state, double time);
  const Findings& findings() const { return findings_; }

 private:
  void measure_energy(const BodyTable& state);
  void measure_penetration_of(const BodyTable& state);

  Vec3 gravity_;
  Findings findings_;
  double first_energy_ = 0;
  Vec3 first_place_;  // place of the last body in the first state
  std::unique_ptr<PairFinder<Host>> pair_finder_;
  Candidates<Host> candidates_;
};

}  // namespace scree::bench
