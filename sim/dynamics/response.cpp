#include "sim/dynamics/response.hpp"

#include "core/parallel_loops.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/contact_rows.hpp"
#include "sim/dynamics/direct.hpp"
#include "sim/dynamics/sweeps.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

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
  DirectLimits limits;
  View<DirectOutcome> outcome;
  void operator()(std::int64_t island) const {
    const IslandProblem problem{.contacts = stage.contacts,
                                .rows = stage.rows,
                                .solver = stage.solver,
                                .velocity = stage.free_velocity,
                                .spin = stage.free_spin,
                                .islands = *islands,
                                .island = island,
                                .guides = stage.guides};
    const ImpulseChange left =
        accurate ? natural_residual(problem) + rolling_residual(island) : change_of(island);
    outcome[island] = left.within(tolerance) ? DirectOutcome::not_needed
                      : rolls(island)        ? DirectOutcome::too_large
                                             : solve_directly(problem, tolerance, limits);
  }
  /// Newton's method knows no couples.
  bool rolls(std::int64_t island) const {
    return stage.rolls && std::ranges::any_of(islands->contacts(island), [&](std::int32_t c) {
             return stage.contacts[c].rolling_reach > 0;
           });
  }
  ImpulseChange rolling_residual(std::int64_t island) const {
    ImpulseChange residual;
    for (const std::int32_t c : islands->contacts(island)) residual = residual + stage.rolling_residual(c);
    return residual;
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
    return natural_residual(contact, stage.rows_of(c), stage.solver[contact.i], stage.solver[contact.j]) +
           stage.rolling_residual(c);
  }
};

/// When a loaded contact that slides comes to stick, as a share of the substep; 1 if it does not. Had it slid
/// all the while, friction would be k times the one that holds it at the end (k < 0 where that is upward, on
/// a slope), and the sliding speed of its points would go from before to free - k free (docs/decisions/0015).
struct SlipEnd {
  SolveStage stage;
  SCREE_HD double operator()(std::int64_t c) const {
    const Contact& contact = stage.contacts[c];
    if (!contact.loaded || contact.flying) return 1;
    double before = 0;
    double free = 0;
    double after = 0;
    double friction = 0;
    double most_friction = 0;
    for (int k = 0; k < contact.count; ++k) {
      const ContactRow& row = stage.rows[contact.first_row + k];
      const Vec3 slip = along(contact, stage.velocity_before(contact, row));
      const double speed = slip.norm();
      if (speed > 0) {
        free += stage.free_velocity_of(contact, row).dot(slip) / speed;
        friction -= row.impulse.dot(slip) / speed;
      }
      before += speed;
      after += along(contact, stage.velocity_after(contact, row)).norm();
      most_friction += contact.friction * row.impulse.dot(contact.normal);
    }
    const bool slides = before * stage.step > contact.count * tolerance::least_slide * contact.size;
    if (!slides || after > tolerance::sticking_slip * before || !(free * friction > 0)) return 1;
    const double share = before / (before + (most_friction / friction - 1) * free);
    return share > tolerance::least_cut && share < 1 - tolerance::least_cut ? share : 1;
  }
  SCREE_HD static Vec3 along(const Contact& contact, const Vec3& v) {
    return v - v.dot(contact.normal) * contact.normal;
  }
};
struct MinusSlipEnd {
  SlipEnd end;
  SCREE_HD double operator()(std::int64_t c) const { return -end(c); }
};

}  // namespace

bool ResponseSolver::count_outcomes(std::int64_t& solved, std::int64_t& failed) const {
  bool all_solved = true;
  for (const DirectOutcome outcome : outcome_.view()) {
    solved += outcome == DirectOutcome::solved;
    failed += outcome == DirectOutcome::failed;
    all_solved = all_solved && (outcome == DirectOutcome::solved || outcome == DirectOutcome::not_needed);
  }
  return all_solved;
}

LoadSpread ResponseSolver::spread_of_loads() const {
  LoadSpread spread;
  for (const ImpulseChange& contact : change_.view()) spread = spread + LoadSpread::of(contact.size);
  return spread;
}

void ResponseSolver::list_all(ContactSet& set, SolveStage& stage) {
  set.list_all(stage.solver);
  stage.contacts = set.contacts.view();
  stage.rows = set.rows.view();
  stage.couples = set.couples.view();
  sweeps_.look_at(stage);
}

