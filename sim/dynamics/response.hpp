// The response: impulses that keep contacts from closing and make friction hold, by sequential impulses over
// the colours of the contact graph.
#pragma once

#include "sim/dynamics/direct.hpp"
#include "sim/dynamics/sweeps.hpp"

#include <vector>

namespace scree {

/// Sweeps; for the islands on which they creep, the direct solver; then nobody gains.
class ResponseSolver {
 public:
  /// Solves the contacts of one substep of length `step` (s) with e = 0 (impacts that bounce are over): kicks
  /// the free bodies by gravity, then sweeps until the impulses change by less than the tolerance, or the
  /// bound is hit. On entry `solver` holds the velocities after the impacts; on return those at the end of
  /// the substep. The bodies are at the midpoint and keep their positions; their velocities are set. Returns
  /// what it moved.
  /// `balls`: what they remember is scaled by `warm_start` (ratio of the substeps' lengths, or 0).
  Ledger solve(const Manifolds& manifolds, double step, const ResponseParameters& parameters,
               BallPairs& balls, double warm_start, BodyView bodies, Array<SolverBody, Host>& solver,
               ContactSet& set, Counters& counters);

  /// The part of solve() that finds the impulses: of rows that are prepared, from the impulses that they
  /// have, as far as `parameters` ask. Sets the velocities of the solver's bodies too; `stage.change` is set
  /// here. False if they have not converged.
  bool find_impulses(SolveStage stage, const ResponseParameters& parameters, ContactSet& set,
                     Counters& counters);

  /// Of each body in the last substep as it would be without contacts (m/s, rad/s).
  ConstView<Vec3> free_velocity() const { return free_velocity_.view(); }
  ConstView<Vec3> free_spin() const { return free_spin_.view(); }

  /// When the first contact that slid came to stick, as a share of the last substep; 1 if none did. For the
  /// accurate mode, and not for heaps, in which something always does.
  double slip_end() const { return slip_end_; }

 private:
  /// Of the last sweep; of none where nobody asks.
  LoadSpread spread_of_loads() const;
  /// Lists what only the batches have, for those who look at contacts one by one.
  void list_all(ContactSet& set, SolveStage& stage);
  /// Scales down the impulses of each island that gains energy, to where it gains none: those in the
  /// batches, whose losses are known. How many did.
  int keep_from_gaining(std::int64_t bodies, lanes::Batches& batches);
  /// Adds to `solved` and `failed`; true if no island is left to the sweeps.
  bool count_outcomes(std::int64_t& solved, std::int64_t& failed) const;

  Array<ImpulseChange, Host> change_;  // per contact, of the last sweep
  Sweeps sweeps_;
  Array<Vec3, Host> free_velocity_, free_spin_;  // of each body without contacts
  Array<lanes::Losses, Host> loss_;              // of each batch
  // Of each island, by its root: what its impulses move, and their scale.
  std::vector<Moved> moved_;
  std::vector<double> scale_;
  Islands islands_;
  Array<DirectOutcome, Host> outcome_;  // of each island
  double slip_end_ = 1;
};

}  // namespace scree
