// What happens within a step: Moreau's midpoint scheme, one substep after another.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/narrow_phase.hpp"
#include "sim/applied_forces.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/correction.hpp"
#include "sim/dynamics/impact_solver.hpp"
#include "sim/dynamics/motion.hpp"
#include "sim/dynamics/prescribed.hpp"
#include "sim/dynamics/response.hpp"
#include "sim/inspection.hpp"
#include "sim/moving_state.hpp"
#include "sim/observation.hpp"
#include "sim/pair_finder.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"

#include <cstdint>
#include <vector>

namespace scree {

class Substepper {
 public:
  /// The bodies as the scene starts. `origin`: the local origin of the broad phase (m).
  Substepper(const Scene& scene, const TimeGrid& grid, bool on_device, const Vec3& origin);

  /// To be called at the start of each step: sets the forces that act in it.
  void start_step(std::int64_t step);
  /// A substep of length h (s), after `done` of the step went by (s); in the accurate mode in parts that end
  /// where contacts come to stick.
  void substep(double h, double done);

  /// For the state as it is, with their margins(). Valid until the next call.
  ConstView<Pair> pairs_now();
  ConstView<double> margins() const { return contact_margin_.view(); }
  /// Deepest overlap that the last substep found (of the smaller body's smallest_size).
  double overlap() const { return corrector_.overlap(); }
  const KeptPairs& kept_pairs() const { return kept_pairs_; }
  /// Bodies have come or gone.
  void forget_pairs() { kept_pairs_.forget(); }

  const ResponseParameters& parameters() const { return parameters_; }
  /// Of the last substep.
  const ContactSet& contacts();
  /// Of the last substep, those that carried a force.
  std::vector<ContactForce> contact_forces();
  ContactProblem contact_problem();
  /// On a body that is not free, over the step (N s).
  const Vec3& contact_impulse(std::int32_t body) const {
    return contact_impulse_[static_cast<std::size_t>(body)];
  }

  Bodies<Host> bodies;
  Array<PrescribedPath, Host> paths;
  Ledger ledger;
  Counters counters;

 private:
  /// What the first half of a substep changes.
  struct Restart {
    MovingState state;
    Ledger ledger;
    std::int64_t impacts = 0, unfinished_impacts = 0;
    std::vector<Vec3> contact_impulse;

    void save(const Substepper& now);
    void restore(Substepper& now) const;
  };

  ContactLaws contact_laws() const;
  ImpactProblem impact_problem(ConstView<Pair> pairs, double h, double from) const;
  double reach_from(double h, double done) const;
  Manifolds fly_and_respond(double h, double done);
  void fly_on(const Manifolds& manifolds, double h, double done);
  void fly(double time, double dt);
  void resolve_impacts(double h, double from, double reach);
  Manifolds find_contacts(double h, double reach);
  void respond(const Manifolds& manifolds, double h);
  void add_impulse_on_driven_bodies(std::int32_t i, std::int32_t j, const Vec3& impulse);

  TimeGrid grid_;
  std::int64_t step_ = 0;
  ResponseParameters parameters_;
  Array<PairLaw, Host> laws_;
  std::int64_t materials_;
  AppliedForces forces_;
  KeptPairs kept_pairs_;
  NarrowPhase narrow_phase_;
  ImpactSolver impacts_;
  ResponseSolver response_;
  PositionCorrector corrector_;

  double last_substep_ = 0;  // its length; scales the remembered impulses
  Restart before_;           // of the last substep, in the accurate mode
  std::vector<Vec3> contact_impulse_;
  Array<double, Host> contact_margin_;
  Array<SolverBody, Host> solver_;
  std::vector<Impact> struck_;  // in the last substep
  bool any_late_ = false;       // of these after the midpoint
  ContactSet contacts_;
  ImpulseMemory memory_;
};

}  // namespace scree
