// ContactSolver::solve(): the impulses of a substep, the energy that they move, and the velocities after
// them.
#include "core/parallel.hpp"
#include "core/space_phases.hpp"
#include "core/space_tiles.hpp"
#include "core/tolerances.hpp"
#include "sim/contacts/ball_tiles.hpp"
#include "sim/response/contact_solver.hpp"
#include "sim/response/contact_solver_loops.hpp"
#include "sim/response/contacts_on_host.hpp"
#include "sim/response/scaling.hpp"
#include "sim/response/sweep_loop.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace scree::solver {

namespace {

/// Largest numbers of slots and of bodies for which it pays to copy them from Device to Host and back.
constexpr std::int64_t few_places = 1 << 16;
constexpr std::int64_t few_bodies = 1 << 14;

}  // namespace

template <class Space, class Real>
template <bool only_balls>
SweepState ContactSolver<Space, Real>::run_impulse_phases(const SweepPlan& plan) {
  return parallel::run_in_phases<Space>(
      "sweeps",
      ImpulsePhases<Real, only_balls>{.ball_colors = ColorPhases(store_.ball_colors(), visit_width<Space>),
                                      .point_colors = ColorPhases(store_.point_colors(), visit_width<Space>),
                                      .balls = store_.balls(),
                                      .points = store_.points(),
                                      .rolls = rolls(),
                                      .ball_rolling = rolling_of_balls(),
                                      .point_rolling = rolling_of_points(),
                                      .bodies = solver_.data(),
                                      .last = last_.data(),
                                      .body_count = slots_.solver_bodies().count(),
                                      .hubs = join_hubs(solver_),
                                      .guides = {guided_.view(), solver_.data()},
                                      .least = plan.least,
                                      .most = plan.most,
                                      .block_sweeps = plan.block_sweeps,
                                      .tolerance = plan.tolerance,
                                      .first_with_momentum = plan.first_with_momentum},
      SweepState{});
}

/// Finds the impulses. Returns whether they have converged.
template <class Space, class Real>
bool ContactSolver<Space, Real>::find_impulses(const ConstBodyView& bodies,
                                               const ResponseParameters& parameters, double share,
                                               Counters& counters) {
  SweepPlan plan =
      plan_sweeps(parameters, counts_.contacts, counts_.points, sweep_count_.flows(), sweep_count_.change());
  if (std::is_same_v<Real, float>) plan.tolerance = std::max(plan.tolerance, tolerance::mixed_change);
  if (has_heap()) {
    plan.least = sweep_count_.sweeps(plan.least, shares_loads(counts_.contacts, counts_.points), share);
    if (parameters.iterations > 0) plan.least = std::min(plan.least, plan.most);
    plan.most = std::max(plan.most, plan.least);
    if (sweep_count_.needs_least_sweeps()) plan.first_with_momentum = plan.least;
  }
  const bool islands = parameters.accurate || (plan.direct && fits_on_host());
  const bool converged =
      islands ? solve_islands(bodies, plan, parameters.accurate, counters) : sweep(plan, counters);
  counters.unconverged += !converged;
  return converged;
}

template <class Space, class Real>
bool ContactSolver<Space, Real>::fits_on_host() const {
  return std::is_same_v<Space, Host> ||
         (slots_.places().size() <= few_places && slots_.solver_bodies().count() <= few_bodies);
}

/// Sweeps over the contacts. At the start the bodies of the solver have their velocities without contacts.
template <class Space, class Real>
bool ContactSolver<Space, Real>::sweep(const SweepPlan& plan, Counters& counters) {
  const SweepState done =
      store_.point_colors().colors() == 0 ? run_impulse_phases<true>(plan) : run_impulse_phases<false>(plan);
  counters.sweeps += done.sweeps;
  return done.converged;
}

/// Computes the velocities anew from the impulses, so that the rounding errors of many sweeps do not remain.
template <class Space, class Real>
void ContactSolver<Space, Real>::set_velocities() {
  SweepPlan push{.least = 0, .most = 0, .block_sweeps = 1, .tolerance = 0, .direct = false};
  Counters none;
  copy(solver_, free_);
  sweep(push, none);
}

