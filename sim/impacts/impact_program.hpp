// The rounds of impacts of a flight, as a program of phases (core/space_phases.hpp). The first half of a
// round predicts which pairs meet, the second half resolves the meetings that are the first in their
// neighbourhood.
#pragma once

#include "core/array.hpp"
#include "core/space_atomic.hpp"
#include "core/space_prefetch.hpp"
#include "core/space_unroll.hpp"
#include "narrowphase/candidates.hpp"
#include "sim/impacts/adjacency.hpp"
#include "sim/impacts/impact.hpp"
#include "sim/impacts/impact_group.hpp"
#include "sim/impacts/meeting_lists.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace scree::detail {

SCREE_HD inline LoadedParts loads_at(ConstView<LoadedParts> loaded, std::int64_t pair) {
  return loaded.size() > 0 ? loaded[pair] : LoadedParts{};
}

/// The program of the rounds: one round after another, until no bodies meet.
struct ImpactProgram {
  using State = RoundsState;
  using Sum = NoSum;
  static constexpr int threads = 256;
  static constexpr bool diverges = true;
  static constexpr std::uint32_t most_rounds = 1 << 16;
  static constexpr int chunk_size = 8;
  /// A body with more pairs than this is listed as a whole when it is struck: one thread would be slow to
  /// list its chunks.
  static constexpr std::int64_t most_in_chunks = 4096;
  /// Items that look at the pairs of such a body.
  static constexpr std::int64_t threads_of_large_body = 1 << 15;

  FlightStage stage;
  ConstView<Pair> pairs;
  ConstView<LoadedParts> loaded;  ///< loaded parts of each pair; empty: none
  AdjacencyView adjacency;        ///< pairs of each body; there from the first second half on
  bool one_by_one;                ///< whether meetings are resolved in the order of their times, one a round
  int lanes;                      ///< number of threads that look at the pairs of one body
  ImpactProgress* progress;
  // Values of each body:
  View<std::uint64_t> first[2];             ///< FirstMeeting in the even rounds and in the odd ones
  View<std::uint32_t> struck_in, waits_in;  ///< last round in which it was struck, or waited; 0: none
  View<std::uint32_t> impact_group_of;      ///< index of its first meeting with a lighter body
  /// A meeting of the body with one that is not free, counted from 1; next_of_wall of that meeting is the
  /// next one. 0: none.
  View<std::uint32_t> walls_of;
  // Lists, of which only as much is filled as there is room for:
  ConstView<std::int64_t> near;        ///< pairs that come near each other, for the first round
  View<std::int64_t> to_search;        ///< pairs whose meeting is to be searched for in this round
  View<PredictedMeeting> meetings[2];  ///< meetings of the even rounds and of the odd ones, in any order
  View<ImpactGroup> impact_groups;     ///< impact group of each meeting
  View<Resolved> resolved;             ///< impacts, in any order
  View<std::uint64_t> key;             ///< sort key of each impact
  View<StruckBody> struck;
  View<StruckPairs> chunks;  ///< chunks of pairs of bodies that were struck in the last round; room for all
  /// Bodies with more pairs than most_in_chunks that were struck in the last round; there is room for all.
  View<std::int32_t> struck_large_bodies;

  SCREE_HD int phases(const State& state) const {
    if (state.halt != State::Halt::none) return 0;
    if (state.resolving) return state.counts.with_heavy > 0 ? 5 : 2;
    return 1 + (progress->needs_search ? 1 : 0);
  }
  SCREE_HD std::int64_t items(const State& state, int phase) const {
    if (state.resolving) {
      const std::int64_t meetings_now = meetings_of(state);
      return phase == 0 ? state.kept + 2 * lanes * meetings_now : meetings_now;
    }
    if (phase == 0 && state.round == 1) return near_listed();
    if (phase == 0)
      return state.kept + chunk_size * state.chunks + threads_of_large_body * state.struck_large_bodies;
    return listed_to_search(state);
  }
  std::int64_t most_items() const { return std::max(near.size(), to_search.size()); }

