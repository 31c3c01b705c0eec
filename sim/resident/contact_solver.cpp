#include "sim/resident/contact_solver.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace scree::resident {

namespace {

constexpr int tile = parallel::tile;

template <class T>
struct LoadSum {
  const T* sums;
  SCREE_HD T operator()(std::int64_t k) const { return sums[k]; }
};

/// Contacts and points of a place.
struct CountBalls {
  const std::int32_t* found;
  SCREE_HD ContactCounts operator()(std::int64_t t) const { return {found[t], found[t]}; }
};
template <class Real>
struct CountPoints {
  PointContacts<Real> contacts;
  SCREE_HD ContactCounts operator()(std::int64_t c) const {
    return has_contact(contacts.found, c) ? ContactCounts{1, contacts.points[c]} : ContactCounts{};
  }
};

/// work(first tile, tiles) for each colour in turn; the tiles are counted from `first` on.
template <class Work>
void for_each_color(const ColorTiles& colors, std::int64_t first, Work work) {
  for (std::size_t c = 0; c + 1 < colors.begin.size(); ++c)
    work(colors.begin[c] - first, colors.begin[c + 1] - colors.begin[c]);
}

/// What is known of pairs in another list.
struct LookUpLoads {
  ConstView<Pair> pairs, known;
  ConstView<LoadedParts> loads;
  View<LoadedParts> out;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t at = find_pair(known, pairs[k].i, pairs[k].j);
    out[k] = at < 0 ? LoadedParts{} : loads[at];
  }
};

struct ImpulseSum {
  Vec3 impulse = Vec3::Zero();
  SCREE_HD friend ImpulseSum operator+(const ImpulseSum& a, const ImpulseSum& b) {
    return {a.impulse + b.impulse};
  }
};

/// What a contact gave to a body, if it is one of its two.
template <class Real>
struct BallImpulseOn {
  std::int32_t body;
  BallContacts<Real> contacts;
  ConstView<Slot> places;
  SCREE_HD ImpulseSum operator()(std::int64_t c) const {
    if (!has_contact(contacts.found, c)) return {};
    const Slot& slot = places[c - c % tile + contacts.slot[c]];
    if (slot.i != body && slot.j != body) return {};
    const Vec3 impulse = vec3(contacts.fields.vector(BallContacts<Real>::impulse, c));
    return {slot.j == body ? impulse : Vec3(-impulse)};
  }
};
template <class Real>
struct PointImpulseOn {
  std::int32_t body;
  PointContacts<Real> contacts;
  ConstView<Slot> places;
  SCREE_HD ImpulseSum operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    if (!has_contact(contacts.found, c)) return {};
    const Slot& slot = places[c - c % tile + contacts.slot[c]];
    if (slot.i != body && slot.j != body) return {};
    Vec3 impulse = Vec3::Zero();
    for (int k = 0; k < contacts.points[c]; ++k)
      impulse += vec3(contacts.point_fields.vector(C::at_point(k, C::impulse), c));
    return {slot.j == body ? impulse : Vec3(-impulse)};
  }
};

/// What a slot remembers is what was loaded, when candidates are made anew.
template <class Real>
struct MarkBallLoads {
  BookStage<Real> stage;
  ConstView<BallMemory<Real>> memory;
  SCREE_HD void operator()(std::int64_t place) const {
    const Slot& slot = stage.places[place];
    if (slot.i != Slot::empty && memory[place].is_loaded()) stage.mark_loaded(slot, stage.part_of(slot));
  }
};
template <class Real>
struct MarkPointLoads {
  BookStage<Real> stage;
  std::int64_t first_place;
  ConstView<PointMemory<Real>> memory;
  SCREE_HD void operator()(std::int64_t place) const {
    const Slot& slot = stage.places[first_place + place];
    if (slot.i != Slot::empty && memory[place].is_loaded()) stage.mark_loaded(slot, stage.part_of(slot));
  }
};

}  // namespace