template <class Space, class Real>
LoadSpread ContactSolver<Space, Real>::spread_of_loads() {
  return sum_over_contacts<LoadSpread>("sweeps.loads", BallLoad<Real>{store_.balls()},
                                       PointLoad<Real>{store_.points()});
}

/// Sweeps over the contacts, then solves islands that converge slowly by the direct solver on Host. In the
/// accurate mode it solves all islands whose natural residual is beyond the tolerance.
template <class Space, class Real>
bool ContactSolver<Space, Real>::solve_islands(const ConstBodyView& bodies, const SweepPlan& plan,
                                               bool accurate, Counters& counters) {
  SweepPlan first = plan, rest = plan;
  if (plan.direct) first.most = sweeps_before_direct(plan.most, sweep_count_.moves(), counters);
  rest.most = std::max(plan.most - first.most, few_sweeps);
  const auto solve_directly = [&](const DirectLimits& limits, const std::vector<BodyRecord<Real>>* before,
                                  std::int64_t& solved, std::int64_t& failed) {
    Inspection<Real> seen = inspect(bodies);
    ContactsOnHost<Real> contacts(seen, guides_);
    const bool all = contacts.solve(plan.tolerance, limits, before, solved, failed);
    put_back(seen, contacts);
    return all;
  };
  const auto sweep_many = [&](const SweepPlan& of) {
    const std::int64_t before = counters.sweeps;
    copy(solver_, free_);
    const bool converged = sweep(of, counters);
    if (counters.sweeps - before > few_sweeps) set_velocities();
    return converged;
  };
  const bool converged = sweep_many(first);
  if (!converged && !accurate && plan.most <= few_sweeps) return false;
  if (converged && (accurate ? are_solved(plan.tolerance) : !spread_of_loads().is_wide(plan.tolerance)))
    return true;
  const DirectLimits& limits = accurate ? thorough_limits : quick_limits;
  if (solve_directly(limits, nullptr, counters.direct, counters.direct_failed)) return true;
  if (sweep_many(rest)) return true;
  if (accurate || !pays_long_solution(counters)) return false;
  const std::vector<BodyRecord<Real>> before = velocities_before(bodies);
  return solve_directly(long_limits, &before, counters.long_direct, counters.long_direct_failed);
}

template <class Space, class Real>
void ContactSolver<Space, Real>::put_back(Inspection<Real>& seen, const ContactsOnHost<Real>& contacts) {
  contacts.put_back();
  if (seen.from_device != nullptr) {
    store_.copy_from(seen.from_device->store);
    copy(ball_rolling_, seen.from_device->ball_rolling);
    copy(point_rolling_, seen.from_device->point_rolling);
  }
  set_velocities();
}

template <class Space, class Real>
Residual<Real, BallContacts<Real>, TurnBalls> ContactSolver<Space, Real>::residual_of_balls() {
  return {store_.balls(), rolls(), rolling_of_balls(), std::as_const(solver_).view()};
}
template <class Space, class Real>
Residual<Real, PointContacts<Real>, TurnPoints> ContactSolver<Space, Real>::residual_of_points() {
  return {store_.points(), rolls(), rolling_of_points(), std::as_const(solver_).view()};
}

/// Returns the sums over each island of the values that `of_balls` and `of_points` compute for its contacts.
template <class Space, class Real>
template <class Sum, class OfBalls, class OfPoints>
IslandSums<Space, Sum> ContactSolver<Space, Real>::sum_by_island(const OfBalls& of_balls,
                                                                 const OfPoints& of_points) {
  const ConstView<Slot> places = slots_.places();
  const ConstView<BodyRecord<Real>> solver = std::as_const(solver_).view();
  IslandSums<Space, Sum> sums(slots_.solver_bodies().count());
  sums.add(TermOfIsland<Real, BallContacts<Real>, OfBalls>{places, 0, store_.balls(), solver, of_balls});
  sums.add(TermOfIsland<Real, PointContacts<Real>, OfPoints>{places, slots_.ball_places(), store_.points(),
                                                             solver, of_points});
  return sums;
}

/// Returns whether the natural residual of each island is within the tolerance.
template <class Space, class Real>
bool ContactSolver<Space, Real>::are_solved(double tolerance) {
  return sum_by_island<ImpulseChange>(residual_of_balls(), residual_of_points())
      .all([tolerance](const ImpulseChange& residual) { return residual.within(tolerance); });
}