  SCREE_HD Sum operator()(const State& state, int phase, std::int64_t item) const {
    if (state.resolving) {
      resolve(state, phase, item);
    } else {
      predict(state, phase, item);
    }
    return {};
  }

  SCREE_HD State judge(State state, const Sum&) const {
    if (state.resolving) {
      state.resolving = false;
      state.kept = meetings_of(state);
      state.chunks = static_cast<std::int64_t>(progress->chunks);
      state.struck_large_bodies = static_cast<std::int64_t>(progress->struck_large_bodies);
      ++state.round;
      return state;
    }
    state.counts = progress->counts[state.round % 2];
    state.fast = progress->fast;
    const auto lacks = [](std::uint64_t needed, std::int64_t room) {
      return static_cast<std::int64_t>(needed) > room;
    };
    if (lacks(progress->near, near.size()) || lacks(state.counts.to_search, to_search.size()) ||
        lacks(state.counts.meetings, meetings[0].size())) {
      state.halt = State::Halt::lists;
      return state;
    }
    state.resolving = state.counts.meetings > 0 && state.round <= most_rounds;
    if (!state.resolving) {
      state.halt = State::Halt::end;
    } else if (adjacency.is_empty() ||
               lacks(progress->impacts + state.counts.meetings, std::min(resolved.size(), key.size())) ||
               lacks(progress->struck + 2 * state.counts.meetings, struck.size())) {
      state.halt = State::Halt::results;
    }
    return state;
  }

 private:
  SCREE_HD static std::int64_t meetings_of(const State& state) {
    return static_cast<std::int64_t>(state.counts.meetings);
  }
  /// Returns the number of listed pairs, as far as there is room.
  SCREE_HD std::int64_t near_listed() const {
    return std::min(static_cast<std::int64_t>(progress->near), near.size());
  }
  SCREE_HD std::int64_t listed_to_search(const State& state) const {
    return std::min(static_cast<std::int64_t>(progress->counts[state.round % 2].to_search), to_search.size());
  }
  SCREE_HD PredictedMeeting& meeting(const State& state, std::int64_t e) const {
    return meetings[state.round % 2][e];
  }
  SCREE_HD FirstMeeting first_of(const State& state, std::int32_t body) const {
    return {first[state.round % 2][body]};
  }
  SCREE_HD BodyNumber number(std::int32_t body) const { return stage.bodies.id[body]; }
  SCREE_HD PairNumbers numbers_of(std::int64_t pair) const {
    const auto [i, j] = pairs[pair];
    return PairNumbers::of(number(i), number(j));
  }
  SCREE_HD LoadedParts loads_of(std::int64_t pair) const { return loads_at(loaded, pair); }
  SCREE_HD std::int32_t partner_in(std::int64_t pair, std::int32_t body) const {
    const auto [i, j] = pairs[pair];
    return i == body ? j : i;
  }

  // The first half of a round: it keeps the meetings of the last round that are unchanged, and predicts those
  // of pairs of which a body was struck in that round.
  SCREE_HD void predict(const State& state, int phase, std::int64_t item) const {
    if (phase == 1) {
      predict_pair(state, to_search[item]);
    } else if (state.round == 1) {
      predict_or_list(state, near[item]);
    } else if (item < state.kept) {
      keep(state, meetings[(state.round + 1) % 2][item]);
    } else if (const std::int64_t of_chunks = item - state.kept; of_chunks < chunk_size * state.chunks) {
      look_at_chunk(state, of_chunks);
    } else {
      look_at_large_body(state, of_chunks - chunk_size * state.chunks);
    }
  }