template <class Space, class Real>
void ContactSolver<Space, Real>::take_candidates(ConstView<Pair> candidates, const ConstBodyView& bodies) {
  slots_.build(candidates, bodies);
  const std::int64_t places = slots_.places().size();
  const std::int64_t balls = slots_.balls().tiles() * tile;
  const std::int64_t others = places - balls;
  change_.resize(places / tile);
  deepest_.resize(places / tile);
  book_sums_.resize(places / tile);
  store_.resize(balls, others, tile);
  for (auto* loads : {&loads_, &next_loads_}) {
    loads->resize((candidates.size() + 3) / 4);
    parallel::fill("contacts.loads", *loads, 0u);
  }
  const BookStage<Real> stage{slots_.places(), bodies, {}, {}, {}, 0, loads_.view()};
  parallel::for_each<Space>("contacts.loads", balls, MarkBallLoads<Real>{stage, slots_.ball_memory()});
  parallel::for_each<Space>("contacts.loads", others,
                            MarkPointLoads<Real>{stage, balls, slots_.point_memory()});
}

template <class Space, class Real>
void ContactSolver<Space, Real>::look_up_loads(ConstView<Pair> candidates,
                                               Array<LoadedParts, Space>& loads) const {
  loads.resize(candidates.size());
  parallel::for_each<Space>("contacts.loads", candidates.size(),
                            LookUpLoads{candidates, slots_.candidates(), this->loads(), loads.view()});
}

template <class Space, class Real>
Inspection<Real> ContactSolver<Space, Real>::inspect() const {
  Inspection<Real> seen;
  seen.places.resize(static_cast<std::size_t>(slots_.places().size()));
  copy_bytes<Host, Space>(seen.places.data(), slots_.places().data(), seen.places.size() * sizeof(Slot));
  copy(seen.free, free_);
  seen.contacts.copy_from(store_);
  seen.step = step_;
  return seen;
}

template <class Space, class Real>
Vec3 ContactSolver<Space, Real>::impulse_on(std::int32_t body) {
  const std::int64_t first = store_.ball_places();
  const ConstView<Slot> places = slots_.places();
  if (step_ == 0 || places.size() == 0) return Vec3::Zero();
  const auto on_balls = parallel::sum_by_tiles<ImpulseSum, Space>(
      "contacts.impulse", first, BallImpulseOn<Real>{body, store_.balls(), places});
  const auto on_points = parallel::sum_by_tiles<ImpulseSum, Space>(
      "contacts.impulse", places.size() - first,
      PointImpulseOn<Real>{body, store_.points(), {places.data() + first, places.size() - first}});
  return (on_balls + on_points).impulse;
}

template <class Space, class Real>
void ContactSolver<Space, Real>::load_bodies(const ConstBodyView& bodies, ConstView<double> margin,
                                             const ResponseParameters& parameters) {
  const std::int64_t n = bodies.count();
  const std::int64_t all = slots_.solver_bodies();
  mid_.resize(n);
  for (auto* records : {&solver_, &free_, &last_}) records->resize(all);
  displacement_.resize(all);
  const bool only_balls = slots_.others().tiles() == 0;
  inertia_.resize(only_balls ? 0 : all);
  turn_.resize(only_balls ? 0 : all);
  parallel::for_each<Space>(
      "contacts.bodies", n,
      LoadBody<Real>{bodies, margin, parameters, step_, mid_.view(), solver_.view(), inertia_.view()});
  parallel::for_each<Space>(
      "contacts.bodies", all - n,
      LoadPart<Real>{slots_.hubs(), slots_.hub_of_parts(), n, solver_.view(), inertia_.view()});
  copy(free_, solver_);
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
                              .laws = flight.terms.laws.table,
                              .materials = flight.terms.laws.materials,
                              .parameters = parameters,
                              .step = step_,
                              .scale = scale,
                              .noise = tolerance::parting_speed * step_ * parameters.gravity.norm(),
                              .struck = {flight},
                              .any_is_late = any_is_late};
  const std::int64_t balls = slots_.balls().tiles();
  parallel::compact_tiles<Space>("contacts.find balls", balls,
                                 FindBalls<Real>{stage, store_.balls(), slots_.ball_memory()},
                                 store_.found());
  parallel::compact_tiles<Space>(
      "contacts.find", slots_.others().tiles(),
      FindPoints<Real>{stage, balls * tile, store_.points(), slots_.point_memory(), loads()},
      store_.found() + balls);
  count();
}

