// The rounds of impacts of a flight as phases (core/space_rounds.hpp). The first half of a round foresees
// which pairs meet, the second one resolves the meetings that are first where they are.
#pragma once

#include "core/array.hpp"
#include "core/space_atomic.hpp"
#include "narrowphase/candidates.hpp"
#include "sim/dynamics/impact.hpp"
#include "sim/dynamics/volley.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace scree::detail {

/// A meeting, as foreseen.
struct Foreseen {
  double time;        ///< into the substep (s); infinite: it has come to nothing
  std::int64_t pair;  ///< in the list of the pairs
  std::int32_t part;
  std::uint32_t next_of_wall = 0;  ///< ImpactProgram::walls_of
};

/// The first meeting of a body: the earliest, of equal ones that of the first pair.
struct FirstMeeting {
  std::uint64_t time;  ///< its bits, which are in the order of times
  std::uint64_t pair;  ///< the numbers of its bodies: PairNumbers
};

/// The order of pairs, which is that of their bodies' numbers: it does not hang on where bodies lie.
struct PairNumbers {
  std::uint64_t bits;

  SCREE_HD static PairNumbers of(BodyNumber i, BodyNumber j) {
    return {static_cast<std::uint64_t>(i) << 32 | static_cast<std::uint64_t>(j)};
  }
  SCREE_HD BodyNumber i() const { return BodyNumber{static_cast<std::int32_t>(bits >> 32)}; }
  SCREE_HD BodyNumber j() const { return BodyNumber{static_cast<std::int32_t>(bits & 0xffffffffu)}; }
};

/// An impact, and what it moved.
struct Resolved {
  Impact impact;
  Ledger moved;
};

/// The bits of a number that is not negative are in the order of such numbers.
SCREE_HD inline std::uint64_t ordered_bits(double x) { return std::bit_cast<std::uint64_t>(x + 0.0); }
inline constexpr auto infinite = std::bit_cast<std::uint64_t>(HUGE_VAL);

inline constexpr FirstMeeting no_meeting{infinite, ~std::uint64_t{0}};
inline constexpr std::uint32_t not_yet = ~std::uint32_t{0};    ///< of rounds
inline constexpr std::uint32_t no_volley = ~std::uint32_t{0};  ///< of meetings

/// How many a round has found.
struct RoundCounts {
  std::uint64_t suspects = 0;
  std::uint64_t meetings = 0;
  std::uint64_t with_heavy = 0;  ///< of these, with a body that is heavy to the other
};

/// What the threads of a flight tell each other, and the host at the end.
struct ImpactProgress {
  RoundCounts counts[2];  ///< of the even rounds and of the odd ones
  FirstMeeting first[2] = {{infinite, ~std::uint64_t{0}},
                           {infinite, ~std::uint64_t{0}}};  ///< of all, likewise
  double harmless = 0;     ///< FlightStage::harmless; infinite where nobody is faster (m/s)
  std::uint64_t busy = 0;  ///< pairs of bodies that have joined
  std::uint64_t impacts = 0;
  std::uint64_t struck = 0;     ///< bodies
  std::uint32_t last_join = 0;  ///< the last round in which a body first had a meeting to come
  std::uint32_t late = 0;       ///< whether one of them was struck after the midpoint
  std::uint32_t hit_bound = 0;
};

/// Where the rounds are.
struct RoundsState {
  /// They halt at the end, or where there is no room to go on: in the lists of the first half, or for what
  /// the second half may resolve.
  enum class Halt : std::uint8_t { none, end, lists, results };

  Halt halt = Halt::none;
  bool resolving = false;  ///< in the second half
  std::uint32_t round = 1;
  std::int64_t kept = 0;   ///< meetings of the round before
  std::uint64_t busy = 0;  ///< ImpactProgress::busy at its end
  RoundCounts counts;      ///< of this round, once its first half is over
};

/// Nothing to add up.
struct NoSum {
  SCREE_HD friend NoSum operator+(NoSum, NoSum) { return {}; }
};

/// One round after another, until nobody meets.
struct ImpactProgram {
  using State = RoundsState;
  using Sum = NoSum;
  static constexpr int threads = 256;
  static constexpr std::uint32_t most_rounds = 1 << 16;

