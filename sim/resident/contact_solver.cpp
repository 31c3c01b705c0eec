#include "sim/resident/contact_solver.hpp"

#include "core/parallel.hpp"
#include "core/space_rounds.hpp"
#include "core/space_tiles.hpp"
#include "core/tolerances.hpp"
#include "sim/resident/few_contacts.hpp"
#include "sim/resident/padding.hpp"
#include "sim/resident/rounds.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace scree::resident {

namespace {

constexpr int tile = parallel::tile;

}  // namespace

template <class Space, class Real>
void ContactSolver<Space, Real>::take_candidates(ConstView<Pair> candidates,
                                                 ConstView<std::int32_t> place_before,
                                                 const ConstBodyView& bodies, bool rolls) {
  slots_.build(candidates, place_before, bodies, rolls);
  make_places();
  const std::int64_t balls = store_.ball_places();
  for (auto* loads : {&loads_, &next_loads_}) {
    loads->resize((candidates.size() + 3) / 4);
    parallel::fill("contacts.loads", *loads, 0u);
  }
  const BookStage<Real> stage{slots_.places(), bodies, {}, {}, {}, 0, loads_.view()};
  parallel::for_each<Space>("contacts.loads", balls, MarkBallLoads<Real>{stage, slots_.ball_memory()});
  parallel::for_each<Space>("contacts.loads", store_.point_places(),
                            MarkPointLoads<Real>{stage, balls, slots_.point_memory()});
}

/// For the contacts that the slots may have.
template <class Space, class Real>
void ContactSolver<Space, Real>::make_places() {
  const std::int64_t balls = slots_.balls().tiles() * tile;
  store_.resize(balls, slots_.places().size() - balls, tile);
  ball_list_.take(slots_.balls());
  point_list_.take(slots_.others());
}

template <class Space, class Real>
void ContactSolver<Space, Real>::archive(Archive& archive, const ConstBodyView& bodies) {
  archive.part("slots", slots_, bodies);
  archive.part("patience", patience_);
  archive("loads", loads_);
  if (!archive.is_loading()) return;
  make_places();
  next_loads_.resize(loads_.size());
}

template <class Space, class Real>
void ContactSolver<Space, Real>::look_up_loads(ConstView<Pair> candidates,
                                               ConstView<std::int32_t> place_before,
                                               Array<LoadedParts, Space>& loads) const {
  loads.resize(candidates.size());
  parallel::for_each<Space>(
      "contacts.loads", candidates.size(),
      LookUpLoads{candidates, {slots_.candidates(), place_before}, this->loads(), loads.view()});
}

template <class Space, class Real>
Inspection<Real> ContactSolver<Space, Real>::inspect() const {
  Inspection<Real> seen;
  seen.places.resize(static_cast<std::size_t>(slots_.places().size()));
  copy_bytes<Host, Space>(seen.places.data(), slots_.places().data(), seen.places.size() * sizeof(Slot));
  copy(seen.free, free_);
  seen.contacts.copy_from(store_);
  seen.first_wall_point = slots_.solver_bodies().first_wall_point();
  seen.step = step_;
  return seen;
}

template <class Space, class Real>
ConstView<Slot> ContactSolver<Space, Real>::places_of_points() const {
  const std::int64_t first = store_.ball_places();
  return {slots_.places().data() + first, slots_.places().size() - first};
}

template <class Space, class Real>
std::vector<WallImpulse> ContactSolver<Space, Real>::wall_impulses(ConstView<std::uint8_t> asked,
                                                                   const FlightStage& flight) {
  std::vector<WallImpulse> all;
  if (counts_.contacts == 0) return all;
  const ConstView<MidBody<Real>> mid = std::as_const(mid_).view();
  list_wall_impulses(
      ball_list_.size(),
      AskedBalls<Real>{{asked, slots_.places(), mid, flight}, store_.balls(), ball_list_.places()}, all);
  list_wall_impulses(
      point_list_.size(),
      AskedPoints<Real>{{asked, places_of_points(), mid, flight}, store_.points(), point_list_.places()},
      all);
  return all;
}