  SCREE_HD void look_at_chunk(const State& state, std::int64_t item) const {
    const StruckPairs of = chunks[item / chunk_size];
    const std::int64_t place = of.first + item % chunk_size;
    if (place >= adjacency.count(of.body)) return;
    const std::int64_t k = adjacency.pair(of.body, place);
    const auto [i, j] = pairs[k];
    load_ahead(state, i, j);
    if (loaded.size() > 0) prefetch_whole(loaded[k]);
    look_again(state, of.body, k);
  }
  /// Looks at every threads_of_large_body-th pair of a struck body with more than most_in_chunks pairs. Few
  /// of them come near.
  SCREE_HD void look_at_large_body(const State& state, std::int64_t item) const {
    const std::int32_t body = struck_large_bodies[item / threads_of_large_body];
    for (std::int64_t place = item % threads_of_large_body; place < adjacency.count(body);
         place += threads_of_large_body)
      look_again(state, body, adjacency.pair(body, place));
  }
  /// Looks again at a pair of a body that has been struck; if both bodies have been, only from the row of the
  /// first one.
  SCREE_HD void look_again(const State& state, std::int32_t body, std::int64_t k) const {
    const auto [i, j] = pairs[k];
    if (body == j && was_struck(state, i)) return;
    if (stage.top_speed[i] + stage.top_speed[j] > progress->least_impact_speed) look(state, k);
  }
  SCREE_HD void keep(const State& state, const PredictedMeeting& last) const {
    const auto [i, j] = pairs[last.pair];
    for (const std::int32_t body : {i, j}) put(&walls_of[body], 0u);
    if (last.time == HUGE_VAL || was_struck(state, i) || was_struck(state, j)) return;
    add_meeting(state, last);
  }
  /// On a GPU, starts to load all that a round asks of two bodies.
  SCREE_HD void load_ahead(const State& state, std::int32_t i, std::int32_t j) const {
    if constexpr (is_gpu_code) {
      for (const std::int32_t body : {i, j}) {
        stage.load_ahead(body);
        prefetch_whole(first[state.round % 2][body]);
        prefetch_whole(struck_in[body]);
        prefetch_whole(waits_in[body]);
        if (adjacency.is_empty()) continue;
        prefetch_whole(adjacency.begin[body]);
        prefetch_whole(adjacency.begin[body + 1]);
      }
    }
  }
  SCREE_HD bool was_struck(const State& state, std::int32_t body) const {
    return struck_in[body] == state.round - 1;
  }
  SCREE_HD void look(const State& state, std::int64_t k) const {
    const auto [i, j] = pairs[k];
    ImpactLimits limits;
    if (stage.may_meet(i, j, limits) && stage.come_near(i, j, limits, loads_of(k))) predict_or_list(state, k);
  }
  /// Predicts the meeting of a pair that comes near, or lists the pair if that takes a search: searches that
  /// lie side by side keep all threads of a warp busy.
  SCREE_HD void predict_or_list(const State& state, std::int64_t k) const {
    const auto [i, j] = pairs[k];
    if (!stage.needs_search(i) && !stage.needs_search(j)) return predict_pair(state, k);
    const auto place =
        static_cast<std::int64_t>(count_up_together(&progress->counts[state.round % 2].to_search));
    if (place < to_search.size()) to_search[place] = k;
  }
  [[gnu::noinline]] SCREE_HD void predict_pair(const State& state, std::int64_t k) const {
    const auto [i, j] = pairs[k];
    const Meeting meeting = stage.next(i, j, loads_of(k));
    if (meeting.time <= stage.terms.step) add_meeting(state, {meeting.time, k, meeting.part});
  }
  SCREE_HD void add_meeting(const State& state, const PredictedMeeting& meeting) const {
    RoundCounts& counts = progress->counts[state.round % 2];
    const View<PredictedMeeting>& list = meetings[state.round % 2];
    const auto place = static_cast<std::int64_t>(count_up_together(&counts.meetings));
    if (place < list.size()) list[place] = meeting;
    const auto [i, j] = pairs[meeting.pair];
    if (is_of_heavy(i, j)) count_up(&counts.with_heavy);
    lower_first(state, i, j, meeting.time);
    lower_first(state, j, i, meeting.time);
    if (one_by_one) lower(&progress->first[state.round % 2].time, ordered_bits(meeting.time));
  }
  SCREE_HD void lower_first(const State& state, std::int32_t body, std::int32_t other, double time) const {
    if (counts_for(body, other)) lower(&first[state.round % 2][body], of_meeting(other, time).bits);
  }
  SCREE_HD FirstMeeting of_meeting(std::int32_t partner, double time) const {
    return FirstMeeting::of(time, stage.terms.step, number(partner));
  }
  SCREE_HD bool is_of_heavy(std::int32_t i, std::int32_t j) const {
    return stage.is_heavy_to(i, j) || stage.is_heavy_to(j, i);
  }

