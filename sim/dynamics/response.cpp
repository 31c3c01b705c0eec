#include "sim/dynamics/response.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/contact_rows.hpp"
#include "sim/dynamics/direct.hpp"
#include "sim/dynamics/sweeps.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

/// Keeps the velocities before the kick in the bodies, for the ledger, and kicks.
struct Kick {
  SolveStage stage;
  ResponseParameters parameters;
  SCREE_HD void operator()(std::int64_t k) const {
    SolverBody& body = stage.solver[k];
    stage.free_velocity[k] = body.velocity;
    stage.free_spin[k] = body.spin;
    if (!body.is_free()) return;
    stage.bodies.velocity[k] = body.velocity;
    stage.bodies.spin[k] = body.spin;
    body.velocity += stage.step * parameters.acceleration_of(k);
    if (parameters.torque.size() > 0) {
      body.spin += stage.step * (body.inverse_inertia * parameters.torque[k]).eval();
    }
    stage.free_velocity[k] = body.velocity;
    stage.free_spin[k] = body.spin;
  }
};

struct Account {
  SolveStage stage;
  SCREE_HD Ledger operator()(std::int64_t c) const {
    Contact& contact = stage.contacts[c];
    const SolverBody& i = stage.solver[contact.i];
    const SolverBody& j = stage.solver[contact.j];
    const SolverBody i0 = stage.before_kick(contact.i);
    const SolverBody j0 = stage.before_kick(contact.j);
    Ledger ledger;
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = stage.rows_of(c)[k];
      ledger = ledger + account(row, contact.normal, row.relative_velocity(i0, j0), i, j);
      contact.impulse += row.impulse;
    }
    return ledger;
  }
};

struct MoveByImpulses {
  SolveStage stage;
  SCREE_HD Moved operator()(std::int64_t c) const {
    const Contact& contact = stage.contacts[c];
    const SolverBody& i = stage.solver[contact.i];
    const SolverBody& j = stage.solver[contact.j];
    const SolverBody i0 = stage.before_kick(contact.i);
    const SolverBody j0 = stage.before_kick(contact.j);
    const SolverBody i1 = stage.without_contacts(contact.i);
    const SolverBody j1 = stage.without_contacts(contact.j);
    Moved moved;
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = stage.rows_of(c)[k];
      const Vec3 kicked = row.relative_velocity(i1, j1);
      moved.linear += 0.5 * row.impulse.dot(row.relative_velocity(i0, j0) + kicked);
      moved.square += 0.5 * row.impulse.dot(row.relative_velocity(i, j) - kicked);
    }
    return moved;
  }
};

/// Scales down the impulses of an island that gains energy, to where it gains none. Whether it did.
bool keep_from_gaining(const SolveStage& stage, ConstView<std::int32_t> contacts) {
  const MoveByImpulses move{stage};
  Moved moved;
  for (const std::int32_t c : contacts) moved = moved + move(c);
  if (!moved.gains(tolerance::response_gain)) return false;
  const double scale = moved.scale_without_gain();
  for (const std::int32_t c : contacts) {
    for (int k = 0; k < stage.contacts[c].count; ++k) stage.rows_of(c)[k].impulse *= scale;
  }
  return true;
}

struct IsGaining {
  MoveByImpulses move;
  SCREE_HD int operator()(std::int64_t c) const { return move(c).gains(tolerance::response_gain) ? 1 : 0; }
};

/// Work of the torques: by the mean of the spins before and after, as that of impulses.
struct WorkOfTorque {
  SolveStage stage;
  ConstView<Vec3> torque;
  SCREE_HD double operator()(std::int64_t k) const {
    if (!stage.solver[k].is_free()) return 0;
    return 0.5 * stage.step * torque[k].dot(stage.bodies.spin[k] + stage.solver[k].spin);
  }
};

struct StoreVelocities {
  SolveStage stage;
  SCREE_HD void operator()(std::int64_t k) const {
    if (!stage.solver[k].is_free()) return;
    stage.bodies.velocity[k] = stage.solver[k].velocity;
    stage.bodies.spin[k] = stage.solver[k].spin;
  }
};

/// The direct solver for the islands that the last sweep has changed; in the accurate mode, for those whose
/// natural residual is beyond the tolerance.
struct SolveIsland {
  SolveStage stage;
  const Islands* islands;
  double tolerance;
  bool accurate;
  View<DirectOutcome> outcome;
  void operator()(std::int64_t island) const {
    const IslandProblem problem{.contacts = stage.contacts,
                                .rows = stage.rows,
                                .solver = stage.solver,
                                .velocity = stage.free_velocity,
                                .spin = stage.free_spin,
                                .islands = *islands,
                                .island = island};
    outcome[island] = (accurate ? natural_residual(problem) : change_of(island)).within(tolerance)
                          ? DirectOutcome::not_needed
                          : solve_directly(problem, tolerance, accurate ? thorough_limits : quick_limits);
  }
  ImpulseChange change_of(std::int64_t island) const {
    ImpulseChange change;
    for (const std::int32_t c : islands->contacts(island)) change = change + stage.change[c];
    return change;
  }
};