template <class Space, class Real>
template <class Asked>
void ContactSolver<Space, Real>::list_wall_impulses(std::int64_t contacts, const Asked& asked,
                                                    std::vector<WallImpulse>& out) {
  if (contacts == 0) return;
  parallel::select("contacts.walls", contacts, asked, Asked::none, asked_contacts_);
  wall_impulses_.resize(asked_contacts_.size());
  parallel::for_each<Space>(
      "contacts.walls", wall_impulses_.size(),
      PutWallImpulse<Asked>{asked, std::as_const(asked_contacts_).view(), wall_impulses_.view()});
  const std::size_t before = out.size();
  out.resize(before + static_cast<std::size_t>(wall_impulses_.size()));
  copy_bytes<Host, Space>(out.data() + before, wall_impulses_.data(),
                          static_cast<std::size_t>(wall_impulses_.size()) * sizeof(WallImpulse));
}

template <class Space, class Real>
void ContactSolver<Space, Real>::load_bodies(const ConstBodyView& bodies, ConstView<double> margin,
                                             const ResponseParameters& parameters) {
  const std::int64_t n = bodies.count();
  const std::int64_t all = slots_.solver_bodies().count();
  mid_.resize(n);
  for (auto* records : {&solver_, &free_, &last_}) records->resize(all);
  displacement_.resize(all);
  const bool only_balls = slots_.others().tiles() == 0;
  turn_.resize(only_balls ? 0 : all);
  parallel::for_each<Space>("contacts.bodies", n,
                            LoadBody<Real>{bodies, margin, parameters, step_, mid_.view(), solver_.view()});
  parallel::for_each<Space>(
      "contacts.bodies", slots_.solver_bodies().hub_of_parts().size(),
      LoadPart<Real>{slots_.solver_bodies().hubs(), slots_.solver_bodies().hub_of_parts(),
                     slots_.solver_bodies().share_of_parts(), slots_.solver_bodies().first_part(),
                     solver_.view()});
  const std::int64_t walls = slots_.solver_bodies().first_wall_point();
  parallel::for_each<Space>("contacts.bodies", all - walls, ClearNotFree<Real>{walls, solver_.view()});
  parallel::for_each<Space>("contacts.bodies", 1,
                            ClearNotFree<Real>{slots_.solver_bodies().nobody(), solver_.view()});
}

template <class Space, class Real>
void ContactSolver<Space, Real>::find(ConstView<double> margin, double scale, const FlightStage& flight,
                                      bool any_is_late) {
  step_ = flight.terms.step;
  const ConstBodyView bodies = read_only(flight.bodies);
  const ResponseParameters& parameters = flight.parameters;
  load_bodies(bodies, margin, parameters);
  const FindStage<Real> stage{.places = slots_.places(),
                              .mid = mid_.view(),
                              .bodies = bodies,
                              .solver = solver_.view(),
                              .laws = flight.terms.laws,
                              .parameters = parameters,
                              .step = step_,
                              .scale = scale,
                              .noise = tolerance::parting_speed * step_ * parameters.gravity.norm(),
                              .struck = {flight},
                              .any_is_late = any_is_late};
  finder_.find(stage, slots_, loads(), solver_.view(), store_);
  copy(free_, solver_);
  constexpr int width = visit_width<Space, Real>;
  ball_list_.make(store_.ball_tiles(), width);
  point_list_.make(store_.point_tiles(), width);
  counts_ = {ball_list_.size(), ball_list_.size()};
  if (parameters.rolling_friction) start_rolling(stage);
  if constexpr (width > 1) pad();
  if (point_list_.size() == 0) return;
  counts_.contacts += point_list_.size();
  counts_.points += parallel::sum_by_tiles<std::int64_t, Space>(
      "contacts.count", point_list_.size(), on_contacts(point_list_, CountPoints<Real>{store_.points()}));
}

/// What visits to several contacts at once find where there are fewer.
template <class Space, class Real>
void ContactSolver<Space, Real>::pad() {
  const std::int32_t nobody = slots_.solver_bodies().nobody();
  parallel::for_each<Space>(
      "contacts.pad", store_.ball_tiles().size(),
      PadBalls<Real>{store_.balls(), rolling_of_balls(), rolls(), store_.ball_tiles().data(), nobody});
  parallel::for_each<Space>(
      "contacts.pad", store_.point_tiles().size(),
      PadPoints<Real>{store_.points(), rolling_of_points(), rolls(), store_.point_tiles().data(), nobody});
}

