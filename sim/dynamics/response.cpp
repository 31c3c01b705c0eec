#include "sim/dynamics/response.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/tube.hpp"
#include "sim/dynamics/colored.hpp"
#include "sim/dynamics/direct.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree {

namespace {

struct SolveStage {
  ConstView<Manifold> manifolds;
  BodyView bodies;
  View<SolverBody> solver;
  View<Contact> contacts;
  View<ContactRow> rows;
  View<RowCoupling> couplings;
  View<ImpulseChange> change;
  View<BodyAcceleration> acceleration;
  View<Vec3> free_velocity;  ///< of each body without contacts
  View<Vec3> free_spin;
  double step;

  /// A body with its velocities before the kick; those of bodies that are not free do not change.
  SCREE_HD SolverBody before_kick(std::int32_t body) const {
    SolverBody state = solver[body];
    state.velocity = bodies.velocity[body];
    state.spin = bodies.spin[body];
    return state;
  }
  SCREE_HD SolverBody without_contacts(std::int32_t body) const {
    SolverBody state = solver[body];
    state.velocity = free_velocity[body];
    state.spin = free_spin[body];
    return state;
  }
  SCREE_HD ContactRow* rows_of(std::int64_t c) const { return &rows[contacts[c].first_row]; }
  SCREE_HD void store(std::int32_t body, const SolverBody& state) const {
    if (!state.is_free()) return;
    solver[body].velocity = state.velocity;
    solver[body].spin = state.spin;
  }
};

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

struct Release {
  SolveStage stage;
  SCREE_HD void operator()(std::int64_t k) const {
    stage.solver[k].velocity = stage.free_velocity[k];
    stage.solver[k].spin = stage.free_spin[k];
  }
};

/// Arms, gaps and targets at the midpoint.
struct PrepareRows {
  SolveStage stage;
  double noise;  ///< parting speeds that count as none (m/s)
  SCREE_HD void operator()(std::int64_t c) const {
    Contact& contact = stage.contacts[c];
    const Manifold& m = stage.manifolds[contact.manifold];
    const BodyView& bodies = stage.bodies;
    // Where several points share the load, the closed shell keeps all of them in contact; a single point
    // rests at 0.
    const double shell =
        contact.count == 1 ? 0.0
                           : tolerance::closed_gap * fmin(smallest_size(bodies.shape[m.i], bodies.size[m.i]),
                                                          smallest_size(bodies.shape[m.j], bodies.size[m.j]));
    for (int k = 0; k < contact.count; ++k) {
      ContactRow& row = stage.rows_of(c)[k];
      const Vec3 impulse = row.impulse;
      const Vec3& point = m.points[k].position;
      const SolverBody& i = stage.solver[m.i];
      const SolverBody& j = stage.solver[m.j];
      const Vec3 arm_i = point - (bodies.position[m.i] + contact.lead * i.velocity);
      const Vec3 arm_j = point - (bodies.position[m.j] + contact.lead * j.velocity);
      if (contact.balls) {
        row = make_ball_row(arm_i, arm_j, m.points[k].gap, i, j);
      } else {
        row = make_row(m.normal, arm_i, arm_j, m.points[k].gap, i, j, stage.couplings[contact.first_row + k]);
      }
      row.impulse = impulse;
      // The next midpoint must not overlap: the gap may close by then, and no more (speculative contact).
      row.target = row.gap > shell ? -(row.gap - shell) / (stage.step - contact.lead) : 0.0;
      if (contact.balls) {
        row.bend = bend_of(m);
        row.target -= 0.5 * stage.step * row.bend;
      }
      // Held, a contact that was parting before the kick would gain energy, p.(u- + u+)/2: it may close as
      // fast.
      row.target = fmin(row.target, noise - speed_before(contact, row));
      if (contact.flying) row.target = fmin(row.target, flight_speed(contact, row));
    }
  }