  FlightStage stage;
  ConstView<Pair> pairs;
  ConstView<LoadedParts> loaded;  ///< of each pair; empty: none
  bool one_by_one;                ///< in the order of their times, one a round
  ImpactProgress* progress;
  // Of each body:
  View<FirstMeeting> first;
  View<std::uint32_t> joined_in;            ///< the round that first foresaw a meeting of its own
  View<std::uint32_t> struck_in, waits_in;  ///< the last such round, 0 for none
  View<std::uint32_t> volley_of;            ///< its first meeting with a lighter one
  /// One of its meetings with what is not free, from 1 on; the next is that meeting's next_of_wall. 0: none.
  View<std::uint32_t> walls_of;
  // As long as there is room:
  View<std::int64_t> suspects;  ///< pairs that are to be looked at in this round
  View<std::int64_t> busy;      ///< pairs of bodies that have joined
  View<Foreseen> meetings[2];   ///< of the even rounds and of the odd ones, in any order
  View<Volley> volleys;         ///< of each meeting
  View<Resolved> resolved;      ///< impacts, in any order
  View<std::uint64_t> key;      ///< of each one's place
  View<StruckBody> struck;

  SCREE_HD int phases(const State& state) const {
    if (state.halt != State::Halt::none) return 0;
    if (!state.resolving) return 3;
    return state.counts.with_heavy > 0 ? 5 : 3;
  }
  SCREE_HD std::int64_t items(const State& state, int phase) const {
    if (state.resolving) {
      const std::int64_t waiting = phase == 1 ? static_cast<std::int64_t>(state.busy) : 0;
      return waiting + meetings_of(state);
    }
    if (progress->harmless == HUGE_VAL) return 0;
    if (phase == 0) return state.kept + (state.round > 1 ? static_cast<std::int64_t>(state.busy) : runs());
    if (phase == 1) {
      const std::int64_t listed = suspects_listed(state);
      return listed + (state.round > 1 || listed == 0 ? 0 : first.size());
    }
    return meetings_listed(state) + (progress->last_join == state.round ? runs() : 0);
  }
  std::int64_t most_items() const { return std::max(runs(), suspects.size()); }

  SCREE_HD Sum operator()(const State& state, int phase, std::int64_t item) const {
    if (state.resolving) {
      resolve(state, phase, item);
    } else {
      foresee(state, phase, item);
    }
    return {};
  }

  SCREE_HD State judge(State state, const Sum&) const {
    if (state.resolving) {
      state.resolving = false;
      state.kept = meetings_of(state);
      ++state.round;
      return state;
    }
    state.counts = progress->counts[state.round % 2];
    const auto lacks = [](std::uint64_t needed, std::int64_t room) {
      return static_cast<std::int64_t>(needed) > room;
    };
    if (lacks(state.counts.suspects, suspects.size()) || lacks(progress->busy, busy.size()) ||
        lacks(state.counts.meetings, meetings[0].size())) {
      state.halt = State::Halt::lists;
      return state;
    }
    state.busy = progress->busy;
    state.resolving = state.counts.meetings > 0 && state.round <= most_rounds;
    if (!state.resolving) {
      state.halt = State::Halt::end;
    } else if (lacks(progress->impacts + state.counts.meetings, std::min(resolved.size(), key.size())) ||
               lacks(progress->struck + 2 * state.counts.meetings, struck.size())) {
      state.halt = State::Halt::results;
    }
    return state;
  }

 private:
  /// Pairs that a thread looks at, so that it waits for all their bodies at once.
  static constexpr int run = 8;