/// Returns the natural residual of all impulses, relative to their size.
template <class Space, class Real>
double ContactSolver<Space, Real>::residual() {
  const auto left =
      sum_over_contacts<ImpulseChange>("response.residual", residual_of_balls(), residual_of_points());
  return left.size > 0 ? std::sqrt(left.step / left.size) : 0.0;
}

template <class Space, class Real>
double ContactSolver<Space, Real>::find_slip_end(const AccountStage<Real>& stage) {
  const SlipEnd<Real, BallContacts<Real>> of_balls{stage, 0, store_.balls(), loads()};
  const SlipEnd<Real, PointContacts<Real>> of_points{stage, slots_.ball_places(), store_.points(), loads()};
  const Earliest end = Earliest{1.0} + sum_over_contacts<Earliest>("response.slip", of_balls, of_points);
  return end.time;
}

/// Makes the work that gives the bodies of the solver the velocities that `bodies` have.
template <class Space, class Real>
ReloadBody<Real> ContactSolver<Space, Real>::reload(const ConstBodyView& bodies,
                                                    const Array<BodyRecord<Real>, Space>& from,
                                                    Array<BodyRecord<Real>, Space>& to) {
  const SolverBodies<Space>& all = slots_.solver_bodies();
  return {bodies,           all.hubs(),  all.hub_of_parts(), all.first_wall_point(),
          all.first_part(), from.view(), to.view()};
}

/// Returns the velocities of the bodies of the solver before the substep's forces.
template <class Space, class Real>
std::vector<BodyRecord<Real>> ContactSolver<Space, Real>::velocities_before(const ConstBodyView& bodies) {
  before_.resize(free_.size());
  parallel::for_each<Space>("accounts.before", before_.size(), reload(bodies, free_, before_));
  return to_vector(before_);
}

/// Scales down impulses that would gain energy, until they gain none. Few contacts are scaled island by
/// island; those of a heap (or too many for Host) by one factor, as one island. Returns the number of islands
/// scaled.
template <class Space, class Real>
int ContactSolver<Space, Real>::keep_from_gaining(const AccountStage<Real>& stage) {
  if (has_heap() || !fits_on_host()) {
    const Moved moved = totals_.moved();
    if (!moved.gains(response_gain<Real>)) return 0;
    copy(last_, solver_);
    // The scale is rounded down, so that it does not depend on the order in which the sums were added up.
    constexpr double levels = 1 << 20;
    scale_impulses(std::floor(levels * moved.scale_without_gain()) / levels);
    fly_on_with_changes(false);
    return 1;
  }
  if (no_island_gains(stage)) return 0;
  Inspection<Real> seen = inspect(stage.bodies);
  ContactsOnHost<Real> contacts(seen, guides_);
  const int scaled = contacts.keep_from_gaining(velocities_before(stage.bodies));
  if (scaled == 0) return 0;
  copy(last_, solver_);
  put_back(seen, contacts);
  fly_on_with_changes(false);
  return scaled;
}

/// Returns whether the impulses of no island gain energy. For that the energy that each contact moves is
/// accounted once more.
template <class Space, class Real>
bool ContactSolver<Space, Real>::no_island_gains(AccountStage<Real> stage) {
  stage.again = true;
  return sum_by_island<Moved>(MovedBy{rolls(), account_balls(stage), account_rolling_balls(stage)},
                              MovedBy{rolls(), account_points(stage), account_rolling_points(stage)})
      .all([](const Moved& moved) { return !moved.gains(response_gain<Real>); });
}

template <class Space, class Real>
void ContactSolver<Space, Real>::scale_impulses(double by) {
  const auto real = static_cast<Real>(by);
  for_balls("response.scale", ScaleBalls<Real>{store_.balls(), real});
  for_points("response.scale", ScalePoints<Real>{store_.points(), real});
  if (rolls()) {
    for_balls("response.scale", ScaleRolling<Real>{rolling_of_balls(), real});
    for_points("response.scale", ScaleRolling<Real>{rolling_of_points(), real});
  }
  parallel::for_each<Space>("response.scale", solver_.size(),
                            ScaleVelocities<Real>{free_.view(), solver_.view(), real});
}