  /// Of balls on one another, and of a ball along the wall of a tube: the normal turns with the centres.
  SCREE_HD double bend_of(const Manifold& m) const {
    const BodyView& bodies = stage.bodies;
    const Vec3 w = stage.solver[m.j].velocity - stage.solver[m.i].velocity;
    Vec3 across = w - w.dot(m.normal) * m.normal;
    const bool ball_i = bodies.shape[m.i] == Shape::sphere;
    const bool ball_j = bodies.shape[m.j] == Shape::sphere;
    if (ball_i && ball_j) return across.squaredNorm() / (bodies.size[m.i].x() + bodies.size[m.j].x());
    const std::int32_t other = ball_i ? m.j : m.i;
    if (bodies.shape[other] != Shape::tube || m.part != tube_wall) return 0;
    const Vec3 axis = bodies.orientation[other] * Vec3::UnitZ();
    across -= across.dot(axis) * axis;
    const double reach = bodies.size[other].x() - bodies.size[ball_i ? m.i : m.j].x();
    return reach > 0 ? -across.squaredNorm() / reach : 0.0;
  }

  /// At which the contact parts before the kick.
  SCREE_HD double speed_before(const Contact& contact, const ContactRow& row) const {
    return contact.normal.dot(
        row.relative_velocity(stage.before_kick(contact.i), stage.before_kick(contact.j)));
  }

  /// A little faster than the flight closes along the normal, so that rounding pushes nobody.
  SCREE_HD double flight_speed(const Contact& contact, const ContactRow& row) const {
    const double speed =
        contact.normal.dot(row.relative_velocity(stage.solver[contact.i], stage.solver[contact.j]));
    return speed - tolerance::flight_margin * fabs(speed);
  }
};

/// Gives the bodies what the impulses are.
struct Push {
  SolveStage stage;
  std::int64_t first;
  SCREE_HD void operator()(std::int64_t k) const {
    const Contact& contact = stage.contacts[first + k];
    SolverBody i = stage.solver[contact.i];
    SolverBody j = stage.solver[contact.j];
    for (int p = 0; p < contact.count; ++p) {
      ContactRow& row = stage.rows_of(first + k)[p];
      row.push(row.impulse, i, j);
      row.change.setZero();
    }
    stage.store(contact.i, i);
    stage.store(contact.j, j);
  }
};

/// One visit of a contact. Going on by beta in the direction of the sweeps before, which the bodies have done
/// already, waits for it.
struct Sweep {
  SolveStage stage;
  std::int64_t first;
  double beta;
  int block_sweeps;

  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t c = first + k;
    const Contact& contact = stage.contacts[c];
    ContactRow* rows = stage.rows_of(c);
    SolverBody i = stage.solver[contact.i];
    SolverBody j = stage.solver[contact.j];
    Vec3 last[Manifold::max_points];
    for (int p = 0; p < contact.count; ++p) {
      ContactRow& row = rows[p];
      row.impulse += beta * row.direction;
      row.direction = beta * row.direction + row.change;
      last[p] = row.impulse;
    }
    if (contact.balls) {
      for (int p = 0; p < contact.count; ++p) sweep_ball_row(rows[p], contact.normal, contact.friction, i, j);
    } else {
      const int sweeps = contact.count > 1 ? block_sweeps : 1;
      for (int sweep = 0; sweep < sweeps; ++sweep) {
        sweep_rows(rows, &stage.couplings[contact.first_row], contact.count, contact.normal, contact.friction,
                   i, j);
      }
    }
    stage.store(contact.i, i);
    stage.store(contact.j, j);
    ImpulseChange change;
    for (int p = 0; p < contact.count; ++p) {
      ContactRow& row = rows[p];
      row.change = row.impulse - last[p];
      change.add(row, row.change);
    }
    stage.change[c] = change;
  }
};

struct LoadChange {
  ConstView<ImpulseChange> change;
  SCREE_HD ImpulseChange operator()(std::int64_t c) const { return change[c]; }
};

/// Velocities are linear in the impulses: what beta does to these it does to them.
struct AccelerateBodies {
  SolveStage stage;
  double beta;
  SCREE_HD void operator()(std::int64_t k) const {
    SolverBody& body = stage.solver[k];
    BodyAcceleration& a = stage.acceleration[k];
    if (!body.is_free()) return;
    const Vec3 velocity_step = body.velocity - a.last_velocity;
    const Vec3 spin_step = body.spin - a.last_spin;
    body.velocity += beta * a.velocity_direction;
    body.spin += beta * a.spin_direction;
    a.velocity_direction = beta * a.velocity_direction + velocity_step;
    a.spin_direction = beta * a.spin_direction + spin_step;
    a.last_velocity = body.velocity;
    a.last_spin = body.spin;
  }
};

