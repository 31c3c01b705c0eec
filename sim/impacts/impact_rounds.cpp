#include "sim/impacts/impact_rounds.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_phases.hpp"
#include "core/space_tiles.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>
#include <utility>

namespace scree {

namespace {

using detail::FlightBounds;
using detail::ImpactProgram;
using detail::ImpactProgress;
using detail::Resolved;
using detail::RoundsState;

/// Returns the bounds of law k and of the size of body k, as far as there are such.
SCREE_HD FlightBounds bounds_of_law_and_size(const FlightStage& stage, std::int64_t k) {
  FlightBounds bounds;
  const ConstView<PairLaw> laws = stage.terms.laws.table;
  if (k < laws.size()) bounds.restitution = laws[k].restitution;
  if (k < stage.clock.size()) bounds.smallest = stage.size_of(k);
  return bounds;
}

/// Starts the values of a body, and bounds those of bodies and laws. A body that was struck after the start
/// of the flight starts at that impact: its way until then is over.
struct StartFlight {
  FlightStage stage;
  SCREE_HD FlightBounds operator()(std::int64_t k) const {
    FlightBounds bounds = bounds_of_law_and_size(stage, k);
    if (k >= stage.clock.size()) return bounds;
    const double from = stage.terms.from;
    stage.clock[k] = from > 0 ? fmax(stage.clock[k], from) : 0.0;
    stage.budget_used[k] = 0;
    stage.bound(static_cast<std::int32_t>(k));
    bounds.top_speed = stage.top_speed[k];
    bounds.needs_search = stage.needs_search(static_cast<std::int32_t>(k));
    return bounds;
  }
};

/// Bounds bodies and laws as StartFlight does, without a write and without needs_search.
struct BoundSpeeds {
  FlightStage stage;
  SCREE_HD FlightBounds operator()(std::int64_t k) const {
    FlightBounds bounds = bounds_of_law_and_size(stage, k);
    if (k >= stage.clock.size()) return bounds;
    const auto body = static_cast<std::int32_t>(k);
    bounds.top_speed = stage.top_speed_of(body, stage.flight(body));
    return bounds;
  }
};

struct StartProgress {
  FlightStage stage;
  ConstView<FlightBounds> bounds;
  ImpactProgress* progress;
  SCREE_HD void operator()(std::int64_t) const {
    const double least_impact_speed =
        stage.find_least_impact_speed(bounds[0].smallest, bounds[0].restitution);
    const bool all_are_slow = 2 * bounds[0].top_speed <= least_impact_speed;
    *progress = {};
    progress->least_impact_speed = all_are_slow ? HUGE_VAL : least_impact_speed;
    progress->needs_search = bounds[0].needs_search;
  }
};

struct MarkLoaded {
  FlightStage stage;
  ConstView<Pair> pairs;
  ConstView<LoadedParts> loaded;
  SCREE_HD void operator()(std::int64_t k) const {
    if (loaded[k].bits == 0) return;
    const auto [i, j] = pairs[k];
    if (!stage.is_free(i) || !stage.is_free(j)) return;
    for (const std::int32_t body : {i, j}) raise(&stage.bore_load[body], 1u);
  }
};

/// Resets the values of a body before the first round.
struct ResetBodies {
  ImpactProgram program;
  SCREE_HD void operator()(std::int64_t body) const {
    program.first[0][body] = program.first[1][body] = detail::no_meeting;
    program.struck_in[body] = program.waits_in[body] = program.walls_of[body] = 0;
    program.impact_group_of[body] = detail::no_impact_group;
  }
};

/// Lists the pairs that are fast enough for an impact. It loads the speeds of four pairs together, since most
/// pairs are too slow.
struct ListFast {
  static constexpr int together = 4;
  SCREE_HD static std::int64_t items(std::int64_t pairs) { return (pairs + together - 1) / together; }

  ConstView<double> top_speed;
  ConstView<Pair> pairs;
  ImpactProgress* progress;
  View<std::int32_t> fast;
  SCREE_HD void operator()(std::int64_t item) const {
    const std::int64_t stride = items(pairs.size());
    const double least = progress->least_impact_speed;
    bool is_fast[together];
    for (int p = 0; p < together; ++p) {
      const std::int64_t k = item + p * stride;
      const Pair pair = pairs[k < pairs.size() ? k : item];
      is_fast[p] = k < pairs.size() && top_speed[pair.i] + top_speed[pair.j] > least;
    }
    for (int p = 0; p < together; ++p) {
      if (!is_fast[p]) continue;
      const auto place = static_cast<std::int64_t>(count_up_together(&progress->fast));
      fast[place] = static_cast<std::int32_t>(item + p * stride);
    }
  }
};

/// Lists the pairs that come near each other, of those in `fast` or of all. This loop is not part of the
/// rounds, nor of ListFast, since it takes many registers: so more pairs are looked at in parallel.
struct ListNear {
  static constexpr std::int64_t sample = 64;  // one in so many of all pairs is counted if it is fast