template <class Space, class Real>
AccountStage<Real> ContactSolver<Space, Real>::account_stage(const ConstBodyView& bodies,
                                                             const ResponseParameters& parameters) {
  return {slots_.places(), bodies, free_.view(),       solver_.view(),
          parameters,      step_,  next_loads_.view(), slots_.are_candidates()};
}

template <class Space, class Real>
AccountBalls<Real> ContactSolver<Space, Real>::account_balls(const AccountStage<Real>& stage) {
  return {stage, store_.balls(), slots_.ball_memory()};
}
template <class Space, class Real>
AccountPoints<Real> ContactSolver<Space, Real>::account_points(const AccountStage<Real>& stage) {
  return {stage, slots_.ball_places(), store_.points(), slots_.point_memory()};
}
template <class Space, class Real>
AccountRolling<Real, BallContacts<Real>> ContactSolver<Space, Real>::account_rolling_balls(
    const AccountStage<Real>& stage) {
  return {stage, 0, store_.balls(), rolling_of_balls(), slots_.couples()};
}
template <class Space, class Real>
AccountRolling<Real, PointContacts<Real>> ContactSolver<Space, Real>::account_rolling_points(
    const AccountStage<Real>& stage) {
  return {stage, slots_.ball_places(), store_.points(), rolling_of_points(), slots_.couples()};
}

template <class Space, class Real>
ContactTotals ContactSolver<Space, Real>::account_ball_blocks(const AccountStage<Real>& stage) requires(
    has_ball_kernels<Space, Real>) {
  before_.resize(free_.size());
  parallel::for_each<Host>("accounts.before", before_.size(), reload(stage.bodies, free_, before_));
  const AccountBallBlocks account{.account = {.contacts = store_.balls(),
                                              .before = before_.data(),
                                              .free = free_.data(),
                                              .solver = solver_.data(),
                                              .step = stage.step,
                                              .rounding = response_gain<Real>,
                                              .again = stage.again},
                                  .stage = stage,
                                  .memory = slots_.ball_memory()};
  return parallel::sum<ContactTotals, Host>("accounts.balls", account.runs(), account);
}