  SCREE_HD std::int64_t runs() const { return (pairs.size() + run - 1) / run; }
  SCREE_HD static std::int64_t meetings_of(const State& state) {
    return static_cast<std::int64_t>(state.counts.meetings);
  }
  /// As far as there is room, in the first half.
  SCREE_HD std::int64_t suspects_listed(const State& state) const {
    return std::min(static_cast<std::int64_t>(progress->counts[state.round % 2].suspects), suspects.size());
  }
  SCREE_HD std::int64_t meetings_listed(const State& state) const {
    return std::min(static_cast<std::int64_t>(progress->counts[state.round % 2].meetings),
                    meetings[0].size());
  }
  SCREE_HD Foreseen& meeting(const State& state, std::int64_t e) const {
    return meetings[state.round % 2][e];
  }
  SCREE_HD PairNumbers numbers_of(std::int64_t pair) const {
    const auto [i, j] = pairs[pair];
    return PairNumbers::of(stage.bodies.id[i], stage.bodies.id[j]);
  }
  SCREE_HD LoadedParts loads_of(std::int64_t pair) const {
    return loaded.size() > 0 ? loaded[pair] : LoadedParts{};
  }
  /// Calls then(k) for those pairs of a run of which is_wanted(i, j) says so, which must change nothing.
  template <class IsWanted, class Then>
  SCREE_HD void for_each_of_run(std::int64_t number, const IsWanted& is_wanted, const Then& then) const {
    const std::int64_t begin = number * run;
    std::uint32_t wanted = 0;
    for (int k = 0; k < run; ++k) {
      if (begin + k >= pairs.size()) continue;
      const auto [i, j] = pairs[begin + k];
      wanted |= (is_wanted(i, j) ? 1u : 0u) << k;
    }
    for (int k = 0; wanted >> k != 0; ++k) {
      if ((wanted >> k & 1u) != 0) then(begin + k);
    }
  }

  // The first half: meetings of the last round that have stayed as they were, and those of pairs of which a
  // body has been struck in it.
  SCREE_HD void foresee(const State& state, int phase, std::int64_t item) const {
    if (phase == 0) {
      if (item < state.kept) {
        keep(state, meetings[(state.round + 1) % 2][item]);
      } else if (state.round > 1) {
        suspect_again(state, busy[item - state.kept]);
      } else {
        for_each_of_run(
            item, [this](std::int32_t i, std::int32_t j) { return is_fast(i, j); },
            [&](std::int64_t k) { suspect(state, k); });
      }
    } else if (phase == 1) {
      const std::int64_t listed = suspects_listed(state);
      if (item < listed) {
        foresee_pair(state, suspects[item]);
      } else {
        reset(item - listed);
      }
    } else {
      const std::int64_t listed = meetings_listed(state);
      if (item < listed) {
        find_first_times(state, item);
      } else {
        list_busy(state, item - listed);
      }
    }
  }

  /// The first meetings of its bodies are no more.
  SCREE_HD void keep(const State& state, const Foreseen& last) const {
    const auto [i, j] = pairs[last.pair];
    for (const std::int32_t body : {i, j}) {
      exchange(&first[body].time, no_meeting.time);
      exchange(&first[body].pair, no_meeting.pair);
      exchange(&walls_of[body], 0u);
    }
    if (last.time == HUGE_VAL || was_struck(state, i) || was_struck(state, j)) return;
    add_meeting(state, last);
  }
  SCREE_HD bool was_struck(const State& state, std::int32_t body) const {
    return struck_in[body] == state.round - 1;
  }
  SCREE_HD bool is_fast(std::int32_t i, std::int32_t j) const {
    return stage.top_speed[i] + stage.top_speed[j] > progress->harmless;
  }
  SCREE_HD void suspect_again(const State& state, std::int64_t k) const {
    const auto [i, j] = pairs[k];
    if ((was_struck(state, i) || was_struck(state, j)) && is_fast(i, j)) suspect(state, k);
  }
  /// Lists a pair that may meet.
  SCREE_HD void suspect(const State& state, std::int64_t k) const {
    const auto [i, j] = pairs[k];
    ImpactLimits limits;
    if (!stage.may_meet(i, j, limits) || !stage.come_near(i, j, limits, loads_of(k))) return;
    const auto place = static_cast<std::int64_t>(count_up(&progress->counts[state.round % 2].suspects));
    if (place < suspects.size()) suspects[place] = k;
  }
  SCREE_HD void foresee_pair(const State& state, std::int64_t k) const {
    const auto [i, j] = pairs[k];
    const Meeting meeting = stage.next(i, j, loads_of(k));
    if (!(meeting.time <= stage.terms.step)) return;
    add_meeting(state, {meeting.time, k, meeting.part});
    for (const std::int32_t body : {i, j}) {
      if (stage.is_free(body) && lower(&joined_in[body], state.round))
        raise(&progress->last_join, state.round);
    }
  }
  SCREE_HD void add_meeting(const State& state, const Foreseen& meeting) const {
    RoundCounts& counts = progress->counts[state.round % 2];
    const View<Foreseen>& list = meetings[state.round % 2];
    const auto place = static_cast<std::int64_t>(count_up(&counts.meetings));
    if (place < list.size()) list[place] = meeting;
    const auto [i, j] = pairs[meeting.pair];
    if (is_of_heavy(i, j)) count_up(&counts.with_heavy);
  }
  SCREE_HD bool is_of_heavy(std::int32_t i, std::int32_t j) const {
    return stage.is_heavy_to(i, j) || stage.is_heavy_to(j, i);
  }
  /// Before the first round.
  SCREE_HD void reset(std::int64_t body) const {
    first[body] = no_meeting;
    struck_in[body] = waits_in[body] = walls_of[body] = 0;
    volley_of[body] = no_volley;
  }
  /// Lists the pairs of bodies that have joined in this round, but for those of bodies that had before.
  SCREE_HD void list_busy(const State& state, std::int64_t number) const {
    for_each_of_run(
        number,
        [&](std::int32_t i, std::int32_t j) { return std::min(joined_in[i], joined_in[j]) == state.round; },
        [&](std::int64_t k) {
          const auto place = static_cast<std::int64_t>(count_up(&progress->busy));
          if (place < busy.size()) busy[place] = k;
        });
  }
  SCREE_HD void find_first_times(const State& state, std::int64_t e) const {
    const Foreseen& of = meeting(state, e);
    const auto [i, j] = pairs[of.pair];
    if (counts_for(i, j)) lower(&first[i].time, ordered_bits(of.time));
    if (counts_for(j, i)) lower(&first[j].time, ordered_bits(of.time));
    if (one_by_one) lower(&progress->first[state.round % 2].time, ordered_bits(of.time));
    if (is_of_heavy(i, j)) volleys[e] = {};
  }