struct LoadResidual {
  SolveStage stage;
  SCREE_HD ImpulseChange operator()(std::int64_t c) const {
    const Contact& contact = stage.contacts[c];
    return natural_residual(contact, stage.rows_of(c), stage.solver[contact.i], stage.solver[contact.j]);
  }
};

/// Sweeps after which what has not converged creeps. Warm-started contacts take one or two.
constexpr int sweeps_before_direct = 10;

}  // namespace

bool ResponseSolver::count_outcomes(Counters& counters) const {
  bool all_solved = true;
  for (const DirectOutcome outcome : outcome_.view()) {
    counters.direct += outcome == DirectOutcome::solved;
    counters.direct_failed += outcome == DirectOutcome::failed;
    all_solved = all_solved && (outcome == DirectOutcome::solved || outcome == DirectOutcome::not_needed);
  }
  return all_solved;
}

Ledger ResponseSolver::solve(ConstView<Manifold> manifolds, double step, const ResponseParameters& parameters,
                             BodyView bodies, Array<SolverBody, Host>& solver, ContactSet& set,
                             Counters& counters) {
  const std::int64_t n = set.contacts.size();
  change_.resize(n);
  body_acceleration_.resize(solver.size());
  free_velocity_.resize(solver.size());
  free_spin_.resize(solver.size());
  const SolveStage stage{.manifolds = manifolds,
                         .bodies = bodies,
                         .solver = solver.view(),
                         .contacts = set.contacts.view(),
                         .rows = set.rows.view(),
                         .couplings = set.couplings.view(),
                         .change = change_.view(),
                         .acceleration = body_acceleration_.view(),
                         .free_velocity = free_velocity_.view(),
                         .free_spin = free_spin_.view(),
                         .step = step};
  parallel::for_each<Host>("response.kick", solver.size(), Kick{stage, parameters});
  Ledger ledger;
  if (n > 0) {
    parallel::for_each<Host>("response.rows", n,
                             PrepareRows{stage, tolerance::parting_speed * step * parameters.gravity.norm()});
    SweepPlan plan = automatic_sweeps(set.rows.size());
    if (parameters.iterations > 0) plan.sweeps = parameters.iterations;
    if (parameters.block_sweeps > 0) plan.block_sweeps = parameters.block_sweeps;
    Sweeps sweeps(stage, set.coloring, plan.block_sweeps, parameters.tolerance, counters.sweeps);
    sweeps.start();
    const int first = plan.direct ? std::min(plan.sweeps, sweeps_before_direct) : plan.sweeps;
    bool converged = sweeps.run(first);
    if (parameters.accurate || (!converged && first < plan.sweeps)) {
      islands_.find(set.contacts.view(), solver.view());
      outcome_.resize(islands_.count());
      parallel::for_each<Host>(
          "response.islands", islands_.count(),
          SolveIsland{stage, &islands_, parameters.tolerance, parameters.accurate, outcome_.view()});
      converged = count_outcomes(counters);
      if (!converged) {
        sweeps.start();
        converged = sweeps.run(std::max(plan.sweeps - first, sweeps_before_direct));
      }
    }
    if (!converged) ++counters.unconverged;
    sweeps.set_velocities();
    if (parameters.accurate) {
      const auto left = parallel::sum<ImpulseChange, Host>("response.residual", n, LoadResidual{stage});
      if (left.size > 0) counters.residual = std::max(counters.residual, std::sqrt(left.step / left.size));
    }
    if (parallel::max<int, Host>("response.gain", n, IsGaining{{stage}}, 0) > 0) {
      islands_.find(set.contacts.view(), solver.view());
      int scaled = 0;
      for (std::int64_t island = 0; island < islands_.count(); ++island) {
        scaled += keep_from_gaining(stage, islands_.contacts(island));
      }
      counters.scaled += scaled;
      if (scaled > 0) sweeps.set_velocities();
    }
    ledger = parallel::sum<Ledger, Host>("response.ledger", n, Account{stage});
  }
  if (parameters.torque.size() > 0) {
    ledger.work +=
        parallel::sum<double, Host>("response.torque", solver.size(), WorkOfTorque{stage, parameters.torque});
  }
  parallel::for_each<Host>("response.store", solver.size(), StoreVelocities{stage});
  return ledger;
}

}  // namespace scree
