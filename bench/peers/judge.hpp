// What a run is judged by: computed alike for every engine, from nothing but the bodies' positions,
// orientations and velocities.
#pragma once

#include "core/bodies.hpp"
#include "narrowphase/candidates.hpp"
#include "sim/observe/observation.hpp"
#include "sim/pairs/pair_finder.hpp"
#include "sim/scene/scene.hpp"

#include <memory>

namespace scree::bench {

struct Findings {
  BodyTable newest;                ///< the state seen last
  double time = 0;                 ///< its own (s)
  double spin_energy = 0;          ///< part of K in the newest state (J)
  double energy_change = 0;        ///< of K + U of the free bodies, from the first state to the newest (J)
  double worst_energy_change = 0;  ///< the largest of either sign, as an amount
  Penetration penetration;         ///< in the newest state, true geometry
  double squared_penetration = 0;  ///< sum over its contact points (m^2); a sphere's pairs have one each
  double worst_penetration = 0;    ///< of all states (m)
  double rms_speed = 0;            ///< sqrt(2 K / mass), spin included, in the newest state (m/s)
  double worst_drift = 0;          ///< of the last body from its start, at right angles to gravity (m)
};

/// Sees the states of one run, the first of which is the scene's own.
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
  Vec3 first_place_;  // of the last body
  std::unique_ptr<PairFinder<Host>> pair_finder_;
  Candidates<Host> candidates_;
};

}  // namespace scree::bench