struct StartBodies {
  SolveStage stage;
  SCREE_HD void operator()(std::int64_t k) const {
    stage.acceleration[k] = {stage.solver[k].velocity, stage.solver[k].spin, Vec3::Zero(), Vec3::Zero()};
  }
};

/// Sweeps of one substep.
class Sweeps {
 public:
  Sweeps(const SolveStage& stage, const Coloring& coloring, int block_sweeps, double tolerance,
         std::int64_t& count)
      : stage_(stage),
        coloring_(coloring),
        block_sweeps_(block_sweeps),
        tolerance_(tolerance),
        count_(count) {}

  /// Sets the velocities to what the impulses give, and starts the directions anew.
  void start() {
    set_velocities();
    parallel::for_each<Host>("response.start", stage_.solver.size(), StartBodies{stage_});
  }

  void set_velocities() {
    parallel::for_each<Host>("response.release", stage_.solver.size(), Release{stage_});
    for_each_color("response.push", coloring_, [this](std::int64_t first) { return Push{stage_, first}; });
  }

  /// From a start on, until they converge, but at most so often. The last sweep stands as it is, so that
  /// every impulse ends inside its cone.
  bool run(int most) {
    double last_step = 0;
    double beta = 0;
    for (int sweep = 1; sweep <= most; ++sweep) {
      if (sweep > 1) {
        parallel::for_each<Host>("response.accelerate", stage_.solver.size(), AccelerateBodies{stage_, beta});
      }
      for_each_color("response.sweep", coloring_, [&](std::int64_t first) {
        return Sweep{stage_, first, beta, block_sweeps_};
      });
      ++count_;
      const auto total = parallel::sum<ImpulseChange, Host>("response.change", stage_.change.size(),
                                                            LoadChange{stage_.change});
      if (total.within(tolerance_)) return true;
      const double ratio = sweep > 1 ? total.step / last_step : 0.0;
      beta = ratio < 1.0 ? ratio : 0.0;
      last_step = total.step;
    }
    return false;
  }

 private:
  const SolveStage& stage_;
  const Coloring& coloring_;
  int block_sweeps_;
  double tolerance_;
  std::int64_t& count_;
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
      const Vec3 before = row.relative_velocity(i0, j0);
      const Vec3 after = row.relative_velocity(i, j);
      const bool driven_by_i = !i.is_free();
      const bool driven_by_j = !j.is_free();
      const Vec3 driver = driven_by_i   ? i.velocity_at(row.arm_i)
                          : driven_by_j ? j.velocity_at(row.arm_j)
                                        : Vec3(Vec3::Zero());
      ledger = ledger + account(row.impulse, contact.normal, before, after, driver, driven_by_j ? -1.0 : 1.0);
      contact.impulse += row.impulse;
    }
    return ledger;
  }
};

/// What the impulses move, as a parabola in their common scale s: linear s + square s^2 (J).
struct Moved {
  double linear = 0;
  double square = 0;

  SCREE_HD bool gains() const { return linear + square > tolerance::response_gain * square; }
  SCREE_HD friend Moved operator+(const Moved& a, const Moved& b) {
    return {a.linear + b.linear, a.square + b.square};
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

/// Scales down the impulses of an island that gains energy, to where it gains none.
struct KeepFromGaining {
  SolveStage stage;
  const Islands* islands;
  int operator()(std::int64_t island) const {
    const MoveByImpulses move{stage};
    Moved moved;
    for (const std::int32_t c : islands->contacts(island)) moved = moved + move(c);
    if (!moved.gains()) return 0;
    const double scale = moved.linear < 0 ? -moved.linear / moved.square : 0.0;
    for (const std::int32_t c : islands->contacts(island)) {
      for (int k = 0; k < stage.contacts[c].count; ++k) stage.rows_of(c)[k].impulse *= scale;
    }
    return 1;
  }
};

struct IsGaining {
  MoveByImpulses move;
  SCREE_HD int operator()(std::int64_t c) const { return move(c).gains() ? 1 : 0; }
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
    ImpulseChange residual;
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = stage.rows_of(c)[k];
      const Vec3 u = row.relative_velocity(stage.solver[contact.i], stage.solver[contact.j]);
      residual.add(row, natural_map(row, contact.normal, contact.friction, u) - row.impulse);
    }
    return residual;
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
      const int scaled =
          parallel::sum<int, Host>("response.scale", islands_.count(), KeepFromGaining{stage, &islands_});
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