template <class Space, class Real>
void ContactSolver<Space, Real>::account(const AccountStage<Real>& stage) {
  // The sums of all kinds are copied to Host at once, and a kind without contacts costs nothing.
  kind_totals_.resize(4);
  std::size_t kinds = 0;
  const auto add_up = [&](const char* label, const auto& account) {
    const std::int64_t contacts = account.contacts.slot.size();
    if (contacts == 0) return;
    parallel::sum_into<ContactTotals, Space>(label, contacts, on_contacts(account.contacts, account),
                                             totals_scratch_, kind_totals_.data() + kinds++);
  };
  if constexpr (!has_ball_kernels<Space, Real>) {
    add_up("accounts.balls", account_balls(stage));
  } else if (store_.ball_colors().contacts() > 0) {
    kind_totals_.view()[kinds++] = account_ball_blocks(stage);
  }
  add_up("accounts.points", account_points(stage));
  if (rolls()) {
    add_up("accounts.rolling", account_rolling_balls(stage));
    add_up("accounts.rolling", account_rolling_points(stage));
  }
  ContactTotals of_kind[4];
  copy_bytes<Host, Space>(of_kind, kind_totals_.data(), kinds * sizeof(ContactTotals));
  totals_ = of_kind[0] + of_kind[1] + of_kind[2] + of_kind[3];
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::solve(const FlightStage& flight, bool any_late_impact, double share,
                                         Counters& counters) {
  const ResponseParameters& parameters = flight.parameters;
  const ConstBodyView bodies = read_only(flight.bodies);
  Ledger ledger;
  totals_ = {};
  slip_end_ = 1;
  parallel::fill("accounts.loads", next_loads_, 0u);
  if (counts_.contacts > 0) {
    const std::int64_t failed_before = counters.direct_failed;
    const bool converged = find_impulses(bodies, parameters, share, counters);
    const bool newton_failed = !converged && counters.direct_failed > failed_before;
    if (parameters.accurate) counters.residual = std::max(counters.residual, residual());
    AccountStage<Real> stage = account_stage(bodies, parameters);
    account(stage);
    if (totals_.gaining > 0) {
      if (const int scaled = keep_from_gaining(stage); scaled > 0) {
        counters.scaled += scaled;
        parallel::fill("accounts.loads", next_loads_, 0u);
        stage = account_stage(bodies, parameters);
        stage.again = true;
        account(stage);
      }
    }
    ledger.restitution = totals_.restitution;
    ledger.friction = totals_.friction;
    ledger.work = totals_.work;
    sweep_count_.judge(totals_.residual_power, totals_.impulse_power, totals_.restitution + totals_.friction);
    // Where Newton's method has failed, the impulses do not tell when a contact comes to stick.
    if (parameters.accurate && parameters.friction && !has_heap() && !newton_failed)
      slip_end_ = find_slip_end(stage);
  }
  if (parameters.torque.size() > 0) {
    ledger.work += parallel::sum_by_tiles<double, Space>(
        "accounts.torque", bodies.count(),
        WorkOfTorque<Real>{bodies, solver_.view(), parameters.torque, step_});
  }
  parallel::for_each<Space>(
      "contacts.velocities", bodies.count(),
      StoreVelocities<Real>{free_.view(), solver_.view(), parameters, step_, flight.bodies});
  if (any_late_impact && counts_.contacts > 0) ledger = ledger + shift_after_late_impacts(flight);
  return ledger;
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::shift_after_late_impacts(const FlightStage& flight) {
  for_balls("late impacts.turn",
            TurnLateBalls<Real>{store_.balls(), slots_.places(), std::as_const(solver_).view(), flight});
  for_points("late impacts.turn",
             TurnLatePoints<Real>{store_.points(), slots_.places_of_others(), std::as_const(free_).view(),
                                  std::as_const(solver_).view(), flight});
  const LateMoments<Real> moments{flight, free_.view(), solver_.view()};
  Array<Ledger, Space> totals(3);
  const LateBallMoments<Real> of_balls{moments, store_.balls(), slots_.places()};
  const LatePointMoments<Real> of_points{moments, store_.points(), slots_.places_of_others()};
  parallel::sum_into<Ledger, Space>("late impacts.moments", of_balls.contacts.slot.size(),
                                    on_contacts(of_balls.contacts, of_balls), ledger_scratch_, totals.data());
  parallel::sum_into<Ledger, Space>("late impacts.moments", of_points.contacts.slot.size(),
                                    on_contacts(of_points.contacts, of_points), ledger_scratch_,
                                    totals.data() + 1);
  parallel::sum_into<Ledger, Space>("late impacts.shift", flight.bodies.count(),
                                    ShiftLate<Real>{flight, free_.view(), solver_.view()}, ledger_scratch_,
                                    totals.data() + 2);
  Ledger parts[3];
  copy_bytes<Host, Space>(parts, totals.data(), sizeof(parts));
  return parts[0] + parts[1] + parts[2];
}

template <class Space, class Real>
void ContactSolver<Space, Real>::take_velocities(const FlightStage& flight) {
  const ConstBodyView bodies = read_only(flight.bodies);
  last_.swap(solver_);
  parallel::for_each<Space>(
      "gaps.reload", solver_.size(),
      TakeImpacts<Real>{reload(bodies, last_, solver_), std::as_const(mid_).view(), flight, last_.view()});
  fly_on_with_changes(true);
}

/// Corrects the gaps at the end of the substep, after the velocities have changed from those of `last_`.
/// `rotations_are_applied`: whether shift_after_late_impacts() has been called.
template <class Space, class Real>
void ContactSolver<Space, Real>::fly_on_with_changes(bool rotations_are_applied) {
  for_balls("gaps.predict", PredictGapsOfBalls<Real>{store_.balls(), last_.view(), solver_.view(), step_});
  for_points("gaps.predict", PredictGapsOfPoints<Real>{store_.points(), last_.view(), solver_.view(), step_,
                                                       rotations_are_applied});
}

#define SCREE_INSTANTIATE_REAL(Space, Real)                                                       \
  template Ledger ContactSolver<Space, Real>::solve(const FlightStage&, bool, double, Counters&); \
  template void ContactSolver<Space, Real>::take_velocities(const FlightStage&);
#define SCREE_INSTANTIATE(Space)        \
  SCREE_INSTANTIATE_REAL(Space, double) \
  SCREE_INSTANTIATE_REAL(Space, float)
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