  // The second half of a round: it resolves the meetings that are first.
  SCREE_HD void resolve(const State& state, int phase, std::int64_t item) const {
    const bool with_heavy = state.counts.with_heavy > 0;
    if (phase == 0) {
      // The counters of the next round can be cleared here, since no thread adds to them in this phase.
      if (item == 0) {
        progress->counts[(state.round + 1) % 2] = {};
        progress->first[(state.round + 1) % 2] = {};
        progress->chunks = progress->struck_large_bodies = 0;
      }
      if (item < state.kept) {
        forget(state, meetings[(state.round + 1) % 2][item]);
      } else {
        prepare(state, item - state.kept);
      }
    } else if (!with_heavy || phase == 3) {
      resolve_first(state, item);
    } else if (phase == 1) {
      scale_impact_groups(state, item);
    } else if (phase == 2) {
      gather_impact_groups(state, item);
    } else {
      end_impact_groups(state, item);
    }
  }

  /// Returns whether a meeting with the other body takes part in the order of a body's meetings.
  SCREE_HD bool counts_for(std::int32_t body, std::int32_t other) const {
    return stage.is_free(body) && !stage.is_heavy_to(body, other);
  }
  /// Returns whether a meeting is first. Two such meetings may share only a body that is heavy to both
  /// others.
  SCREE_HD bool is_first(const State& state, const PredictedMeeting& of) const {
    if (one_by_one) return progress->first[state.round % 2].pair == numbers_of(of.pair).bits;
    const auto [i, j] = pairs[of.pair];
    return is_first_of(state, i, j, of) && is_first_of(state, j, i, of);
  }
  SCREE_HD bool is_first_of(const State& state, std::int32_t body, std::int32_t other,
                            const PredictedMeeting& of) const {
    if (!counts_for(body, other)) return true;
    return first_of(state, body).bits == of_meeting(other, of.time).bits && waits_in[body] != state.round;
  }
  SCREE_HD ImpactGroup& impact_group(std::int32_t heavy) const {
    return impact_groups[impact_group_of[heavy]];
  }

  /// Clears the first meetings of the bodies of a meeting of the last round: they are not needed any more,
  /// and the next round uses the same array.
  SCREE_HD void forget(const State& state, const PredictedMeeting& last) const {
    const auto [i, j] = pairs[last.pair];
    for (const std::int32_t body : {i, j}) put(&first[(state.round + 1) % 2][body], no_meeting);
  }
  /// Prepares a meeting. Each body of each meeting has `lanes` items.
  SCREE_HD void prepare(const State& state, std::int64_t item) const {
    const auto lane = static_cast<int>(item % lanes);
    const std::int64_t e = item / lanes / 2;
    PredictedMeeting& of = meeting(state, e);
    const auto [i, j] = pairs[of.pair];
    const bool is_i = item / lanes % 2 == 0;
    const std::int32_t body = is_i ? i : j;
    const std::int32_t other = is_i ? j : i;
    load_ahead(state, i, j);
    if (lane == 0) {
      if (is_i) start_meeting(state, of, e);
      if (stage.is_heavy_to(body, other)) lower(&impact_group_of[body], static_cast<std::uint32_t>(e));
    }
    if (!one_by_one && counts_for(body, other) &&
        first_of(state, body).bits == of_meeting(other, of.time).bits)
      find_waits(state, body, lane);
  }
  SCREE_HD void start_meeting(const State& state, PredictedMeeting& of, std::int64_t e) const {
    const auto [i, j] = pairs[of.pair];
    if (stage.is_free(i) != stage.is_free(j))
      of.next_of_wall = exchange(&walls_of[stage.is_free(i) ? i : j], static_cast<std::uint32_t>(e + 1));
    if (is_of_heavy(i, j)) impact_groups[e] = {};
    FirstOfAll& of_all = progress->first[state.round % 2];
    if (one_by_one && of_all.time == ordered_bits(of.time)) lower(&of_all.pair, numbers_of(of.pair).bits);
  }