  FlightStage stage;
  ConstView<Pair> pairs;
  ConstView<LoadedParts> loaded;
  ConstView<std::int32_t> fast;  ///< ListFast::fast; empty: all pairs are looked at
  ImpactProgress* progress;
  View<std::int64_t> near;
  SCREE_HD void operator()(std::int64_t item) const {
    const std::int64_t k = fast.size() > 0 ? fast[item] : item;
    const auto [i, j] = pairs[k];
    if (stage.top_speed[i] + stage.top_speed[j] <= progress->least_impact_speed) return;
    if (fast.size() == 0 && item % sample == 0) count_up(&progress->fast);
    ImpactLimits limits;
    if (!stage.may_meet(i, j, limits) || !stage.come_near(i, j, limits, detail::loads_at(loaded, k))) return;
    const auto place = static_cast<std::int64_t>(count_up_together(&progress->near));
    if (place < near.size()) near[place] = k;
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
constexpr int lanes_on_device = 8;

/// Makes room for `needed` elements, and keeps the first `used` ones.
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
  const FlightStage stage(terms, parameters, bodies, log_);
  return any_may_meet(stage, BoundSpeeds{stage});
}

template <class Space>
Ledger ImpactRounds<Space>::resolve(const Problem& problem, const ResponseParameters& parameters,
                                    BodyView bodies) {
  log_.resize(bodies.count());
  const bool marks_loads =
      problem.terms.bounces && parameters.restitution && !problem.one_by_one && problem.loaded.size() > 0;
  log_.bore_load.resize(marks_loads ? bodies.count() : 0);
  const FlightStage stage(problem.terms, parameters, bodies, log_);
  impacts_.resize(0);
  struck_.resize(0);
  rounds_ = 0;
  if (!any_may_meet(stage, StartFlight{stage})) {
    log_.bore_load.resize(0);
    return {};
  }
  if (marks_loads) {
    parallel::fill("impact.loaded", log_.bore_load, 0u);
    parallel::for_each<Space>("impact.loaded", problem.pairs.size(),
                              MarkLoaded{stage, problem.pairs, problem.loaded});
  }
  if (problem.pairs_made == 0 || problem.pairs_made != adjacency_of_) adjacency_.clear();
  parallel::for_each<Space>("impact.reset", bodies.count(), ResetBodies{program(stage, problem)});
  list_fast(stage, problem);
  list_near(stage, problem);
  RoundsState state;
  for (;;) {
    state = parallel::run_in_phases<Space>("impact.rounds", program(stage, problem), state);
    if (state.halt == RoundsState::Halt::end) break;
    make_room(stage, problem, state);
  }
  rounds_ = state.round - 1;
  if (state.round > 1 || state.counts.meetings > 0)
    copy_bytes<Host, Space>(&progress_, shared_progress_.data(), sizeof(progress_));
  if (state.counts.meetings > 0) progress_.hit_bound = 1;
  const std::int64_t fast = signed_count(state.fast) * (fast_.size() > 0 ? 1 : ListNear::sample);
  most_were_fast_[problem.terms.from > 0] = 2 * fast > problem.pairs.size();
  struck_.resize(signed_count(progress_.struck));
  return put_in_order(problem.pairs.size(), bodies.id);
}

/// Returns whether any pair may be fast enough for an impact. `bounds_of`: StartFlight or BoundSpeeds.
template <class Space>
template <class BoundsOf>
bool ImpactRounds<Space>::any_may_meet(const FlightStage& stage, const BoundsOf& bounds_of) {
  shared_progress_.resize(1);
  bounds_.resize(1);
  parallel::sum_into<FlightBounds, Space>("impact.start",
                                          std::max(stage.bodies.count(), stage.terms.laws.table.size()),
                                          bounds_of, bounds_scratch_, bounds_.data());
  parallel::for_each<Space>("impact.start", 1,
                            StartProgress{stage, std::as_const(bounds_).view(), shared_progress_.data()});
  copy_bytes<Host, Space>(&progress_, shared_progress_.data(), sizeof(progress_));
  return progress_.least_impact_speed != HUGE_VAL;
}

template <class Space>
ImpactProgram ImpactRounds<Space>::program(const FlightStage& stage, const Problem& problem) {
  const std::int64_t n = stage.bodies.count();
  for (auto& of_bodies : first_) of_bodies.resize(n);
  for (auto* of_bodies : {&struck_in_, &waits_in_, &impact_group_of_, &walls_of_}) of_bodies->resize(n);
  grow(near_, near_.size(), least_room);
  grow(to_search_, 0, least_room);
  for (auto& list : meetings_) grow(list, list.size(), least_room);
  grow(impact_groups_, 0, meetings_[0].size());
  grow(resolved_, resolved_.size(), least_room);
  grow(key_, key_.size(), least_room);
  grow(struck_, struck_.size(), least_room);
  return {.stage = stage,
          .pairs = problem.pairs,
          .loaded = problem.loaded,
          .adjacency = adjacency_.view(),
          .one_by_one = problem.one_by_one,
          .lanes = std::is_same_v<Space, Host> ? 1 : lanes_on_device,
          .progress = shared_progress_.data(),
          .first = {first_[0].view(), first_[1].view()},
          .struck_in = struck_in_.view(),
          .waits_in = waits_in_.view(),
          .impact_group_of = impact_group_of_.view(),
          .walls_of = walls_of_.view(),
          .near = near_.view(),
          .to_search = to_search_.view(),
          .meetings = {meetings_[0].view(), meetings_[1].view()},
          .impact_groups = impact_groups_.view(),
          .resolved = resolved_.view(),
          .key = key_.view(),
          .struck = struck_.view(),
          .chunks = chunks_.view(),
          .struck_large_bodies = struck_large_bodies_.view()};
}

/// Lists the fast pairs on Device, where slow pairs would make threads wait in list_near(). That looks at all
/// pairs itself if most were fast in the last such flight, and on Host, since threads would wait for one
/// another to add to the list of fast ones.
template <class Space>
void ImpactRounds<Space>::list_fast(const FlightStage& stage, const Problem& problem) {
  fast_.resize(0);
  if constexpr (!std::is_same_v<Space, Host>) {
    if (most_were_fast_[problem.terms.from > 0]) return;
    fast_.resize(problem.pairs.size());
    parallel::for_each<Space>(
        "impact.fast", ListFast::items(problem.pairs.size()),
        ListFast{stage.top_speed, problem.pairs, shared_progress_.data(), fast_.view()});
  }
}

template <class Space>
void ImpactRounds<Space>::list_near(const FlightStage& stage, const Problem& problem) {
  ImpactProgress* const progress = shared_progress_.data();
  const ListNear list{stage,    problem.pairs, problem.loaded, std::as_const(fast_).view(),
                      progress, near_.view()};
  if (fast_.size() > 0) {
    parallel::for_each_counted<Space>("impact.near", &progress->fast, list);
  } else {
    parallel::for_each<Space>("impact.near", problem.pairs.size(), list);
  }
}

template <class Space>
void ImpactRounds<Space>::make_room(const FlightStage& stage, const Problem& problem, RoundsState& state) {
  ImpactProgress* progress = shared_progress_.data();
  copy_bytes<Host, Space>(&progress_, progress, sizeof(progress_));
  const std::int64_t meetings = signed_count(state.counts.meetings);
  if (state.halt == RoundsState::Halt::lists) {
    // The first half of the round is repeated.
    grow(to_search_, 0, signed_count(state.counts.to_search));
    for (auto& list : meetings_) grow(list, list.size(), std::max(meetings, meetings_[0].size()));
    progress_.counts[state.round % 2] = {};
    const std::int64_t near = signed_count(progress_.near);
    const bool all_listed = near <= near_.size();
    if (!all_listed) {
      progress_.near = 0;
      if (fast_.size() == 0) progress_.fast = 0;
    }
    copy_bytes<Space, Host>(progress, &progress_, sizeof(progress_));
    if (!all_listed) {
      grow(near_, 0, near);
      list_near(stage, problem);
    }
  } else {
    const std::int64_t impacts = signed_count(progress_.impacts);
    const std::int64_t struck = signed_count(progress_.struck);
    grow(resolved_, impacts, impacts + meetings);
    grow(key_, impacts, impacts + meetings);
    grow(struck_, struck, struck + 2 * meetings);
    if (adjacency_.view().is_empty()) {
      adjacency_.build(problem.pairs, ConstView<Mobility>(stage.bodies.mobility));
      adjacency_of_ = problem.pairs_made;
      const std::int64_t of_rows = adjacency_.view().row.size();
      chunks_.resize(of_rows / ImpactProgram::chunk_size + stage.bodies.count());
      struck_large_bodies_.resize(of_rows / ImpactProgram::most_in_chunks);
    }
  }
  state.halt = RoundsState::Halt::none;
}

/// Puts the impacts in order, and returns the sum of their ledgers.
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
  return parallel::sum_by_tiles<Ledger, Space>("impact.moved", n, LoadOrdered{order, resolved_.view()});
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