bool ResponseSolver::find_impulses(SolveStage stage, const ResponseParameters& parameters, ContactSet& set,
                                   Counters& counters) {
  const SweepPlan plan = plan_sweeps(parameters, set);
  sweeps_.load(stage, set.coloring, set.batches);
  const bool one_by_one = plan.direct || parameters.accurate;
  if (one_by_one) list_all(set, stage);
  change_.resize(plan.direct ? set.contacts.size() : 0);
  stage.change = change_.view();
  sweeps_.look_at(stage);
  sweeps_.set_velocities();
  const auto sweep = [&](int most) { return sweeps_.run(plan, most, counters.sweeps); };
  const auto solve_islands = [&](const DirectLimits& limits, std::int64_t& solved, std::int64_t& failed) {
    sweeps_.set_velocities();
    sweeps_.store_velocities();
    parallel::for_each<Host>(
        "response.islands", islands_.count(),
        SolveIsland{stage, &islands_, plan.tolerance, parameters.accurate, limits, outcome_.view()});
    sweeps_.take_impulses();
    return count_outcomes(solved, failed);
  };
  const int first = plan.direct ? sweeps_before_direct(plan.most, counters) : plan.most;
  bool converged = sweep(first);
  if (parameters.accurate || (!converged && first < plan.most) ||
      (converged && spread_of_loads().is_wide(plan.tolerance))) {
    islands_.find(set.contacts.view(), stage.solver);
    outcome_.resize(islands_.count());
    converged = solve_islands(parameters.accurate ? thorough_limits : quick_limits, counters.direct,
                              counters.direct_failed);
    if (!converged) {
      sweeps_.set_velocities();
      converged = sweep(std::max(plan.most - first, few_sweeps));
      if (!converged && !parameters.accurate && pays_patience(counters))
        converged = solve_islands(patient_limits, counters.patient, counters.patient_failed);
    }
  }
  // A few sweeps' rounding is none.
  if (one_by_one) sweeps_.set_velocities();
  sweeps_.store_velocities();
  return converged;
}

int ResponseSolver::keep_from_gaining(std::int64_t bodies, lanes::Batches& batches) {
  const auto any_gains = [](const lanes::Losses& losses) {
    return std::ranges::any_of(losses.of.at, [](double loss) { return loss < 0; });
  };
  if (std::ranges::none_of(loss_.view(), any_gains)) return 0;
  // Calls act(i, j, l) for each contact of a batch, in lane l.
  const std::int64_t balls = batches.balls.size();
  const auto for_each_contact = [&](std::int64_t batch, const auto& act) {
    const lanes::Ends& ends =
        batch < balls ? batches.balls.view()[batch].ends : batches.points.view()[batch - balls].ends;
    for (int l = 0; l < lanes::width; ++l) {
      if (ends.i[l] != batches.nobody) act(ends.i[l], ends.j[l], l);
    }
  };
  const auto free_end = [this](std::int32_t i, std::int32_t j) { return sweeps_.is_free(i) ? i : j; };
  islands_.start(bodies);
  moved_.assign(static_cast<std::size_t>(bodies), Moved{});
  for (std::int64_t b = 0; b < loss_.size(); ++b) {
    for_each_contact(b, [&](std::int32_t i, std::int32_t j, int l) {
      moved_[static_cast<std::size_t>(free_end(i, j))].linear -= loss_.view()[b].of.at[l];
      if (sweeps_.is_free(i) && sweeps_.is_free(j)) islands_.unite(i, j);
    });
  }
  for (std::size_t body = 0; body < moved_.size(); ++body) {
    const auto root = static_cast<std::size_t>(islands_.root(static_cast<std::int32_t>(body)));
    if (root != body) moved_[root].linear += std::exchange(moved_[body].linear, 0.0);
  }
  // So far that is what each island gains in all; those that do are looked at closely.
  const auto gains = [](const Moved& moved) { return moved.linear > 0; };
  if (std::ranges::none_of(moved_, gains)) return 0;
  const auto of_island = [&](auto& list, std::int32_t i, std::int32_t j) -> auto& {
    return list[static_cast<std::size_t>(islands_.root(free_end(i, j)))];
  };
  scale_.resize(moved_.size());
  std::ranges::transform(moved_, scale_.begin(),
                         [&](const Moved& moved) { return gains(moved) ? 0.0 : 1.0; });
  const auto for_each_gaining_batch = [&](const auto& act) {
    for (std::int64_t b = 0; b < loss_.size(); ++b) {
      bool any = false;
      for_each_contact(
          b, [&](std::int32_t i, std::int32_t j, int) { any = any || of_island(scale_, i, j) < 1; });
      if (any) act(b);
    }
  };
  for_each_gaining_batch([&](std::int64_t b) {
    const lanes::Lane square = sweeps_.square_of(b);
    for_each_contact(
        b, [&](std::int32_t i, std::int32_t j, int l) { of_island(moved_, i, j).square += square.at[l]; });
  });
  int scaled = 0;
  for (std::size_t island = 0; island < scale_.size(); ++island) {
    if (scale_[island] == 1) continue;
    Moved& moved = moved_[island];
    moved.linear -= moved.square;
    const bool too_much = moved.gains(tolerance::response_gain);
    scale_[island] = too_much ? moved.scale_without_gain() : 1.0;
    scaled += too_much;
  }
  if (scaled == 0) return 0;
  for_each_gaining_batch([&](std::int64_t b) {
    for_each_contact(b, [&](std::int32_t i, std::int32_t j, int l) {
      lanes::scale_impulse(batches, b, l, of_island(scale_, i, j));
    });
  });
  return scaled;
}

