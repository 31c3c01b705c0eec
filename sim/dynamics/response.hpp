// The response: impulses that keep contacts from closing and make friction hold, by sequential impulses over
// the colours of the contact graph.
#pragma once

#include "sim/dynamics/direct.hpp"
#include "sim/dynamics/state.hpp"

namespace scree {

/// How often contacts are swept at most.
struct SweepPlan {
  int sweeps;
  int block_sweeps;  ///< over the points of a contact at each visit
  bool direct;       ///< islands on which sweeps creep are for the direct solver
};

/// For so many contact points: few are solved to the tolerance whatever it takes, since they cost nothing; of
/// many, a heap, the sweeps are bounded, since it moves on before it converges, and visit each point once,
/// since news travels one contact per sweep however well each is solved (docs/decisions/0005).
SCREE_HD inline SweepPlan automatic_sweeps(std::int64_t points) {
  constexpr std::int64_t heap = 2500;      // points
  constexpr std::int64_t visits = 400000;  // of points in a substep
  constexpr int fewest = 20, most = 10000;
  if (points >= heap) return {fewest, 1, false};
  constexpr int block = 4;
  const std::int64_t sweeps = visits / (block * (points > 0 ? points : 1));
  return {static_cast<int>(sweeps < most ? sweeps : most), block, true};
}

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
  /// True if no island is left to the sweeps.
  bool count_outcomes(Counters& counters) const;

  Array<ImpulseChange, Host> change_;  // per contact, of the last sweep
  Array<BodyAcceleration, Host> body_acceleration_;
  Array<Vec3, Host> free_velocity_, free_spin_;  // of each body without contacts
  Islands islands_;
  Array<DirectOutcome, Host> outcome_;  // of each island
};

}  // namespace scree
