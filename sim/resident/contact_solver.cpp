#include "sim/resident/contact_solver.hpp"

#include "core/parallel.hpp"
#include "core/space_tiles.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <utility>

namespace scree::resident {

namespace {

constexpr std::int64_t tile = parallel::tile;

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
  found_.resize(places / tile);
  change_.resize(places / tile);
  deepest_.resize(places / tile);
  book_sums_.resize(places / tile);
  ends_.resize(places);
  slot_.resize(places);
  flags_.resize(places);
  ball_fields_.resize(balls * BallContacts<Real>::count);
  points_.resize(others);
  contact_fields_.resize(others * PointContacts<Real>::count);
  point_fields_.resize(others * PointContacts<Real>::point_count * Manifold::max_points);
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
void ContactSolver<Space, Real>::forget() {
  slots_.clear();
}

template <class Space, class Real>
BallContacts<Real> ContactSolver<Space, Real>::balls() {
  const std::int64_t places = slots_.balls().tiles() * tile;
  return {.found = found_.data(),
          .ends = {ends_.data(), places},
          .slot = {slot_.data(), places},
          .flags = {flags_.data(), places},
          .fields = {ball_fields_.data(), places}};
}

template <class Space, class Real>
PointContacts<Real> ContactSolver<Space, Real>::points() {
  const std::int64_t first = slots_.balls().tiles() * tile;
  const std::int64_t places = ends_.size() - first;
  return {.found = found_.data() + first / tile,
          .ends = {ends_.data() + first, places},
          .slot = {slot_.data() + first, places},
          .flags = {flags_.data() + first, places},
          .points = points_.view(),
          .fields = {contact_fields_.data(), places},
          .point_fields = {point_fields_.data(), places}};
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
void ContactSolver<Space, Real>::find(const ConstBodyView& bodies, ConstView<double> margin, double step,
                                      double scale, const ResponseParameters& parameters) {
  step_ = step;
  load_bodies(bodies, margin, parameters);
  const FindStage<Real> stage{.places = slots_.places(),
                              .mid = mid_.view(),
                              .bodies = bodies,
                              .solver = solver_.view(),
                              .laws = laws_,
                              .materials = materials_,
                              .parameters = parameters,
                              .step = step,
                              .scale = scale,
                              .noise = tolerance::parting_speed * step * parameters.gravity.norm()};
  const std::int64_t balls = slots_.balls().tiles();
  parallel::compact_tiles<Space>("contacts.find balls", balls,
                                 FindBalls<Real>{stage, this->balls(), slots_.ball_memory()}, found_.data());
  parallel::compact_tiles<Space>("contacts.find", slots_.others().tiles(),
                                 FindPoints<Real>{stage, balls * tile, points(), slots_.point_memory()},
                                 found_.data() + balls);
  count();
}

template <class Space, class Real>
void ContactSolver<Space, Real>::count() {
  Array<ContactCounts, Space> scratch, totals(2);
  parallel::sum_into<ContactCounts, Space>("contacts.count", slots_.balls().tiles(),
                                           CountBalls{found_.data()}, scratch, totals.data());
  parallel::sum_into<ContactCounts, Space>("contacts.count", points_.size(), CountPoints<Real>{points()},
                                           scratch, totals.data() + 1);
  ContactCounts both[2];
  copy_bytes<Host, Space>(both, totals.data(), sizeof(both));
  counts_ = both[0] + both[1];
}

/// work(first place): a function object over the places from there on, launched for each colour in turn.
template <class Space, class Real>
template <class Work>
void ContactSolver<Space, Real>::for_each_color(const char* label, const ColorTiles& tiles,
                                                std::int64_t first, Work work) {
  for (std::size_t c = 0; c + 1 < tiles.begin.size(); ++c)
    work(label, tiles.begin[c] - first, tiles.begin[c + 1] - tiles.begin[c]);
}

template <class Space, class Real>
template <class Record>
void ContactSolver<Space, Real>::join_parts(Array<Record, Space>& bodies) {
  const ConstView<Hub> hubs = slots_.hubs();
  if (hubs.size() == 0) return;
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
  for_each_color("sweep.balls", slots_.balls(), 0,
                 [&](const char* label, std::int64_t t, std::int64_t tiles) {
                   parallel::sum_tiles<SweepChange, Space>(
                       label, tiles, SweepBalls<Real>{balls(), solver_.data(), state_.data(), t * tile},
                       change_.data() + t);
                 });
  for_each_color(
      "sweep.points", slots_.others(), first, [&](const char* label, std::int64_t t, std::int64_t tiles) {
        parallel::sum_tiles<SweepChange, Space>(label, tiles,
                                                SweepPoints<Real>{points(), inertia_.data(), solver_.data(),
                                                                  state_.data(), plan.block_sweeps, t * tile},
                                                change_.data() + first + t);
      });
  join_parts(solver_);
  parallel::sum_into<SweepChange, Space>("sweep.change", change_.size(), LoadSum<SweepChange>{change_.data()},
                                         change_scratch_, total_.data());
  parallel::for_each<Space>("sweep.judge", 1,
                            JudgeSweep{state_.data(), total_.data(), plan.least, plan.tolerance});
}

template <class Space, class Real>
SweepState ContactSolver<Space, Real>::sweeps_done() const {
  SweepState state;
  copy_bytes<Host, Space>(&state, state_.data(), sizeof(state));
  return state;
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::solve(const BodyView& bodies, const ResponseParameters& parameters,
                                         Counters& counters) {
  Ledger ledger;
  const std::int64_t n = bodies.count();
  const std::int64_t first = slots_.balls().tiles();
  books_ = {};
  if (counts_.contacts > 0) {
    constexpr int sweeps_at_once = 4;
    const SweepPlan plan = plan_sweeps(parameters, counts_.contacts, counts_.points);
    state_.resize(1);
    total_.resize(1);
    parallel::fill("sweep.start", state_, SweepState{});
    for_each_color(
        "sweep.push", slots_.balls(), 0, [&](const char* label, std::int64_t t, std::int64_t tiles) {
          parallel::for_each<Space>(label, tiles * tile, PushBalls<Real>{balls(), solver_.data(), t * tile});
        });
    for_each_color(
        "sweep.push", slots_.others(), first, [&](const char* label, std::int64_t t, std::int64_t tiles) {
          parallel::for_each<Space>(label, tiles * tile,
                                    PushPoints<Real>{points(), inertia_.data(), solver_.data(), t * tile});
        });
    join_parts(solver_);
    int launched = 0;
    SweepState done;
    while (launched < plan.most && done.converged == 0) {
      const int more = std::min(launched == 0 ? std::max(plan.least, sweeps_at_once) : sweeps_at_once,
                                plan.most - launched);
      for (int k = 0; k < more; ++k) sweep(plan);
      launched += more;
      done = sweeps_done();
    }
    counters.sweeps += done.sweeps;
    counters.unconverged += done.converged == 0;

    parallel::fill("books.loads", next_loads_, 0u);
    const BookStage<Real> stage{slots_.places(),
                                read_only(bodies),
                                free_.view(),
                                solver_.view(),
                                parameters,
                                step_,
                                parameters.restitution ? next_loads_.view() : View<std::uint32_t>()};
    parallel::sum_tiles<Books, Space>(
        "books.balls", first, BookBalls<Real>{stage, balls(), slots_.ball_memory()}, book_sums_.data());
    parallel::sum_tiles<Books, Space>("books.points", slots_.others().tiles(),
                                      BookPoints<Real>{stage, first * tile, points(), slots_.point_memory()},
                                      book_sums_.data() + first);
    Array<Books, Space> scratch;
    book_total_.resize(1);
    parallel::sum_into<Books, Space>("books.sum", book_sums_.size(), LoadSum<Books>{book_sums_.data()},
                                     scratch, book_total_.data());
    copy_bytes<Host, Space>(&books_, book_total_.data(), sizeof(books_));
    ledger.restitution = books_.restitution;
    ledger.friction = books_.friction;
    ledger.work = books_.work;
  }
  if (parameters.torque.size() > 0) {
    ledger.work += parallel::sum<double, Space>(
        "books.torque", n, WorkOfTorque<Real>{read_only(bodies), solver_.view(), parameters.torque, step_});
  }
  parallel::for_each<Space>("contacts.velocities", n,
                            StoreVelocities<Real>{free_.view(), solver_.view(), parameters, step_, bodies});
  return ledger;
}

template <class Space, class Real>
Ledger ContactSolver<Space, Real>::correct(const BodyView& bodies, const ResponseParameters& parameters) {
  loads_.swap(next_loads_);
  overlap_ = tolerance::correction_cap * books_.deepest;
  if (counts_.contacts == 0 || overlap_ == 0) return {};
  const std::int64_t first = slots_.balls().tiles();
  part_state_.resize(1);
  deepest_of_all_.resize(1);
  parallel::fill("correction.start", part_state_, PartState{});
  parallel::for_each<Space>("correction.start", displacement_.size(),
                            ResetDisplacement<Real>{solver_.view(), displacement_.view(), turn_.view()});
  const bool heap = is_heap(counts_.points);
  const int most = !heap ? 100 : shares_loads(counts_.contacts, counts_.points) ? 24 : 6;
  const auto share = static_cast<Real>(tolerance::correction_share);
  const auto enough = static_cast<float>(tolerance::corrected_overlap / tolerance::correction_cap);
  for (int k = 0; k < most; ++k) {
    for_each_color("correction.balls", slots_.balls(), 0,
                   [&](const char* label, std::int64_t t, std::int64_t tiles) {
                     parallel::sum_tiles<Deepest, Space>(
                         label, tiles,
                         PartBalls<Real>{balls(), displacement_.data(), part_state_.data(), share, t * tile},
                         deepest_.data() + t);
                   });
    for_each_color("correction.points", slots_.others(), first,
                   [&](const char* label, std::int64_t t, std::int64_t tiles) {
                     parallel::sum_tiles<Deepest, Space>(
                         label, tiles,
                         PartPoints<Real>{points(), inertia_.data(), displacement_.data(), turn_.data(),
                                          part_state_.data(), share, t * tile},
                         deepest_.data() + first + t);
                   });
    join_parts(displacement_);
    join_parts(turn_);
    parallel::sum_into<Deepest, Space>("correction.deepest", deepest_.size(),
                                       LoadSum<Deepest>{deepest_.data()}, deepest_scratch_,
                                       deepest_of_all_.data());
    parallel::for_each<Space>("correction.judge", 1,
                              JudgeParting{part_state_.data(), deepest_of_all_.data(), enough});
  }
  Array<Ledger, Space> scratch, total(1);
  parallel::sum_into<Ledger, Space>("correction.apply", bodies.count(),
                                    Displace<Real>{displacement_.view(), turn_.view(), parameters, bodies},
                                    scratch, total.data());
  Ledger ledger;
  copy_bytes<Host, Space>(&ledger, total.data(), sizeof(ledger));
  return ledger;
}

#define SCREE_INSTANTIATE(Space)               \
  template class ContactSolver<Space, double>; \
  template class ContactSolver<Space, float>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)

}  // namespace scree::resident