  // The second half.
  SCREE_HD void resolve(const State& state, int phase, std::int64_t item) const {
    if (phase == 0) {
      // Nobody counts in those of the next round yet.
      if (item == 0) {
        progress->counts[(state.round + 1) % 2] = {};
        progress->first[(state.round + 1) % 2] = no_meeting;
      }
      find_first_pairs(state, item);
      return;
    }
    const auto waiting = static_cast<std::int64_t>(state.busy);
    const bool with_heavy = state.counts.with_heavy > 0;
    if (phase == 1) {
      if (item < waiting) {
        make_wait(state, busy[item]);
      } else if (with_heavy) {
        scale_volleys(state, item - waiting);
      }
    } else if (!with_heavy || phase == 3) {
      resolve_first(state, item);
    } else if (phase == 2) {
      gather_volleys(state, item);
    } else {
      end_volleys(state, item);
    }
  }

  /// Whether a meeting with the other has its turn among those of a body.
  SCREE_HD bool counts_for(std::int32_t body, std::int32_t other) const {
    return stage.is_free(body) && !stage.is_heavy_to(body, other);
  }
  /// All that are first; no two of them share a body but one that is heavy to both others.
  SCREE_HD bool is_first(const State& state, const Foreseen& of) const {
    if (one_by_one) return progress->first[state.round % 2].pair == numbers_of(of.pair).bits;
    const auto [i, j] = pairs[of.pair];
    return is_first_of(state, i, j, of) && is_first_of(state, j, i, of);
  }
  SCREE_HD bool is_first_of(const State& state, std::int32_t body, std::int32_t other,
                            const Foreseen& of) const {
    if (!counts_for(body, other)) return true;
    return first[body].pair == numbers_of(of.pair).bits && waits_in[body] != state.round;
  }
  SCREE_HD Volley& volley(std::int32_t heavy) const { return volleys[volley_of[heavy]]; }

