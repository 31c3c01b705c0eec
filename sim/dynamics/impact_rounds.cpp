#include "sim/dynamics/impact_rounds.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_rounds.hpp"
#include "core/space_tiles.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace scree {

namespace {

using detail::FlightBounds;
using detail::ImpactProgram;
using detail::ImpactProgress;
using detail::Resolved;
using detail::RoundsState;

/// Who has had an impact later than the flight begins has been where it was before that. Also looks at the
/// laws.
struct StartFlight {
  FlightStage stage;
  View<std::uint32_t> joined_in;
  SCREE_HD FlightBounds operator()(std::int64_t k) const {
    FlightBounds bounds;
    const ConstView<PairLaw> laws = stage.terms.laws.table;
    if (k < laws.size()) bounds.restitution = laws[k].restitution;
    if (k >= stage.clock.size()) return bounds;
    const double from = stage.terms.from;
    stage.clock[k] = from > 0 ? fmax(stage.clock[k], from) : 0.0;
    stage.weary[k] = 0;
    joined_in[k] = detail::not_yet;
    stage.bound(static_cast<std::int32_t>(k));
    bounds.top_speed = stage.top_speed[k];
    bounds.smallest = stage.size_of(k);
    return bounds;
  }
};

struct StartProgress {
  FlightStage stage;
  ConstView<FlightBounds> bounds;
  ImpactProgress* progress;
  SCREE_HD void operator()(std::int64_t) const {
    const double harmless = stage.harmless_speed(bounds[0].smallest, bounds[0].restitution);
    const bool nobody = 2 * bounds[0].top_speed <= harmless;
    *progress = {};
    progress->harmless = nobody ? HUGE_VAL : harmless;
  }
};

/// Not where nobody is fast enough for an impact.
struct MarkCrowd {
  FlightStage stage;
  ConstView<Pair> pairs;
  ConstView<LoadedParts> loaded;
  const ImpactProgress* progress;
  SCREE_HD void operator()(std::int64_t k) const {
    if (progress->harmless == HUGE_VAL || loaded[k].bits == 0) return;
    const auto [i, j] = pairs[k];
    if (!stage.is_free(i) || !stage.is_free(j)) return;
    for (const std::int32_t body : {i, j}) raise(&stage.in_crowd[body], 1u);
  }
};

struct LoadOrdered {
  ConstView<std::int64_t> order;
  ConstView<Resolved> resolved;
  SCREE_HD Ledger operator()(std::int64_t k) const { return resolved[order[k]].moved; }
};

struct PutInOrder {
  ConstView<std::int64_t> order;
  ConstView<Resolved> resolved;
  ConstView<BodyNumber> number;
  View<Impact> impacts;
  SCREE_HD void operator()(std::int64_t k) const {
    impacts[k] = resolved[order[k]].impact;
    impacts[k].i = static_cast<std::int32_t>(number[impacts[k].i]);
    impacts[k].j = static_cast<std::int32_t>(number[impacts[k].j]);
  }
};

struct CountOff {
  View<std::int64_t> order;
  SCREE_HD void operator()(std::int64_t k) const { order[k] = k; }
};

struct Restore {
  ConstView<StruckBody> struck;
  BodyView bodies;
  View<double> clock;
  SCREE_HD void operator()(std::int64_t k) const { restore(struck[k], bodies, clock); }
};

constexpr std::int64_t least_room = 4096;

/// Makes room for so many, and keeps the `used` first.
template <class T, class Space>
void grow(Array<T, Space>& list, std::int64_t used, std::int64_t needed) {
  if (needed > list.capacity()) {
    Array<T, Space> larger(std::max(needed, 2 * list.capacity()));
    copy_bytes<Space, Space>(larger.data(), list.data(), static_cast<std::size_t>(used) * sizeof(T));
    list.swap(larger);
  }
  list.resize(list.capacity());
}

std::int64_t signed_count(std::uint64_t count) { return static_cast<std::int64_t>(count); }

}  // namespace

template <class Space>
bool ImpactRounds<Space>::any_may_meet(const FlightTerms& terms, const ResponseParameters& parameters,
                                       BodyView bodies) {
  log_.resize(bodies.count());
  start({terms, parameters, bodies, log_});
  copy_bytes<Host, Space>(&progress_, shared_progress_.data(), sizeof(progress_));
  return progress_.harmless != HUGE_VAL;
}

template <class Space>
Ledger ImpactRounds<Space>::resolve(const Problem& problem, const ResponseParameters& parameters,
                                    BodyView bodies) {
  log_.resize(bodies.count());
  const bool has_crowds =
      problem.terms.bounces && parameters.restitution && !problem.one_by_one && problem.loaded.size() > 0;
  log_.in_crowd.resize(has_crowds ? bodies.count() : 0);
  const FlightStage stage(problem.terms, parameters, bodies, log_);
  start(stage);
  if (has_crowds) {
    parallel::fill("impact.crowd", log_.in_crowd, 0u);
    parallel::for_each<Space>("impact.crowd", problem.pairs.size(),
                              MarkCrowd{stage, problem.pairs, problem.loaded, shared_progress_.data()});
  }
  RoundsState state;
  for (;;) {
    state = parallel::run_rounds<Space>("impact.rounds", program(stage, problem), state);
    if (state.halt == RoundsState::Halt::end) break;
    make_room(state);
  }
  rounds_ = state.round - 1;
  progress_ = {};
  if (state.round > 1 || state.counts.meetings > 0)
    copy_bytes<Host, Space>(&progress_, shared_progress_.data(), sizeof(progress_));
  if (state.counts.meetings > 0) progress_.hit_bound = 1;
  struck_.resize(signed_count(progress_.struck));
  return put_in_order(problem.pairs.size(), bodies.id);
}

