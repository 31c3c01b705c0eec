// The response: impulses that keep contacts from closing and make friction hold, by sequential impulses over
// the colours of the contact graph.
#pragma once

#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/state.hpp"

namespace scree {

/// How much a sweep changed the impulses, and their size: sums of squares over the rows, each by the mass
/// that it meets (J), so that heavy and light contacts weigh alike.
struct SweepChange {
  double step = 0;
  double size = 0;

  SCREE_HD friend SweepChange operator+(const SweepChange& a, const SweepChange& b) {
    return {a.step + b.step, a.size + b.size};
  }
};

/// What the conjugate direction needs of a body.
struct BodyAcceleration {
  Vec3 last_velocity, last_spin;
  Vec3 velocity_direction, spin_direction;
};

/// Sequential impulses over coloured contacts, accelerated by the nonsmooth nonlinear conjugate gradient
/// method (Silcowitz, Niebe, Erleben 2010, "A nonsmooth nonlinear conjugate gradient method for interactive
/// contact force problems", algorithm 1): a sweep's change of the impulses is taken as minus a gradient, and
/// Fletcher-Reeves directions on it overcome the slow modes (tall stacks, heavy on light) on which plain
/// sweeps creep.
class ResponseSolver {
 public:
  /// Solves the contacts of one substep of length `step` (s) with e = 0 (impacts that bounce are over): kicks
  /// the free bodies by gravity, then sweeps until the impulses change by less than the tolerance, or the
  /// bound is hit. On entry `solver` holds the velocities after the impacts; on return those at the end of
  /// the substep. The bodies are at the midpoint and keep their positions; their velocities are set. Returns
  /// what it moved.
  Ledger solve(ConstView<Manifold> manifolds, double step, const ResponseParameters& parameters,
               BodyView bodies, Array<SolverBody, Host>& solver, ContactSet& set, Counters& counters);

 private:
  Array<SweepChange, Host> change_;  // per contact, of the last sweep
  Array<BodyAcceleration, Host> body_acceleration_;
};

}  // namespace scree