  /// Also gives each heavy body a volley, and lists the meetings of each body with walls.
  SCREE_HD void find_first_pairs(const State& state, std::int64_t e) const {
    Foreseen& of = meeting(state, e);
    const auto [i, j] = pairs[of.pair];
    if (stage.is_free(i) != stage.is_free(j))
      of.next_of_wall = exchange(&walls_of[stage.is_free(i) ? i : j], static_cast<std::uint32_t>(e + 1));
    find_first_pair(i, j, of, static_cast<std::uint32_t>(e));
    find_first_pair(j, i, of, static_cast<std::uint32_t>(e));
    FirstMeeting& of_all = progress->first[state.round % 2];
    if (one_by_one && of_all.time == ordered_bits(of.time)) lower(&of_all.pair, numbers_of(of.pair).bits);
  }
  SCREE_HD void find_first_pair(std::int32_t body, std::int32_t other, const Foreseen& of,
                                std::uint32_t e) const {
    if (stage.is_heavy_to(body, other)) {
      lower(&volley_of[body], e);
    } else if (first[body].time == ordered_bits(of.time)) {
      lower(&first[body].pair, numbers_of(of.pair).bits);
    }
  }

  /// Of two bodies that could meet, the one whose first meeting is later waits for the other's, if that could
  /// drive the other into it before. Of meetings at the same time the first pair's goes first, if one body is
  /// heavy to the other: both meetings would change that. Nobody waits in a circle: meetings are in one
  /// order.
  SCREE_HD void make_wait(const State& state, std::int64_t k) const {
    const auto [i, j] = pairs[k];
    const FirstMeeting of_i = first[i];
    const FirstMeeting of_j = first[j];
    if (of_i.time == infinite || of_j.time == infinite || of_i.pair == of_j.pair) return;
    if (of_i.time == of_j.time && !is_of_heavy(i, j)) return;
    const bool i_goes = of_i.time < of_j.time || (of_i.time == of_j.time && of_i.pair < of_j.pair);
    const std::int32_t goes = i_goes ? i : j;
    const std::int32_t waits = i_goes ? j : i;
    const bool with_it = first[goes].pair == numbers_of(k).bits;
    if (with_it || may_meet_before(goes, waits)) raise(&waits_in[waits], state.round);
  }
  /// Whether a body may meet another one between its first meeting and the other's.
  SCREE_HD bool may_meet_before(std::int32_t body, std::int32_t other) const {
    const PairNumbers of{first[body].pair};
    const std::int32_t i = stage.bodies.place(of.i()), j = stage.bodies.place(of.j());
    const double from = std::bit_cast<double>(first[body].time);
    const double until = std::bit_cast<double>(first[other].time);
    const double driven =
        stage.top_speed[body] + 2 * stage.top_speed[i == body ? j : i];  // as by a moving wall
    const BodyFlight flight = stage.flight(body);
    const BodyFlight others = stage.flight(other);
    const double near = bounding_radius(flight.shape, flight.size) +
                        bounding_radius(others.shape, others.size) +
                        (driven + stage.top_speed[other]) * (until - from);
    const Vec3 offset = stage.bodies.period.nearest(others.position_at(from) - flight.position_at(from));
    return offset.squaredNorm() <= near * near;
  }

  /// The speeds that volleys have to do with.
  SCREE_HD void scale_volleys(const State& state, std::int64_t e) const {
    const auto [i, j] = pairs[meeting(state, e).pair];
    scale_volley(i, j);
    scale_volley(j, i);
  }
  SCREE_HD void scale_volley(std::int32_t body, std::int32_t other) const {
    if (stage.is_heavy_to(body, other)) raise(&volley(body).fastest, ordered_bits(stage.top_speed[other]));
  }
  /// Adds up what the first meetings give to heavy bodies.
  SCREE_HD void gather_volleys(const State& state, std::int64_t e) const {
    const Foreseen& of = meeting(state, e);
    const auto [i, j] = pairs[of.pair];
    if (!is_of_heavy(i, j) || !is_first(state, of)) return;
    SolvedImpact solved;
    if (!solve_impact(stage, i, j, {.time = of.time, .part = of.part}, loads_of(of.pair), NoOtherWalls{},
                      solved))
      return;
    const std::int32_t heavy = stage.is_heavy_to(i, j) ? i : j;
    add_to_volley(stage, heavy, solved, numbers_of(of.pair).bits, volley(heavy));
  }