template <class Space>
void ImpactRounds<Space>::start(const FlightStage& stage) {
  joined_in_.resize(stage.bodies.count());
  shared_progress_.resize(1);
  bounds_.resize(1);
  parallel::sum_into<FlightBounds, Space>(
      "impact.start", std::max(stage.bodies.count(), stage.terms.laws.table.size()),
      StartFlight{stage, joined_in_.view()}, bounds_scratch_, bounds_.data());
  parallel::for_each<Space>("impact.start", 1,
                            StartProgress{stage, std::as_const(bounds_).view(), shared_progress_.data()});
}

template <class Space>
ImpactProgram ImpactRounds<Space>::program(const FlightStage& stage, const Problem& problem) {
  const std::int64_t n = stage.bodies.count();
  first_.resize(n);
  for (auto* of_bodies : {&struck_in_, &waits_in_, &volley_of_, &walls_of_}) of_bodies->resize(n);
  for (auto* list : {&suspects_, &busy_}) grow(*list, list->size(), least_room);
  for (auto& list : meetings_) grow(list, list.size(), least_room);
  grow(volleys_, 0, meetings_[0].size());
  grow(resolved_, resolved_.size(), least_room);
  grow(key_, key_.size(), least_room);
  grow(struck_, struck_.size(), least_room);
  return {.stage = stage,
          .pairs = problem.pairs,
          .loaded = problem.loaded,
          .one_by_one = problem.one_by_one,
          .progress = shared_progress_.data(),
          .first = first_.view(),
          .joined_in = joined_in_.view(),
          .struck_in = struck_in_.view(),
          .waits_in = waits_in_.view(),
          .volley_of = volley_of_.view(),
          .walls_of = walls_of_.view(),
          .suspects = suspects_.view(),
          .busy = busy_.view(),
          .meetings = {meetings_[0].view(), meetings_[1].view()},
          .volleys = volleys_.view(),
          .resolved = resolved_.view(),
          .key = key_.view(),
          .struck = struck_.view()};
}

template <class Space>
void ImpactRounds<Space>::make_room(RoundsState& state) {
  ImpactProgress* progress = shared_progress_.data();
  copy_bytes<Host, Space>(&progress_, progress, sizeof(progress_));
  const std::int64_t meetings = signed_count(state.counts.meetings);
  if (state.halt == RoundsState::Halt::lists) {
    // The first half is done again.
    grow(suspects_, 0, signed_count(state.counts.suspects));
    grow(busy_, signed_count(state.busy), signed_count(progress_.busy));
    for (auto& list : meetings_) grow(list, list.size(), std::max(meetings, meetings_[0].size()));
    progress_.busy = state.busy;
    progress_.counts[state.round % 2] = {};
    copy_bytes<Space, Host>(progress, &progress_, sizeof(progress_));
  } else {
    const std::int64_t impacts = signed_count(progress_.impacts);
    const std::int64_t struck = signed_count(progress_.struck);
    grow(resolved_, impacts, impacts + meetings);
    grow(key_, impacts, impacts + meetings);
    grow(struck_, struck, struck + 2 * meetings);
  }
  state.halt = RoundsState::Halt::none;
}

/// Returns the sum of what the impacts moved.
template <class Space>
Ledger ImpactRounds<Space>::put_in_order(std::int64_t pairs, ConstView<BodyNumber> number) {
  const std::int64_t n = signed_count(progress_.impacts);
  impacts_.resize(n);
  if (n == 0) return {};
  key_.resize(n);
  order_.resize(n);
  parallel::for_each<Space>("impact.order", n, CountOff{order_.view()});
  parallel::sort_by_key("impact.order", key_, order_,
                        std::bit_width(static_cast<std::uint64_t>((rounds_ + 1) * pairs)));
  const ConstView<std::int64_t> order = order_.view();
  parallel::for_each<Space>("impact.order", n, PutInOrder{order, resolved_.view(), number, impacts_.view()});
  return parallel::sum<Ledger, Space>("impact.moved", n, LoadOrdered{order, resolved_.view()});
}

template <class Space>
void ImpactRounds<Space>::undo(BodyView bodies) {
  parallel::for_each<Space>("impact.undo", struck_.size(),
                            Restore{struck_.view(), bodies, log_.clock.view()});
  struck_.resize(0);
  impacts_.resize(0);
  progress_ = {};
}

#define SCREE_INSTANTIATE(Space) template class ImpactRounds<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