  /// Finds the waits between a body that has a meeting and those of its partners that have one. A pair is
  /// looked at from the body that is in fewer pairs, since a body with many pairs may be in very many.
  SCREE_HD void find_waits(const State& state, std::int32_t body, int lane) const {
    if (adjacency.has_many_pairs(body)) return find_waits_of_many(state, body, lane);
    const std::int64_t own = adjacency.count(body);
    for (std::int64_t place = lane; place < own; place += lanes) {
      const std::int64_t k = adjacency.pair(body, place);
      const std::int32_t other = partner_in(k, body);
      load_ahead(state, body, other);
      if (!stage.is_free(other)) continue;
      const std::int64_t others = adjacency.count(other);
      if (own < others || (own == others && body < other)) make_wait(state, body, other);
    }
  }
  SCREE_HD void find_waits_of_many(const State& state, std::int32_t body, int lane) const {
    for (std::int64_t place = lane; place < adjacency.between_many.size(); place += lanes) {
      const auto [i, j] = pairs[adjacency.between_many[place]];
      if (i == body) make_wait(state, i, j);
    }
  }

  /// Lets one of two bodies that could meet wait. The one whose first meeting is later waits for the other
  /// one's, if that could drive the other body into it before. If both meetings are at the same time and one
  /// body is heavy to the other, the meeting of the first pair goes first, since both meetings would change
  /// the heavy body. No circle of bodies can wait for each other, since all meetings are in one order.
  SCREE_HD void make_wait(const State& state, std::int32_t i, std::int32_t j) const {
    const FirstMeeting of_i = first_of(state, i);
    const FirstMeeting of_j = first_of(state, j);
    if (of_i.is_none() || of_j.is_none()) return;
    const bool with_j = of_i.partner() == number(j);
    const bool with_i = of_j.partner() == number(i);
    if (with_i && with_j) return;
    const bool at_once = of_i.part() == of_j.part();
    if (at_once && !is_of_heavy(i, j)) return;
    const bool i_goes = at_once ? PairNumbers::of(number(i), of_i.partner()).bits <
                                      PairNumbers::of(number(j), of_j.partner()).bits
                                : of_i.part() < of_j.part();
    const std::int32_t goes = i_goes ? i : j;
    const std::int32_t waits = i_goes ? j : i;
    const bool with_it = i_goes ? with_j : with_i;
    if (with_it || may_meet_before(goes, waits, i_goes ? of_i : of_j, i_goes ? of_j : of_i))
      put(&waits_in[waits], state.round);
  }
  /// Returns whether a body may meet another one between its first meeting and that of the other.
  SCREE_HD bool may_meet_before(std::int32_t body, std::int32_t other, const FirstMeeting& of_body,
                                const FirstMeeting& of_other) const {
    const std::int32_t partner = stage.bodies.place(of_body.partner());
    const double from = of_body.time(stage.terms.step);
    const double until = of_other.time(stage.terms.step);
    // Its meeting gives the body at most the speed that an elastic bounce off a moving wall gives.
    const double driven = stage.top_speed[body] + 2 * stage.top_speed[partner];
    const BodyFlight flight = stage.flight(body);
    const BodyFlight others = stage.flight(other);
    const double reach = bounding_radius(flight.shape, flight.size) +
                         bounding_radius(others.shape, others.size) +
                         (driven + stage.top_speed[other]) * (until - from);
    const Vec3 offset = stage.bodies.period.nearest(others.position_at(from) - flight.position_at(from));
    return offset.squaredNorm() <= reach * reach;
  }