template <class Space, class Real>
void ContactSolver<Space, Real>::count() {
  Array<ContactCounts, Space> scratch, totals(2);
  parallel::sum_into<ContactCounts, Space>("contacts.count", slots_.balls().tiles(),
                                           CountBalls{store_.found()}, scratch, totals.data());
  parallel::sum_into<ContactCounts, Space>("contacts.count", store_.point_places(),
                                           CountPoints<Real>{store_.points()}, scratch, totals.data() + 1);
  ContactCounts both[2];
  copy_bytes<Host, Space>(both, totals.data(), sizeof(both));
  counts_ = both[0] + both[1];
}

template <class Space, class Real>
template <class Record>
void ContactSolver<Space, Real>::join_parts(Array<Record, Space>& bodies) {
  const ConstView<Hub> hubs = slots_.hubs();
  if (hubs.size() == 0 || bodies.empty()) return;
  parts_.resize(hubs.size());
  parallel::sum_tiles<PartsSum, Space>("contacts.hubs", hubs.size(), SumParts<Record>{hubs, bodies.data()},
                                       parts_.data());
  const ConstView<std::int32_t> hub_of = slots_.hub_of_parts();
  parallel::for_each<Space>("contacts.hubs", hub_of.size(),
                            JoinParts<Record>{hubs, hub_of, std::as_const(parts_).view(),
                                              bodies.size() - hub_of.size(), bodies.data()});
}

template <class Space, class Real>
void ContactSolver<Space, Real>::sweep(const SweepPlan& plan) {
  parallel::for_each<Space>("sweep.accelerate", solver_.size(),
                            Accelerate<Real>{solver_.data(), last_.data(), state_.data()});
  const std::int64_t first = slots_.balls().tiles();
  for_each_color(slots_.balls(), 0, [&](std::int64_t t, std::int64_t tiles) {
    parallel::sum_tiles<SweepChange, Space>(
        "sweep.balls", tiles, SweepBalls<Real>{store_.balls(), solver_.data(), state_.data(), t * tile},
        change_.data() + t);
  });
  for_each_color(slots_.others(), first, [&](std::int64_t t, std::int64_t tiles) {
    parallel::sum_tiles<SweepChange, Space>(
        "sweep.points", tiles,
        SweepPoints<Real>{store_.points(), inertia_.data(), solver_.data(), state_.data(), plan.block_sweeps,
                          t * tile},
        change_.data() + first + t);
  });
  join_parts(solver_);
  parallel::sum_into<SweepChange, Space>("sweep.change", change_.size(), LoadSum<SweepChange>{change_.data()},
                                         change_scratch_, total_.data());
  parallel::for_each<Space>("sweep.judge", 1,
                            JudgeSweep{state_.data(), total_.data(), plan.least, plan.tolerance});
}