template <class Space, class Real>
void ContactSolver<Space, Real>::start_rolling(const FindStage<Real>& stage) {
  using R = RollingFields<Real>;
  ball_rolling_.resize(decltype(R::fields)::size(store_.ball_places()));
  point_rolling_.resize(decltype(R::fields)::size(store_.point_places()));
  const ConstView<V3<Real>> couples = slots_.couples();
  parallel::for_each<Space>(
      "rolling.start", ball_list_.size(),
      on_contacts(ball_list_, StartRolling<Real, BallContacts<Real>>{
                                  stage, 0, store_.balls(), rolling_of_balls(), couples, solver_.view()}));
  parallel::for_each<Space>("rolling.start", point_list_.size(),
                            on_contacts(point_list_, StartRolling<Real, PointContacts<Real>>{
                                                         stage, store_.ball_places(), store_.points(),
                                                         rolling_of_points(), couples, solver_.view()}));
}

template <class Space, class Real>
template <class Record>
JoinHubs<Record> ContactSolver<Space, Real>::join_hubs(Array<Record, Space>& bodies) {
  const ConstView<std::int32_t> hub_of = slots_.solver_bodies().hub_of_parts();
  parts_sums_.resize(hub_of.size());
  Record* const records = bodies.empty() ? nullptr : bodies.data();
  return {slots_.solver_bodies().hubs(),       hub_of,  slots_.solver_bodies().share_of_parts(),
          slots_.solver_bodies().first_part(), records, parts_sums_.data()};
}

template <class Space, class Real>
template <bool only_balls>
SweepState ContactSolver<Space, Real>::run_impulse_rounds(const SweepPlan& plan) {
  return parallel::run_rounds<Space>(
      "sweeps",
      ImpulseRounds<Real, only_balls>{.ball_colors = ColorPhases(ball_list_),
                                      .point_colors = ColorPhases(point_list_),
                                      .balls = store_.balls(),
                                      .points = store_.points(),
                                      .rolls = rolls(),
                                      .ball_rolling = rolling_of_balls(),
                                      .point_rolling = rolling_of_points(),
                                      .bodies = solver_.data(),
                                      .last = last_.data(),
                                      .body_count = slots_.solver_bodies().first_wall_point(),
                                      .hubs = join_hubs(solver_),
                                      .least = plan.least,
                                      .most = plan.most,
                                      .block_sweeps = plan.block_sweeps,
                                      .tolerance = plan.tolerance,
                                      .momentum = momentum_},
      SweepState{});
}

template <class Space, class Real>
void ContactSolver<Space, Real>::find_impulses(const ResponseParameters& parameters, double share,
                                               Counters& counters) {
  SweepPlan plan = plan_sweeps(parameters, counts_.contacts, counts_.points);
  if (std::is_same_v<Real, float>) plan.tolerance = std::max(plan.tolerance, tolerance::mixed_change);
  momentum_ = true;
  if (is_heap(counts_.points)) {
    plan.least = patience_.sweeps(plan.least, shares_loads(counts_.contacts, counts_.points), share);
    // Who asks for a tolerance may get many sweeps.
    momentum_ = !patience_.is_calm() || parameters.tolerance > 0;
    if (parameters.iterations > 0) plan.least = std::min(plan.least, plan.most);
    plan.most = std::max(plan.most, plan.least);
  }
  // Newton's method knows no couples.
  const bool few = plan.direct && !rolls() && slots_.places().size() <= few_places &&
                   slots_.solver_bodies().first_wall_point() <= few_bodies;
  const bool converged = few ? solve_few(plan, counters) : sweep(plan, counters);
  counters.unconverged += !converged;
}

/// The bodies of the solver are without contacts.
template <class Space, class Real>
bool ContactSolver<Space, Real>::sweep(const SweepPlan& plan, Counters& counters) {
  const SweepState done =
      store_.point_places() == 0 ? run_impulse_rounds<true>(plan) : run_impulse_rounds<false>(plan);
  counters.sweeps += done.sweeps;
  return done.converged;
}

template <class Space, class Real>
LoadSpread ContactSolver<Space, Real>::spread_of_loads() {
  return parallel::sum_by_tiles<LoadSpread, Space>("sweeps.loads", ball_list_.size(),
                                                   on_contacts(ball_list_, BallLoad<Real>{store_.balls()})) +
         parallel::sum_by_tiles<LoadSpread, Space>(
             "sweeps.loads", point_list_.size(), on_contacts(point_list_, PointLoad<Real>{store_.points()}));
}