  SCREE_HD void resolve_first(const State& state, std::int64_t e) const {
    Foreseen& of = meeting(state, e);
    if (!is_first(state, of)) return;
    const auto [i, j] = pairs[of.pair];
    const StruckBody before_i = before_impacts(stage, i);
    const StruckBody before_j = before_impacts(stage, j);
    SolvedImpact solved;
    if (!solve_impact(stage, i, j, {.time = of.time, .part = of.part}, loads_of(of.pair),
                      OtherWalls{*this, state, of.pair}, solved)) {
      of.time = HUGE_VAL;
      return;
    }
    const bool heavy_i = stage.is_heavy_to(i, j);
    const bool heavy_j = stage.is_heavy_to(j, i);
    const auto place = static_cast<std::int64_t>(count_up(&progress->impacts));
    if (heavy_i || heavy_j) {
      const std::int32_t heavy = heavy_i ? i : j;
      Volley& with = volley(heavy);
      const double scale = VolleyOutcome(stage, heavy, with).scale();
      resolved[place].moved = fly_on_scaled(stage, heavy, solved, scale, resolved[place].impact);
      if (with.first_missing == ~numbers_of(of.pair).bits) with.place = static_cast<std::uint64_t>(place);
    } else {
      resolved[place].moved = fly_on(stage, solved, resolved[place].impact);
    }
    if (!heavy_i) mark_struck(state, before_i);
    if (!heavy_j) mark_struck(state, before_j);
    key[place] = key_of(state, of.pair);
    for (int k = 0; k < solved.count; ++k)
      if (solved.is_first_of_wall(k)) add_impact_of_wall(state, solved, solved.wall[k]);
    if (of.time > 0.5 * stage.terms.step) raise(&progress->late, 1u);
    if (std::max(heavy_i ? 0.0 : stage.weary[i], heavy_j ? 0.0 : stage.weary[j]) >= impacts_end)
      raise(&progress->hit_bound, 1u);
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
      const Foreseen* of = from(body, 0);
      for (; of != nullptr; of = from(body, program.numbers_of(of->pair).bits + 1)) {
        const auto [first, second] = program.pairs[of->pair];
        if (of->pair != pair) then(first == body ? second : first, of->part);
      }
    }
    /// The first of a body's from a pair on; null if there is none.
    SCREE_HD const Foreseen* from(std::int32_t body, std::uint64_t least) const {
      const Foreseen* next = nullptr;
      std::uint64_t of_next = ~std::uint64_t{0};
      for (std::uint32_t e = program.walls_of[body]; e != 0;) {
        const Foreseen& of = program.meeting(state, e - 1);
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

  /// There is room, since its meeting is not resolved besides.
  SCREE_HD void add_impact_of_wall(const State& state, const SolvedImpact& solved, std::int32_t wall) const {
    const std::int32_t body = stage.is_free(solved.i) ? solved.i : solved.j;
    for (std::uint32_t e = walls_of[body]; e != 0;) {
      const Foreseen& of = meeting(state, e - 1);
      e = of.next_of_wall;
      const auto [i, j] = pairs[of.pair];
      if (i != wall && j != wall) continue;
      const auto place = static_cast<std::int64_t>(count_up(&progress->impacts));
      resolved[place] = {solved.of_wall(wall), Ledger{}};
      key[place] = key_of(state, of.pair);
    }
  }
  SCREE_HD void mark_struck(const State& state, const StruckBody& before) const {
    if (!stage.is_free(before.body)) return;
    if (struck_in[before.body] == 0) struck[static_cast<std::int64_t>(count_up(&progress->struck))] = before;
    struck_in[before.body] = state.round;
  }

  /// Gives each volley to its heavy body.
  SCREE_HD void end_volleys(const State& state, std::int64_t e) const {
    const auto [i, j] = pairs[meeting(state, e).pair];
    if (!is_of_heavy(i, j)) return;
    const std::int32_t heavy = stage.is_heavy_to(i, j) ? i : j;
    if (volley_of[heavy] != static_cast<std::uint32_t>(e)) return;
    volley_of[heavy] = no_volley;
    const Volley& given = volleys[e];
    if (given.impacts == 0) return;
    mark_struck(state, before_impacts(stage, heavy));
    const VolleyOutcome outcome(stage, heavy, given);
    Ledger& moved = resolved[static_cast<std::int64_t>(given.place)].moved;
    moved = moved + outcome.fly_on(stage, heavy);
  }
};

}  // namespace scree::detail