template <class Space, class Real>
void ContactSolver<Space, Real>::find_impulses(const ResponseParameters& parameters, Counters& counters) {
  constexpr int sweeps_at_once = 4;
  SweepPlan plan = plan_sweeps(parameters, counts_.contacts, counts_.points);
  if (std::is_same_v<Real, float>) plan.tolerance = std::max(plan.tolerance, tolerance::mixed_change);
  const std::int64_t first = slots_.balls().tiles();
  state_.resize(1);
  total_.resize(1);
  parallel::fill("sweep.start", state_, SweepState{});
  for_each_color(slots_.balls(), 0, [&](std::int64_t t, std::int64_t tiles) {
    parallel::for_each<Space>("sweep.push balls", tiles * tile,
                              PushBalls<Real>{store_.balls(), solver_.data(), t * tile});
  });
  for_each_color(slots_.others(), first, [&](std::int64_t t, std::int64_t tiles) {
    parallel::for_each<Space>("sweep.push points", tiles * tile,
                              PushPoints<Real>{store_.points(), inertia_.data(), solver_.data(), t * tile});
  });
  join_parts(solver_);
  int launched = 0;
  SweepState done;
  while (launched < plan.most && done.converged == 0) {
    const int wanted = launched == 0 ? std::max(plan.least, sweeps_at_once) : sweeps_at_once;
    const int more = std::min(wanted, plan.most - launched);
    for (int k = 0; k < more; ++k) sweep(plan);
    launched += more;
    copy_bytes<Host, Space>(&done, state_.data(), sizeof(done));
  }
  counters.sweeps += done.sweeps;
  counters.unconverged += done.converged == 0;
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::book(const ConstBodyView& bodies, const ResponseParameters& parameters) {
  const std::int64_t first = slots_.balls().tiles();
  const BookStage<Real> stage{slots_.places(), bodies, free_.view(),      solver_.view(),
                              parameters,      step_,  next_loads_.view()};
  parallel::sum_tiles<Books, Space>(
      "books.balls", first, BookBalls<Real>{stage, store_.balls(), slots_.ball_memory()}, book_sums_.data());
  parallel::sum_tiles<Books, Space>(
      "books.points", slots_.others().tiles(),
      BookPoints<Real>{stage, first * tile, store_.points(), slots_.point_memory()},
      book_sums_.data() + first);
  Array<Books, Space> scratch;
  book_total_.resize(1);
  parallel::sum_into<Books, Space>("books.sum", book_sums_.size(), LoadSum<Books>{book_sums_.data()}, scratch,
                                   book_total_.data());
  copy_bytes<Host, Space>(&books_, book_total_.data(), sizeof(books_));
  Ledger ledger;
  ledger.restitution = books_.restitution;
  ledger.friction = books_.friction;
  ledger.work = books_.work;
  return ledger;
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::solve(const FlightStage& flight, bool any_is_late, Counters& counters) {
  const ResponseParameters& parameters = flight.parameters;
  const ConstBodyView bodies = read_only(flight.bodies);
  Ledger ledger;
  books_ = {};
  parallel::fill("books.loads", next_loads_, 0u);
  if (counts_.contacts > 0) {
    find_impulses(parameters, counters);
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
  const std::int64_t first = slots_.balls().tiles() * tile;
  const ConstView<Slot> places = slots_.places();
  const LateMoments<Real> moments{flight, free_.view(), solver_.view()};
  Array<Ledger, Space> scratch, totals(3);
  parallel::sum_into<Ledger, Space>(
      "late.moments", first, LateBallMoments<Real>{moments, store_.balls(), places}, scratch, totals.data());
  parallel::sum_into<Ledger, Space>(
      "late.moments", places.size() - first,
      LatePointMoments<Real>{moments, store_.points(), {places.data() + first, places.size() - first}},
      scratch, totals.data() + 1);
  parallel::sum_into<Ledger, Space>("late.shift", flight.bodies.count(),
                                    ShiftLate<Real>{flight, free_.view(), solver_.view()}, scratch,
                                    totals.data() + 2);
  Ledger parts[3];
  copy_bytes<Host, Space>(parts, totals.data(), sizeof(parts));
  return parts[0] + parts[1] + parts[2];
}

template <class Space, class Real>
void ContactSolver<Space, Real>::take_velocities(const ConstBodyView& bodies) {
  parallel::for_each<Space>(
      "late.reload", solver_.size(),
      ReloadBody<Real>{bodies, slots_.hubs(), slots_.hub_of_parts(), solver_.view(), last_.view()});
  if (counts_.contacts > 0) {
    parallel::for_each<Space>("late.fly", slots_.balls().tiles() * tile,
                              FlyBalls<Real>{store_.balls(), solver_.view(), last_.view(), step_});
    parallel::for_each<Space>("late.fly", store_.point_places(),
                              FlyPoints<Real>{store_.points(), solver_.view(), last_.view(), step_});
  }
  solver_.swap(last_);
}

template <class Space, class Real>
void ContactSolver<Space, Real>::fly_late(const FlightStage& flight) {
  const std::int64_t first = slots_.balls().tiles() * tile;
  const ConstView<Slot> places = slots_.places();
  const ConstBodyView bodies = read_only(flight.bodies);
  parallel::for_each<Space>("late.fly", first, FlyLateBalls<Real>{store_.balls(), places, bodies});
  parallel::for_each<Space>(
      "late.fly", places.size() - first,
      FlyLatePoints<Real>{store_.points(), {places.data() + first, places.size() - first}, bodies, flight});
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::correct(const FlightStage& flight, bool any_is_late) {
  loads_.swap(next_loads_);
  overlap_ = tolerance::correction_cap * books_.deepest;
  if (counts_.contacts == 0) return {};
  if (any_is_late) fly_late(flight);
  if (overlap_ == 0 && !any_is_late) return {};
  part_state_.resize(1);
  deepest_of_all_.resize(1);
  parallel::fill("correction.start", part_state_, PartState{});
  parallel::for_each<Space>("correction.start", displacement_.size(),
                            ResetDisplacement<Real>{solver_.view(), displacement_.view(), turn_.view()});
  const bool heap = is_heap(counts_.points);
  const int most = !heap ? 100 : shares_loads(counts_.contacts, counts_.points) ? 24 : 6;
  for (int k = 0; k < most; ++k) part_sweep();
  const BodyView& bodies = flight.bodies;
  ledger_total_.resize(1);
  parallel::sum_into<Ledger, Space>(
      "correction.apply", bodies.count(),
      Displace<Real>{displacement_.view(), turn_.view(), flight.parameters, bodies}, ledger_scratch_,
      ledger_total_.data());
  Ledger ledger;
  copy_bytes<Host, Space>(&ledger, ledger_total_.data(), sizeof(ledger));
  return ledger;
}

template <class Space, class Real>
void ContactSolver<Space, Real>::part_sweep() {
  const std::int64_t first = slots_.balls().tiles();
  const auto share = static_cast<Real>(tolerance::correction_share);
  const auto enough = static_cast<float>(tolerance::corrected_overlap / tolerance::correction_cap);
  for_each_color(slots_.balls(), 0, [&](std::int64_t t, std::int64_t tiles) {
    parallel::sum_tiles<Deepest, Space>(
        "correction.balls", tiles,
        PartBalls<Real>{store_.balls(), displacement_.data(), part_state_.data(), share, t * tile},
        deepest_.data() + t);
  });
  for_each_color(slots_.others(), first, [&](std::int64_t t, std::int64_t tiles) {
    parallel::sum_tiles<Deepest, Space>(
        "correction.points", tiles,
        PartPoints<Real>{store_.points(), inertia_.data(), displacement_.data(), turn_.data(),
                         part_state_.data(), share, t * tile},
        deepest_.data() + first + t);
  });
  join_parts(displacement_);
  join_parts(turn_);
  parallel::sum_into<Deepest, Space>("correction.deepest", deepest_.size(), LoadSum<Deepest>{deepest_.data()},
                                     deepest_scratch_, deepest_of_all_.data());
  parallel::for_each<Space>("correction.judge", 1,
                            JudgeParting{part_state_.data(), deepest_of_all_.data(), enough});
}

#define SCREE_INSTANTIATE(Space)               \
  template class ContactSolver<Space, double>; \
  template class ContactSolver<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