/// Sweeps; islands on which they creep go to Host's direct solver, as in Host's own steps.
template <class Space, class Real>
bool ContactSolver<Space, Real>::solve_few(const SweepPlan& plan, Counters& counters) {
  SweepPlan first = plan, rest = plan;
  first.most = sweeps_before_direct(plan.most, counters);
  rest.most = std::max(plan.most - first.most, few_sweeps);
  const auto solve_islands = [&](const DirectLimits& limits, std::int64_t& solved, std::int64_t& failed) {
    Inspection<Real> seen = inspect();
    FewContacts<Real> contacts(seen);
    const bool all = contacts.solve(plan.tolerance, limits, solved, failed);
    const std::vector<BodyRecord<Real>> bodies = contacts.put_back();
    store_.copy_from(seen.contacts);
    copy(solver_, bodies);
    return all;
  };
  if (sweep(first, counters) && !spread_of_loads().is_wide(plan.tolerance)) return true;
  if (solve_islands(quick_limits, counters.direct, counters.direct_failed)) return true;
  copy(solver_, free_);
  if (sweep(rest, counters)) return true;
  return pays_patience(counters) && solve_islands(patient_limits, counters.patient, counters.patient_failed);
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::book(const ConstBodyView& bodies, const ResponseParameters& parameters) {
  const BookStage<Real> stage{slots_.places(), bodies, free_.view(),      solver_.view(),
                              parameters,      step_,  next_loads_.view()};
  // Both kinds are waited for once, and one that is not there costs nothing.
  books_totals_.resize(4);
  std::size_t kinds = 0;
  const auto add_up = [&](const char* label, const ContactList<Space>& list, const auto& book) {
    if (list.size() == 0) return;
    parallel::sum_into<Books, Space>(label, list.size(), on_contacts(list, book), books_scratch_,
                                     books_totals_.data() + kinds++);
  };
  add_up("books.balls", ball_list_, BookBalls<Real>{stage, store_.balls(), slots_.ball_memory()});
  add_up("books.points", point_list_,
         BookPoints<Real>{stage, store_.ball_places(), store_.points(), slots_.point_memory()});
  if (rolls()) {
    add_up("books.rolling", ball_list_,
           BookRolling<Real, BallContacts<Real>>{stage, 0, store_.balls(), rolling_of_balls(),
                                                 slots_.couples()});
    add_up("books.rolling", point_list_,
           BookRolling<Real, PointContacts<Real>>{stage, store_.ball_places(), store_.points(),
                                                  rolling_of_points(), slots_.couples()});
  }
  Books of_kind[4];
  copy_bytes<Host, Space>(of_kind, books_totals_.data(), kinds * sizeof(Books));
  books_ = of_kind[0] + of_kind[1] + of_kind[2] + of_kind[3];
  Ledger ledger;
  ledger.restitution = books_.restitution;
  ledger.friction = books_.friction;
  ledger.work = books_.work;
  patience_.judge(books_.gap_power, books_.kick_power);
  return ledger;
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::solve(const FlightStage& flight, bool any_is_late, double share,
                                         Counters& counters) {
  const ResponseParameters& parameters = flight.parameters;
  const ConstBodyView bodies = read_only(flight.bodies);
  Ledger ledger;
  books_ = {};
  parallel::fill("books.loads", next_loads_, 0u);
  if (counts_.contacts > 0) {
    find_impulses(parameters, share, counters);
    ledger = book(bodies, parameters);
  }
  if (parameters.torque.size() > 0) {
    ledger.work += parallel::sum_by_tiles<double, Space>(
        "books.torque", bodies.count(), WorkOfTorque<Real>{bodies, solver_.view(), parameters.torque, step_});
  }
  parallel::for_each<Space>(
      "contacts.velocities", bodies.count(),
      StoreVelocities<Real>{free_.view(), solver_.view(), parameters, step_, flight.bodies});
  if (any_is_late && counts_.contacts > 0) ledger = ledger + shift_late_bodies(flight);
  return ledger;
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::shift_late_bodies(const FlightStage& flight) {
  const LateMoments<Real> moments{flight, free_.view(), solver_.view()};
  Array<Ledger, Space> totals(3);
  parallel::sum_into<Ledger, Space>(
      "late.moments", ball_list_.size(),
      on_contacts(ball_list_, LateBallMoments<Real>{moments, store_.balls(), slots_.places()}),
      ledger_scratch_, totals.data());
  parallel::sum_into<Ledger, Space>(
      "late.moments", point_list_.size(),
      on_contacts(point_list_, LatePointMoments<Real>{moments, store_.points(), places_of_points()}),
      ledger_scratch_, totals.data() + 1);
  parallel::sum_into<Ledger, Space>("late.shift", flight.bodies.count(),
                                    ShiftLate<Real>{flight, free_.view(), solver_.view()}, ledger_scratch_,
                                    totals.data() + 2);
  Ledger parts[3];
  copy_bytes<Host, Space>(parts, totals.data(), sizeof(parts));
  return parts[0] + parts[1] + parts[2];
}

template <class Space, class Real>
void ContactSolver<Space, Real>::take_velocities(const ConstBodyView& bodies) {
  parallel::for_each<Space>(
      "late.reload", solver_.size(),
      ReloadBody<Real>{bodies, slots_.solver_bodies().hubs(), slots_.solver_bodies().hub_of_parts(),
                       slots_.solver_bodies().first_part(), solver_.view(), last_.view()});
  parallel::for_each<Space>(
      "late.fly", ball_list_.size(),
      on_contacts(ball_list_, FlyBalls<Real>{store_.balls(), solver_.view(), last_.view(), step_}));
  parallel::for_each<Space>(
      "late.fly", point_list_.size(),
      on_contacts(point_list_, FlyPoints<Real>{store_.points(), solver_.view(), last_.view(), step_}));
  solver_.swap(last_);
}

template <class Space, class Real>
void ContactSolver<Space, Real>::fly_late(const FlightStage& flight) {
  const ConstBodyView bodies = read_only(flight.bodies);
  parallel::for_each<Space>("late.fly", ball_list_.size(),
                            on_contacts(ball_list_, FlyLateBalls<Real>{store_.balls(), slots_.places(),
                                                                       solver_.view(), bodies, flight}));
  parallel::for_each<Space>(
      "late.fly", point_list_.size(),
      on_contacts(point_list_, FlyLatePoints<Real>{store_.points(), places_of_points(), bodies, flight}));
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::correct(const FlightStage& flight, bool any_is_late) {
  loads_.swap(next_loads_);
  overlap_ = tolerance::correction_cap * books_.deepest;
  if (counts_.contacts == 0) return {};
  if (any_is_late) fly_late(flight);
  if (overlap_ == 0 && !any_is_late) return {};
  parallel::for_each<Space>("correction.start", displacement_.size(),
                            ResetDisplacement<Real>{solver_.view(), displacement_.view(), turn_.view()});
  const PartingPlan plan = plan_parting();
  if (store_.point_places() == 0) {
    run_parting_rounds<true>(plan);
  } else {
    run_parting_rounds<false>(plan);
  }
  const BodyView& bodies = flight.bodies;
  Array<Ledger, Space> total(1);
  parallel::sum_into<Ledger, Space>(
      "correction.apply", bodies.count(),
      Displace<Real>{displacement_.view(), turn_.view(), flight.parameters, bodies}, ledger_scratch_,
      total.data());
  Ledger ledger;
  copy_bytes<Host, Space>(&ledger, total.data(), sizeof(ledger));
  return ledger;
}

/// Of a heap the deepest contact is one of many, which do not wait for it.
template <class Space, class Real>
PartingPlan ContactSolver<Space, Real>::plan_parting() const {
  using namespace tolerance;
  if (!is_heap(counts_.points)) return {1, 100, corrected_overlap, corrected_overlap};
  if (shares_loads(counts_.contacts, counts_.points)) return {1, 24, heap_overlap, shared_mean_overlap};
  return {patience_.is_calm() ? 1 : 2, 6, heap_overlap, heap_mean_overlap};
}

template <class Space, class Real>
template <bool only_balls>
void ContactSolver<Space, Real>::run_parting_rounds(const PartingPlan& plan) {
  parallel::run_rounds<Space>(
      "correction",
      PartingRounds<Real, only_balls>{.ball_colors = ColorPhases(ball_list_),
                                      .point_colors = ColorPhases(point_list_),
                                      .balls = store_.balls(),
                                      .points = store_.points(),
                                      .displacement = displacement_.data(),
                                      .turn = turn_.data(),
                                      .shifted_hubs = join_hubs(displacement_),
                                      .turned_hubs = join_hubs(turn_),
                                      .share = static_cast<Real>(tolerance::correction_share),
                                      .least = plan.least,
                                      .most = plan.most,
                                      .deepest = static_cast<float>(plan.deepest / tolerance::correction_cap),
                                      .mean = static_cast<float>(plan.mean / tolerance::correction_cap)},
      PartingState{});
}

#define SCREE_INSTANTIATE(Space)               \
  template class ContactSolver<Space, double>; \
  template class ContactSolver<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
