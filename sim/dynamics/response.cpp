#include "sim/dynamics/response.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/colored.hpp"

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
  View<SweepChange> change;
  View<BodyAcceleration> acceleration;
  double step;

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
    if (!body.is_free()) return;
    stage.bodies.velocity[k] = body.velocity;
    stage.bodies.spin[k] = body.spin;
    body.velocity += stage.step * parameters.acceleration_of(k);
    if (parameters.torque.size() > 0) {
      body.spin += stage.step * (body.inverse_inertia * parameters.torque[k]).eval();
    }
  }
};

/// Arms, gaps and targets at the midpoint.
struct PrepareRows {
  SolveStage stage;
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
      if (contact.flying) row.target = fmin(row.target, flight_speed(contact, row));
      // What opened before the kick closes again at that speed at least, or its impulse would do work: so a
      // box that turns on its corner, whose arm the midpoint sees turned, keeps its energy.
      row.target = fmin(row.target, -opening_speed(contact, row));
    }
  }

  /// Before the kick; 0 if it closed.
  SCREE_HD double opening_speed(const Contact& contact, const ContactRow& row) const {
    SolverBody i = stage.solver[contact.i];
    SolverBody j = stage.solver[contact.j];
    i.velocity = stage.bodies.velocity[contact.i];
    i.spin = stage.bodies.spin[contact.i];
    j.velocity = stage.bodies.velocity[contact.j];
    j.spin = stage.bodies.spin[contact.j];
    return fmax(0.0, contact.normal.dot(row.relative_velocity(i, j)));
  }

  /// A little faster than the flight closes along the normal, so that rounding pushes nobody.
  SCREE_HD double flight_speed(const Contact& contact, const ContactRow& row) const {
    const double speed =
        contact.normal.dot(row.relative_velocity(stage.solver[contact.i], stage.solver[contact.j]));
    return speed - tolerance::flight_margin * fabs(speed);
  }
};

struct WarmStart {
  SolveStage stage;
  std::int64_t first;
  SCREE_HD void operator()(std::int64_t k) const {
    const Contact& contact = stage.contacts[first + k];
    SolverBody i = stage.solver[contact.i];
    SolverBody j = stage.solver[contact.j];
    for (int p = 0; p < contact.count; ++p) {
      const ContactRow& row = stage.rows_of(first + k)[p];
      row.push(row.impulse, i, j);
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
    SweepChange change;
    for (int p = 0; p < contact.count; ++p) {
      ContactRow& row = rows[p];
      row.change = row.impulse - last[p];
      change.step += row.change.squaredNorm() / row.normal_mass;
      change.size += row.impulse.squaredNorm() / row.normal_mass;
    }
    stage.change[c] = change;
  }
};

struct LoadChange {
  ConstView<SweepChange> change;
  SCREE_HD SweepChange operator()(std::int64_t c) const { return change[c]; }
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

struct Account {
  SolveStage stage;
  SCREE_HD Ledger operator()(std::int64_t c) const {
    Contact& contact = stage.contacts[c];
    const SolverBody& i = stage.solver[contact.i];
    const SolverBody& j = stage.solver[contact.j];
    // The velocities before the kick; those of bodies that are not free do not change.
    SolverBody i0 = i;
    SolverBody j0 = j;
    i0.velocity = stage.bodies.velocity[contact.i];
    i0.spin = stage.bodies.spin[contact.i];
    j0.velocity = stage.bodies.velocity[contact.j];
    j0.spin = stage.bodies.spin[contact.j];
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

}  // namespace

Ledger ResponseSolver::solve(ConstView<Manifold> manifolds, double step, const ResponseParameters& parameters,
                             BodyView bodies, Array<SolverBody, Host>& solver, ContactSet& set,
                             Counters& counters) {
  const std::int64_t n = set.contacts.size();
  change_.resize(n);
  body_acceleration_.resize(solver.size());
  const SolveStage stage{.manifolds = manifolds,
                         .bodies = bodies,
                         .solver = solver.view(),
                         .contacts = set.contacts.view(),
                         .rows = set.rows.view(),
                         .couplings = set.couplings.view(),
                         .change = change_.view(),
                         .acceleration = body_acceleration_.view(),
                         .step = step};
  parallel::for_each<Host>("response.kick", solver.size(), Kick{stage, parameters});
  Ledger ledger;
  if (n > 0) {
    parallel::for_each<Host>("response.rows", n, PrepareRows{stage});
    for_each_color("response.warm_start", set.coloring, [&stage](std::int64_t first) {
      return WarmStart{stage, first};
    });
    parallel::for_each<Host>("response.start", solver.size(), StartBodies{stage});
    SweepPlan plan = automatic_sweeps(set.rows.size());
    if (parameters.iterations > 0) plan.sweeps = parameters.iterations;
    if (parameters.block_sweeps > 0) plan.block_sweeps = parameters.block_sweeps;
    bool converged = false;
    double last_step = 0;
    double beta = 0;
    for (int sweep = 1; !converged; ++sweep) {
      for_each_color("response.sweep", set.coloring, [&](std::int64_t first) {
        return Sweep{stage, first, beta, plan.block_sweeps};
      });
      ++counters.sweeps;
      const auto total =
          parallel::sum<SweepChange, Host>("response.change", n, LoadChange{std::as_const(change_).view()});
      converged = total.step <= parameters.tolerance * parameters.tolerance * total.size;
      if (converged || sweep == plan.sweeps) break;
      // The last sweep stands as it is, so that every impulse ends inside its cone.
      const double ratio = sweep > 1 ? total.step / last_step : 0.0;
      beta = ratio < 1.0 ? ratio : 0.0;
      last_step = total.step;
      parallel::for_each<Host>("response.accelerate", solver.size(), AccelerateBodies{stage, beta});
    }
    if (!converged) ++counters.unconverged;
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