Ledger ResponseSolver::solve(const Manifolds& manifolds, double step, const ResponseParameters& parameters,
                             BallPairs& balls, double warm_start, BodyView bodies,
                             Array<SolverBody, Host>& solver, ContactSet& set, Counters& counters) {
  free_velocity_.resize(solver.size());
  free_spin_.resize(solver.size());
  SolveStage stage{.manifolds = manifolds,
                   .bodies = bodies,
                   .solver = solver.view(),
                   .contacts = set.contacts.view(),
                   .rows = set.rows.view(),
                   .couples = set.couples.view(),
                   .rolls = set.rolls,
                   .change = {},
                   .free_velocity = free_velocity_.view(),
                   .free_spin = free_spin_.view(),
                   .step = step,
                   .noise = tolerance::parting_speed * step * parameters.gravity.norm(),
                   .warm_start = warm_start,
                   .guides = parameters.guides};
  if (!balls.touching().empty()) {
    stage.balls = &balls;
    stage.pairs = balls.source(bodies, step, parameters);
    stage.pairs.noise = stage.noise;
  }
  parallel::for_each<Host>("response.kick", solver.size(), Kick{stage, parameters});
  Ledger ledger;
  slip_end_ = 1;
  if (set.contact_count() > 0) {
    const std::int64_t others = set.contacts.size();
    parallel::for_each<Host>("response.rows", others, PrepareRows{stage});
    if (!find_impulses(stage, parameters, set, counters)) ++counters.unconverged;
    if (set.all_are_listed) list_all(set, stage);
    if (parameters.accurate) {
      const auto left =
          parallel::sum<ImpulseChange, Host>("response.residual", set.contacts.size(), LoadResidual{stage});
      if (left.size > 0) counters.residual = std::max(counters.residual, std::sqrt(left.step / left.size));
    }
    lanes::Books books = sweeps_.book(loss_);
    if (const int scaled = keep_from_gaining(solver.size(), set.batches); scaled > 0) {
      counters.scaled += scaled;
      sweeps_.store_impulses();
      sweeps_.set_velocities();
      sweeps_.store_velocities();
      books = sweeps_.book(loss_);
    }
    ledger.restitution = books.restitution;
    ledger.friction = books.friction;
    ledger.work = books.work;
    if (parameters.accurate && parameters.friction && !set.is_heap())
      slip_end_ =
          -parallel::max<double, Host>("response.slip", set.contacts.size(), MinusSlipEnd{{stage}}, -1.0);
  }
  if (parameters.torque.size() > 0) {
    ledger.work +=
        parallel::sum<double, Host>("response.torque", solver.size(), WorkOfTorque{stage, parameters.torque});
  }
  parallel::for_each<Host>("response.store", solver.size(), StoreVelocities{stage});
  return ledger;
}

}  // namespace scree
