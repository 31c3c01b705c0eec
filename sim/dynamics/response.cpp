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
  ConstView<Vec3> shift;
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
  Vec3 kick;
  SCREE_HD void operator()(std::int64_t k) const {
    SolverBody& body = stage.solver[k];
    if (!body.is_free()) return;
    stage.bodies.velocity[k] = body.velocity;
    stage.bodies.spin[k] = body.spin;
    body.velocity += kick;
  }
};

/// Arms, gaps and targets at the midpoint, after what impacts shifted.
struct PrepareRows {
  SolveStage stage;
  SCREE_HD void operator()(std::int64_t c) const {
    Contact& contact = stage.contacts[c];
    const Manifold& m = stage.manifolds[contact.manifold];
    const BodyView& bodies = stage.bodies;
    if (contact.falling) {
      contact.count = 0;
      return;
    }
    // Where several points share the load, the closed shell keeps all of them in contact; a single point
    // rests at 0.
    const double shell =
        contact.count == 1 ? 0.0
                           : tolerance::closed_gap * fmin(smallest_size(bodies.shape[m.i], bodies.size[m.i]),
                                                          smallest_size(bodies.shape[m.j], bodies.size[m.j]));
    const Vec3 middle_shift = 0.5 * (stage.shift[m.i] + stage.shift[m.j]);
    const double opened = m.normal.dot(stage.shift[m.j] - stage.shift[m.i]);
    for (int k = 0; k < contact.count; ++k) {
      ContactRow& row = stage.rows_of(c)[k];
      const Vec3 impulse = row.impulse;
      const Vec3 point = m.points[k].position + middle_shift;
      const double gap = m.points[k].gap + opened;
      const Vec3 arm_i = point - bodies.position[m.i];
      const Vec3 arm_j = point - bodies.position[m.j];
      const SolverBody& i = stage.solver[m.i];
      const SolverBody& j = stage.solver[m.j];
      row = contact.balls
                ? make_ball_row(arm_i, arm_j, gap, i, j)
                : make_row(m.normal, arm_i, arm_j, gap, i, j, stage.couplings[contact.first_row + k]);
      row.impulse = impulse;
      // The next midpoint must not overlap: the gap may close by then, and no more (speculative contact).
      row.target = gap > shell ? -(gap - shell) / stage.step : 0.0;
    }
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
      // Points of one manifold are solved as a block: they share both bodies, which are at hand.
      const int inner = contact.count > 1 ? manifold_sweeps : 1;
      for (int sweep = 0; sweep < inner; ++sweep) {
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
  static constexpr int manifold_sweeps = 4;
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
                         .shift = std::as_const(set.shift).view(),
                         .change = change_.view(),
                         .acceleration = body_acceleration_.view(),
                         .step = step};
  parallel::for_each<Host>("response.kick", solver.size(), Kick{stage, step * parameters.gravity});
  Ledger ledger;
  if (n > 0) {
    parallel::for_each<Host>("response.rows", n, PrepareRows{stage});
    for_each_color("response.warm_start", set.coloring, [&stage](std::int64_t first) {
      return WarmStart{stage, first};
    });
    parallel::for_each<Host>("response.start", solver.size(), StartBodies{stage});
    bool converged = false;
    double last_step = 0;
    double beta = 0;
    for (int sweep = 1; !converged; ++sweep) {
      for_each_color("response.sweep", set.coloring, [&stage, beta](std::int64_t first) {
        return Sweep{stage, first, beta};
      });
      ++counters.sweeps;
      const auto total =
          parallel::sum<SweepChange, Host>("response.change", n, LoadChange{std::as_const(change_).view()});
      converged = total.step <= parameters.tolerance * parameters.tolerance * total.size;
      if (converged || sweep == parameters.iterations) break;
      // The last sweep stands as it is, so that every impulse ends inside its cone.
      const double ratio = sweep > 1 ? total.step / last_step : 0.0;
      beta = ratio < 1.0 ? ratio : 0.0;
      last_step = total.step;
      parallel::for_each<Host>("response.accelerate", solver.size(), AccelerateBodies{stage, beta});
    }
    if (!converged) ++counters.unconverged;
    ledger = parallel::sum<Ledger, Host>("response.ledger", n, Account{stage});
  }
  parallel::for_each<Host>("response.store", solver.size(), StoreVelocities{stage});
  return ledger;
}

}  // namespace scree