  /// Notes the fastest of the lighter bodies of each impact group, which sets the units of its sums.
  SCREE_HD void scale_impact_groups(const State& state, std::int64_t e) const {
    const auto [i, j] = pairs[meeting(state, e).pair];
    scale_impact_group(i, j);
    scale_impact_group(j, i);
  }
  SCREE_HD void scale_impact_group(std::int32_t body, std::int32_t other) const {
    if (stage.is_heavy_to(body, other))
      raise(&impact_group(body).fastest, ordered_bits(stage.top_speed[other]));
  }
  /// Adds up what the first meetings give to heavy bodies in impact groups.
  SCREE_HD void gather_impact_groups(const State& state, std::int64_t e) const {
    const PredictedMeeting& of = meeting(state, e);
    const auto [i, j] = pairs[of.pair];
    if (!is_of_heavy(i, j) || !is_first(state, of)) return;
    SolvedImpact solved;
    if (!solve(state, of, solved)) return;
    const std::int32_t heavy = stage.is_heavy_to(i, j) ? i : j;
    add_to_impact_group(stage, heavy, solved, numbers_of(of.pair).bits, impact_group(heavy));
  }

  SCREE_HD void resolve_first(const State& state, std::int64_t e) const {
    PredictedMeeting& of = meeting(state, e);
    const auto [i, j] = pairs[of.pair];
    load_ahead(state, i, j);
    if (!is_first(state, of)) return;
    const StruckBody before_i = before_impacts(stage, i);
    const StruckBody before_j = before_impacts(stage, j);
    SolvedImpact solved;
    if (!solve(state, of, solved)) {
      of.time = HUGE_VAL;
      return;
    }
    const bool heavy_i = stage.is_heavy_to(i, j);
    const bool heavy_j = stage.is_heavy_to(j, i);
    const auto place = static_cast<std::int64_t>(count_up(&progress->impacts));
    mark_struck(state, {before_i, before_j}, {!heavy_i, !heavy_j});
    if (heavy_i || heavy_j) {
      const std::int32_t heavy = heavy_i ? i : j;
      ImpactGroup& with = impact_group(heavy);
      const double scale = ImpactGroupOutcome(stage, heavy, with).scale();
      resolved[place].moved = fly_on_scaled(stage, heavy, solved, scale, resolved[place].impact);
      if (with.first_missing == ~numbers_of(of.pair).bits) with.place = static_cast<std::uint64_t>(place);
    } else {
      resolved[place].moved = fly_on(stage, solved, resolved[place].impact);
    }
    key[place] = key_of(state, of.pair);
    for (int k = 0; k < solved.count; ++k)
      if (solved.is_first_of_wall(k)) add_impact_of_wall(state, solved, solved.wall[k]);
    if (of.time > 0.5 * stage.terms.step) raise(&progress->late_impact, 1u);
    if (std::max(heavy_i ? 0.0 : stage.budget_used[i], heavy_j ? 0.0 : stage.budget_used[j]) >= impacts_end)
      raise(&progress->hit_bound, 1u);
  }
  [[gnu::noinline]] SCREE_HD bool solve(const State& state, const PredictedMeeting& of,
                                        SolvedImpact& solved) const {
    const auto [i, j] = pairs[of.pair];
    return solve_impact(stage, i, j, {.time = of.time, .part = of.part}, loads_of(of.pair),
                        OtherWalls{*this, state, of.pair}, solved);
  }
  SCREE_HD std::uint64_t key_of(const State& state, std::int64_t pair) const {
    return std::uint64_t{state.round} * static_cast<std::uint64_t>(pairs.size()) +
           static_cast<std::uint64_t>(pair);
  }

  /// The meetings of a pair's free body with other walls, in the order of their pairs.
  struct OtherWalls {
    const ImpactProgram& program;
    const State& state;
    std::int64_t pair;

    template <class Then>
    SCREE_HD void operator()(const Then& then) const {
      const auto [i, j] = program.pairs[pair];
      const bool free_i = program.stage.is_free(i);
      if (free_i == program.stage.is_free(j)) return;
      const std::int32_t body = free_i ? i : j;
      const PredictedMeeting* of = from(body, 0);
      for (; of != nullptr; of = from(body, program.numbers_of(of->pair).bits + 1)) {
        const auto [first, second] = program.pairs[of->pair];
        if (of->pair != pair) then(first == body ? second : first, of->part);
      }
    }
    /// Returns the first meeting of a body with a wall whose PairNumbers are at least `least`; null if there
    /// is none.
    SCREE_HD const PredictedMeeting* from(std::int32_t body, std::uint64_t least) const {
      const PredictedMeeting* next = nullptr;
      std::uint64_t of_next = ~std::uint64_t{0};
      for (std::uint32_t e = program.walls_of[body]; e != 0;) {
        const PredictedMeeting& of = program.meeting(state, e - 1);
        const std::uint64_t numbers = program.numbers_of(of.pair).bits;
        if (numbers >= least && numbers < of_next) {
          next = &of;
          of_next = numbers;
        }
        e = of.next_of_wall;
      }
      return next;
    }
  };

