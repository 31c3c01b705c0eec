#include "sim/response/contact_solver.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "sim/response/contact_solver_loops.hpp"
#include "sim/response/padding.hpp"

#include <memory>
#include <type_traits>
#include <utility>

namespace scree::solver {

template <class Space, class Real>
void ContactSolver<Space, Real>::take_candidates(ConstView<Pair> candidates, ConstView<std::int64_t> before,
                                                 const ConstBodyView& bodies,
                                                 const ResponseParameters& parameters) {
  slots_.build(candidates, before, bodies, parameters.rolling_friction);
  forget_contacts();
  list_guided(parameters.guides);
  wall_sums_.take(slots_.places(), bodies);
  for (auto* loads : {&loads_, &next_loads_}) {
    loads->resize((candidates.size() + 3) / 4);
    parallel::fill("contacts.loads", *loads, 0u);
  }
  const AccountStage<Real> stage{slots_.places(), bodies, {}, {}, {}, 0, loads_.view()};
  parallel::for_each<Space>("contacts.loads", slots_.ball_places(),
                            MarkBallLoads<Real>{stage, slots_.ball_memory()});
  parallel::for_each<Space>("contacts.loads", slots_.places_of_others().size(),
                            MarkPointLoads<Real>{stage, slots_.ball_places(), slots_.point_memory()});
}

/// Drops the contacts of the last substep, which belong to other slots than the new ones.
template <class Space, class Real>
void ContactSolver<Space, Real>::forget_contacts() {
  store_.take_balls({});
  store_.take_points({});
  finder_.forget_slots();
  counts_ = {};
}

template <class Space, class Real>
void ContactSolver<Space, Real>::archive(Archive& archive, const ConstBodyView& bodies,
                                         const ResponseParameters& parameters) {
  archive.part("slots", slots_, bodies);
  archive.part("finder", finder_);
  archive.part("sweep count", sweep_count_);
  archive("loads", loads_);
  if (!archive.is_loading()) return;
  step_ = 0;
  forget_contacts();
  list_guided(parameters.guides);
  wall_sums_.take(slots_.places(), bodies);
  next_loads_.resize(loads_.size());
}

template <class Space, class Real>
void ContactSolver<Space, Real>::loads_of(ConstView<std::int64_t> index,
                                          Array<LoadedParts, Space>& loads) const {
  loads.resize(index.size());
  parallel::for_each<Space>("contacts.loads", index.size(), LoadsOfPairs{index, this->loads(), loads.view()});
}

template <class Space, class Real>
Inspection<Real> ContactSolver<Space, Real>::inspect(const ConstBodyView& bodies) {
  Inspection<Real> seen;
  seen.rolls = rolls();
  seen.first_wall_point = slots_.solver_bodies().first_wall_point();
  seen.first_part = slots_.solver_bodies().first_part();
  seen.first_place = slots_.ball_places();
  seen.step = step_;
  if constexpr (std::is_same_v<Space, Host>) {
    seen.places = slots_.places();
    seen.number = bodies.id;
    seen.free = std::as_const(free_).view();
    seen.contacts = &store_;
    seen.ball_rolling = rolling_of_balls();
    seen.point_rolling = rolling_of_points();
  } else {
    seen.from_device = std::make_shared<ContactsFromDevice<Real>>();
    ContactsFromDevice<Real>& to = *seen.from_device;
    to.places.resize(static_cast<std::size_t>(slots_.places().size()));
    copy_bytes<Host, Space>(to.places.data(), slots_.places().data(), to.places.size() * sizeof(Slot));
    to.number.resize(static_cast<std::size_t>(bodies.id.size()));
    copy_bytes<Host, Space>(to.number.data(), bodies.id.data(), to.number.size() * sizeof(BodyNumber));
    copy(to.free, free_);
    to.store.copy_from(store_);
    copy(to.ball_rolling, ball_rolling_);
    copy(to.point_rolling, point_rolling_);
    using R = decltype(RollingFields<Real>::fields);
    seen.places = {to.places.data(), slots_.places().size()};
    seen.number = {to.number.data(), bodies.id.size()};
    seen.free = {to.free.data(), free_.size()};
    seen.contacts = &to.store;
    seen.ball_rolling = {R(to.ball_rolling.data())};
    seen.point_rolling = {R(to.point_rolling.data())};
  }
  return seen;
}

template <class Space, class Real>
void ContactSolver<Space, Real>::add_wall_impulses(const FlightStage& flight) {
  if (wall_sums_.is_empty() || counts_.contacts == 0) return;
  WallContacts<Real> among{.entry_of = wall_sums_.entry_of_place(),
                           .impulses = wall_sums_.clear_impulses(),
                           .first_place = 0,
                           .places = slots_.places(),
                           .mid = std::as_const(mid_).view(),
                           .flight = flight};
  for_balls("walls.impulses", PutBallOnWall<Real>{among, store_.balls()});
  among.first_place = slots_.ball_places();
  for_points("walls.impulses", PutPointsOnWall<Real>{among, store_.points()});
  wall_sums_.add_up();
}

template <class Space, class Real>
void ContactSolver<Space, Real>::load_bodies(const ConstBodyView& bodies, ConstView<double> margin,
                                             const ResponseParameters& parameters) {
  const std::int64_t n = bodies.count();
  const std::int64_t all = slots_.solver_bodies().count();
  mid_.resize(n);
  for (auto* records : {&solver_, &free_, &last_}) records->resize(all);
  displacement_.resize(all);
  last_displacement_.resize(all);
  const bool only_balls = slots_.other_tiles() == 0;
  for (auto* records : {&turn_, &last_turn_}) records->resize(only_balls ? 0 : all);
  parallel::for_each<Space>("contacts.bodies", n,
                            LoadBody<Real>{bodies, margin, parameters, step_, mid_.view(), solver_.view()});
  parallel::for_each<Space>(
      "contacts.bodies", slots_.solver_bodies().hub_of_parts().size(),
      LoadPart<Real>{slots_.solver_bodies().hubs(), slots_.solver_bodies().hub_of_parts(),
                     slots_.solver_bodies().share_of_parts(), slots_.solver_bodies().first_part(),
                     solver_.view()});
  const std::int64_t padding = slots_.solver_bodies().padding_body();
  parallel::for_each<Space>("contacts.bodies", slots_.solver_bodies().first_part() - padding,
                            ClearNotFree<Real>{padding, solver_.view()});
}

template <class Space, class Real>
void ContactSolver<Space, Real>::find(ConstView<double> margin, double scale, const FlightStage& flight,
                                      bool any_late_impact, LibccdContacts* libccd) {
  step_ = flight.terms.step;
  const ConstBodyView bodies = read_only(flight.bodies);
  const ResponseParameters& parameters = flight.parameters;
  load_bodies(bodies, margin, parameters);
  FindStage<Real> stage{.places = slots_.places(),
                        .mid = mid_.view(),
                        .bodies = bodies,
                        .solver = solver_.view(),
                        .laws = flight.terms.laws,
                        .parameters = parameters,
                        .step = step_,
                        .scale = scale,
                        .noise = tolerance::separating_speed * step_ * parameters.gravity.norm(),
                        .struck = {flight},
                        .any_late_impact = any_late_impact,
                        .libccd = libccd};
  const FoundPlaces found = finder_.search(stage, slots_, loads());
  if (slots_.split_hubs(bodies, found)) {
    finder_.forget_slots();
    load_bodies(bodies, margin, parameters);
    stage.solver = solver_.view();
    list_guided(parameters.guides);
  }
  finder_.make(stage, slots_, loads(), solver_.view(), store_);
  counts_.contacts = counts_.points = store_.ball_colors().contacts();
  if (parameters.rolling_friction) start_rolling(stage);
  copy(free_, solver_);
  if constexpr (visit_width<Space> != 1) pad();
  if (store_.point_colors().contacts() == 0) return;
  counts_.contacts += store_.point_colors().contacts();
  const CountPoints<Real> count{store_.points()};
  counts_.points += parallel::sum_by_tiles<std::int64_t, Space>("contacts.count", count.contacts.slot.size(),
                                                                on_contacts(count.contacts, count));
}

/// Fills the places without contacts in blocks, since a visit works on a whole block at once.
template <class Space, class Real>
void ContactSolver<Space, Real>::pad() {
  const std::int32_t padding_body = slots_.solver_bodies().padding_body();
  const PadBalls<Real> balls{store_.balls(), rolling_of_balls(), rolls(), padding_body};
  const PadPoints<Real> points{store_.points(), rolling_of_points(), rolls(), padding_body};
  parallel::for_each<Space>("contacts.pad", balls.contacts.slot.size() / simd::width, balls);
  parallel::for_each<Space>("contacts.pad", points.contacts.slot.size() / simd::width, points);
}

/// Lists the guides of all bodies of the solver: the parts of a hub in a guide have that guide, too.
template <class Space, class Real>
void ContactSolver<Space, Real>::list_guided(ConstView<Guide> guides) {
  guides_.resize(static_cast<std::size_t>(guides.size()));
  if (guides_.empty()) return guided_.resize(0);
  copy_bytes<Host, Space>(guides_.data(), guides.data(), guides_.size() * sizeof(Guide));
  std::vector<Hub> hubs(static_cast<std::size_t>(slots_.solver_bodies().hubs().size()));
  copy_bytes<Host, Space>(hubs.data(), slots_.solver_bodies().hubs().data(), hubs.size() * sizeof(Hub));
  std::vector<Guide> guided = guides_;
  for (const Guide& guide : guides_) {
    for (const Hub& hub : hubs) {
      if (hub.body != guide.body) continue;
      for (std::int32_t part = 0; part < hub.parts; ++part) guided.push_back({hub.first + part, guide.axis});
    }
  }
  copy(guided_, guided);
}

template <class Space, class Real>
void ContactSolver<Space, Real>::start_rolling(const FindStage<Real>& stage) {
  using R = RollingFields<Real>;
  ball_rolling_.resize(decltype(R::fields)::size(store_.ball_colors().places()));
  point_rolling_.resize(decltype(R::fields)::size(store_.point_colors().places()));
  const ConstView<V3<Real>> couples = slots_.couples();
  for_balls("rolling.start", StartRolling<Real, BallContacts<Real>>{
                                 stage, 0, store_.balls(), rolling_of_balls(), couples, solver_.view()});
  for_points("rolling.start",
             StartRolling<Real, PointContacts<Real>>{stage, slots_.ball_places(), store_.points(),
                                                     rolling_of_points(), couples, solver_.view()});
}

template <class Space, class Real>
void ContactSolver<Space, Real>::keep_memory() {
  slots_.keep_memory();
  kept_sweep_count_ = sweep_count_;
}

template <class Space, class Real>
void ContactSolver<Space, Real>::recall_memory() {
  slots_.recall_memory();
  finder_.forget_slots();
  sweep_count_ = kept_sweep_count_;
}

#define SCREE_INSTANTIATE(Space)               \
  template class ContactSolver<Space, double>; \
  template class ContactSolver<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::solver
