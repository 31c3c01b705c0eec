#include "sim/dynamics/sweeps.hpp"

#include "core/parallel.hpp"
#include "sim/dynamics/colored.hpp"

namespace scree {

namespace {

struct Release {
  SolveStage stage;
  SCREE_HD void operator()(std::int64_t k) const {
    stage.solver[k].velocity = stage.free_velocity[k];
    stage.solver[k].spin = stage.free_spin[k];
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

}  // namespace

void Sweeps::start() {
  set_velocities();
  parallel::for_each<Host>("response.start", stage_.solver.size(), StartBodies{stage_});
}

void Sweeps::set_velocities() {
  parallel::for_each<Host>("response.release", stage_.solver.size(), Release{stage_});
  for_each_color("response.push", coloring_, [this](std::int64_t first) { return Push{stage_, first}; });
}

bool Sweeps::run(int most) {
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

}  // namespace scree