  /// Adds the part of an impact with another wall. There is room for it, since the meeting with that wall is
  /// not resolved by itself.
  SCREE_HD void add_impact_of_wall(const State& state, const SolvedImpact& solved, std::int32_t wall) const {
    const std::int32_t body = stage.is_free(solved.i) ? solved.i : solved.j;
    for (std::uint32_t e = walls_of[body]; e != 0;) {
      const PredictedMeeting& of = meeting(state, e - 1);
      e = of.next_of_wall;
      const auto [i, j] = pairs[of.pair];
      if (i != wall && j != wall) continue;
      const auto place = static_cast<std::int64_t>(count_up(&progress->impacts));
      resolved[place] = {solved.of_wall(wall), Ledger{}};
      key[place] = key_of(state, of.pair);
    }
  }
  /// Notes that free bodies have been struck, those of `before` whose `counts` is set, and lists their pairs.
  /// They take their places in the lists together, since a thread of a GPU waits long for each addition.
  template <int bodies>
  SCREE_HD void mark_struck(const State& state, const StruckBody (&before)[bodies],
                            const bool (&counts)[bodies]) const {
    bool is_struck[bodies], is_new[bodies];
    std::int64_t needed[bodies];
    std::uint64_t all_new = 0, all_needed = 0;
    for (int b = 0; b < bodies; ++b) {
      const std::int32_t body = before[b].body;
      is_struck[b] = counts[b] && stage.is_free(body);
      is_new[b] = is_struck[b] && struck_in[body] == 0;
      const std::int64_t of_body = adjacency.count(body);
      const bool is_large = of_body > most_in_chunks;
      needed[b] = is_struck[b] && !is_large ? (of_body + chunk_size - 1) / chunk_size : 0;
      if (is_struck[b] && is_large)
        struck_large_bodies[static_cast<std::int64_t>(count_up(&progress->struck_large_bodies))] = body;
      all_new += is_new[b] ? 1 : 0;
      all_needed += static_cast<std::uint64_t>(needed[b]);
    }
    auto place = static_cast<std::int64_t>(add(&progress->struck, all_new));
    auto chunk = static_cast<std::int64_t>(add(&progress->chunks, all_needed));
    for (int b = 0; b < bodies; ++b) {
      if (is_new[b]) struck[place++] = before[b];
      if (is_struck[b]) struck_in[before[b].body] = state.round;
      for (std::int64_t c = 0; c < needed[b]; ++c)
        chunks[chunk++] = {before[b].body, static_cast<std::int32_t>(c * chunk_size)};
    }
  }

  /// Applies each impact group to its heavy body.
  SCREE_HD void end_impact_groups(const State& state, std::int64_t e) const {
    const auto [i, j] = pairs[meeting(state, e).pair];
    if (!is_of_heavy(i, j)) return;
    const std::int32_t heavy = stage.is_heavy_to(i, j) ? i : j;
    if (impact_group_of[heavy] != static_cast<std::uint32_t>(e)) return;
    impact_group_of[heavy] = no_impact_group;
    const ImpactGroup& given = impact_groups[e];
    if (given.impacts == 0) return;
    mark_struck(state, {before_impacts(stage, heavy)}, {true});
    const ImpactGroupOutcome outcome(stage, heavy, given);
    Ledger& moved = resolved[static_cast<std::int64_t>(given.place)].moved;
    moved = moved + outcome.fly_on(stage, heavy);
  }
};

}  // namespace scree::detail
