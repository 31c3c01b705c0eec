#include "sim/dynamics/impact_rounds.hpp"

#include "core/parallel.hpp"
#include "core/space_atomic.hpp"
#include "core/space_tiles.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace scree {

namespace {

using detail::FirstMeeting;
using detail::FlightBounds;
using detail::Foreseen;
using detail::ImpactProgress;
using detail::Resolved;
using detail::Volley;

SCREE_HD std::uint64_t ordered_bits(double x) { return std::bit_cast<std::uint64_t>(x + 0.0); }

constexpr std::uint32_t not_yet = ~std::uint32_t{0};
constexpr std::uint32_t no_volley = ~std::uint32_t{0};
constexpr FirstMeeting none{detail::infinite, ~std::uint64_t{0}};

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
    joined_in[k] = not_yet;
    stage.bound(static_cast<std::int32_t>(k));
    bounds.top_speed = stage.top_speed[k];
    bounds.smallest = stage.size_of(k);
    return bounds;
  }
};

struct SetHarmless {
  FlightStage stage;
  ConstView<FlightBounds> bounds;
  ImpactProgress* progress;
  SCREE_HD void operator()(std::int64_t) const {
    const double harmless = stage.harmless_speed(bounds[0].smallest, bounds[0].restitution);
    const bool nobody = 2 * bounds[0].top_speed <= harmless;
    progress->harmless = nobody ? HUGE_VAL : harmless;
  }
};

/// Lists the pairs that may meet: in the first round of all, then of the busy ones whose bodies the last
/// round has struck.
struct Suspect {
  FlightStage stage;
  ConstView<Pair> pairs;
  ConstView<std::int64_t> busy;
  ConstView<std::uint32_t> struck_in;
  std::uint32_t round;
  ImpactProgress* progress;
  View<std::int64_t> suspects;
  SCREE_HD void operator()(std::int64_t s) const {
    const double harmless = progress->harmless;
    if (harmless == HUGE_VAL) return;
    const std::int64_t k = round > 1 ? busy[s] : s;
    const auto [i, j] = pairs[k];
    if (round > 1 && struck_in[i] != round - 1 && struck_in[j] != round - 1) return;
    if (stage.top_speed[i] + stage.top_speed[j] <= harmless) return;
    ImpactLimits limits;
    if (!stage.may_meet(i, j, limits)) return;
    const auto place = static_cast<std::int64_t>(count_up(&progress->round.suspects));
    if (place < suspects.size()) suspects[place] = k;
  }
};

/// The meetings of a round, in any order.
struct MeetingList {
  FlightStage stage;
  ConstView<Pair> pairs;
  ImpactProgress* progress;
  View<Foreseen> list;
  SCREE_HD void add(const Foreseen& meeting) const {
    list[static_cast<std::int64_t>(count_up(&progress->round.meetings))] = meeting;
    const auto [i, j] = pairs[meeting.pair];
    if (stage.is_heavy_to(i, j) || stage.is_heavy_to(j, i)) count_up(&progress->round.with_heavy);
  }
};

SCREE_HD LoadedParts loads_of(ConstView<LoadedParts> loaded, std::int64_t pair) {
  return loaded.size() > 0 ? loaded[pair] : LoadedParts{};
}

struct Foresee {
  FlightStage stage;
  ConstView<Pair> pairs;
  ConstView<LoadedParts> loaded;
  ConstView<std::int64_t> suspects;
  View<std::uint32_t> joined_in;
  std::uint32_t round;
  MeetingList meetings;
  SCREE_HD void operator()(std::int64_t s) const {
    if (static_cast<std::uint64_t>(s) >= meetings.progress->round.suspects) return;
    const std::int64_t k = suspects[s];
    const auto [i, j] = pairs[k];
    const Meeting meeting = stage.next(i, j, loads_of(loaded, k));
    if (!(meeting.time <= stage.terms.step)) return;
    meetings.add({meeting.time, k, meeting.part});
    for (const std::int32_t body : {i, j}) {
      if (stage.is_free(body) && lower(&joined_in[body], round)) raise(&meetings.progress->last_join, round);
    }
  }
};

/// Lists the pairs of bodies that have joined in this round, but for those of bodies that had before.
struct ListBusy {
  ConstView<Pair> pairs;
  ConstView<std::uint32_t> joined_in;
  std::uint32_t round;
  ImpactProgress* progress;
  View<std::int64_t> busy;
  SCREE_HD void operator()(std::int64_t k) const {
    if (progress->last_join != round) return;
    const auto [i, j] = pairs[k];
    if (std::min(joined_in[i], joined_in[j]) != round) return;
    const auto place = static_cast<std::int64_t>(count_up(&progress->round.busy));
    if (place < busy.size()) busy[place] = k;
  }
};

/// Of the last round's meetings those that have stayed as they were; its first ones are no more.
struct KeepMeetings {
  ConstView<Foreseen> last;
  ConstView<Pair> pairs;
  ConstView<std::uint32_t> struck_in;
  View<FirstMeeting> first;
  std::uint32_t round;
  MeetingList meetings;
  SCREE_HD void operator()(std::int64_t e) const {
    const Foreseen& meeting = last[e];
    const auto [i, j] = pairs[meeting.pair];
    for (const std::int32_t body : {i, j}) {
      exchange(&first[body].time, none.time);
      exchange(&first[body].pair, none.pair);
    }
    if (meeting.time == HUGE_VAL || struck_in[i] == round - 1 || struck_in[j] == round - 1) return;
    meetings.add(meeting);
  }
};

/// What the steps of one round share.
struct Round {
  FlightStage stage;
  ConstView<Pair> pairs;
  View<Foreseen> meetings;
  View<FirstMeeting> first;
  View<std::uint32_t> waits_in;
  View<std::uint32_t> volley_of;
  View<Volley> volleys;  ///< by the meeting
  std::uint32_t number;

  /// Whether a meeting with the other has its turn among those of a body.
  SCREE_HD bool counts_for(std::int32_t body, std::int32_t other) const {
    return stage.is_free(body) && !stage.is_heavy_to(body, other);
  }
  /// All that are first; no two of them share a body but one that is heavy to both others.
  SCREE_HD bool is_first(const Foreseen& meeting) const {
    const auto [i, j] = pairs[meeting.pair];
    return is_first_of(i, j, meeting) && is_first_of(j, i, meeting);
  }
  /// That of a heavy body.
  SCREE_HD Volley& volley(std::int32_t heavy) const { return volleys[volley_of[heavy]]; }

 private:
  SCREE_HD bool is_first_of(std::int32_t body, std::int32_t other, const Foreseen& meeting) const {
    if (!counts_for(body, other)) return true;
    return first[body].pair == static_cast<std::uint64_t>(meeting.pair) && waits_in[body] != number;
  }
};

struct FindFirstTimes {
  Round round;
  SCREE_HD void operator()(std::int64_t e) const {
    const Foreseen& meeting = round.meetings[e];
    const auto [i, j] = round.pairs[meeting.pair];
    find(i, j, meeting);
    find(j, i, meeting);
  }

 private:
  SCREE_HD void find(std::int32_t body, std::int32_t other, const Foreseen& meeting) const {
    if (round.counts_for(body, other)) lower(&round.first[body].time, ordered_bits(meeting.time));
  }
};

/// Also gives each heavy body a volley.
struct FindFirstPairs {
  Round round;
  SCREE_HD void operator()(std::int64_t e) const {
    const Foreseen& meeting = round.meetings[e];
    const auto [i, j] = round.pairs[meeting.pair];
    find(i, j, meeting, static_cast<std::uint32_t>(e));
    find(j, i, meeting, static_cast<std::uint32_t>(e));
  }

 private:
  SCREE_HD void find(std::int32_t body, std::int32_t other, const Foreseen& meeting, std::uint32_t e) const {
    FirstMeeting& first = round.first[body];
    if (round.stage.is_heavy_to(body, other)) {
      lower(&round.volley_of[body], e);
    } else if (first.time == ordered_bits(meeting.time)) {
      lower(&first.pair, static_cast<std::uint64_t>(meeting.pair));
    }
  }
};

/// Of two bodies that could meet, the one whose first meeting is later waits for the other's, if that could
/// drive the other into it before. Of a heavy body and a lighter one the lighter waits if they are at the
/// same time: both would change the heavy one.
struct MakeWait {
  Round round;
  ConstView<std::int64_t> busy;
  SCREE_HD void operator()(std::int64_t b) const {
    const auto [i, j] = round.pairs[busy[b]];
    const std::uint64_t time_i = round.first[i].time;
    const std::uint64_t time_j = round.first[j].time;
    if (time_i == detail::infinite || time_j == detail::infinite) return;
    if (time_i < time_j || (time_i == time_j && round.stage.is_heavy_to(i, j))) {
      if (may_meet_before(i, j)) raise(&round.waits_in[j], round.number);
    } else if (time_j < time_i || round.stage.is_heavy_to(j, i)) {
      if (may_meet_before(j, i)) raise(&round.waits_in[i], round.number);
    }
  }

 private:
  /// Whether a body may meet another one between its first meeting and the other's.
  SCREE_HD bool may_meet_before(std::int32_t body, std::int32_t other) const {
    const FlightStage& stage = round.stage;
    const auto [i, j] = round.pairs[static_cast<std::int64_t>(round.first[body].pair)];
    const double from = std::bit_cast<double>(round.first[body].time);
    const double until = std::bit_cast<double>(round.first[other].time);
    const double driven =
        stage.top_speed[body] + 2 * stage.top_speed[i == body ? j : i];  // as by a moving wall
    const BodyFlight flight = stage.flight(body);
    const BodyFlight others = stage.flight(other);
    const double near = bounding_radius(flight.shape, flight.size) +
                        bounding_radius(others.shape, others.size) +
                        (driven + stage.top_speed[other]) * (until - from);
    return (others.position_at(from) - flight.position_at(from)).squaredNorm() <= near * near;
  }
};

/// The speeds that volleys have to do with.
struct ScaleVolleys {
  Round round;
  SCREE_HD void operator()(std::int64_t e) const {
    const auto [i, j] = round.pairs[round.meetings[e].pair];
    scale(i, j);
    scale(j, i);
  }

 private:
  SCREE_HD void scale(std::int32_t body, std::int32_t other) const {
    if (round.stage.is_heavy_to(body, other))
      raise(&round.volley(body).fastest, ordered_bits(round.stage.top_speed[other]));
  }
};

/// Adds up what the first meetings give to heavy bodies.
struct GatherVolleys {
  Round round;
  ConstView<LoadedParts> loaded;
  SCREE_HD void operator()(std::int64_t e) const {
    const Foreseen& meeting = round.meetings[e];
    const auto [i, j] = round.pairs[meeting.pair];
    const bool heavy_is_i = round.stage.is_heavy_to(i, j);
    if ((!heavy_is_i && !round.stage.is_heavy_to(j, i)) || !round.is_first(meeting)) return;
    SolvedImpact solved;
    if (!solve_impact(round.stage, i, j, {.time = meeting.time, .part = meeting.part},
                      loads_of(loaded, meeting.pair), solved))
      return;
    const std::int32_t heavy = heavy_is_i ? i : j;
    detail::add_to_volley(round.stage, heavy, solved, meeting.pair, round.volley(heavy));
  }
};

/// Resolves the meetings that are first.
struct ResolveFirst {
  Round round;
  ConstView<LoadedParts> loaded;
  View<std::uint32_t> struck_in;
  ImpactProgress* progress;
  View<Resolved> resolved;
  View<std::uint64_t> key;
  View<StruckBody> struck;

  SCREE_HD void operator()(std::int64_t e) const {
    Foreseen& meeting = round.meetings[e];
    if (!round.is_first(meeting)) return;
    const auto [i, j] = round.pairs[meeting.pair];
    const FlightStage& stage = round.stage;
    const StruckBody before_i = before_impacts(stage, i);
    const StruckBody before_j = before_impacts(stage, j);
    SolvedImpact solved;
    if (!solve_impact(stage, i, j, {.time = meeting.time, .part = meeting.part},
                      loads_of(loaded, meeting.pair), solved)) {
      meeting.time = HUGE_VAL;
      return;
    }
    const bool heavy_i = stage.is_heavy_to(i, j);
    const bool heavy_j = stage.is_heavy_to(j, i);
    const auto place = static_cast<std::int64_t>(count_up(&progress->impacts));
    if (heavy_i || heavy_j) {
      const std::int32_t heavy = heavy_i ? i : j;
      Volley& volley = round.volley(heavy);
      const double scale = detail::VolleyOutcome(stage, heavy, volley).scale();
      resolved[place].moved = detail::fly_on_scaled(stage, heavy, solved, scale, resolved[place].impact);
      if (volley.first_missing == ~static_cast<std::uint64_t>(meeting.pair))
        volley.place = static_cast<std::uint64_t>(place);
    } else {
      resolved[place].moved = fly_on(stage, solved, resolved[place].impact);
    }
    if (!heavy_i) mark(before_i);
    if (!heavy_j) mark(before_j);
    key[place] = static_cast<std::uint64_t>(round.number) * static_cast<std::uint64_t>(round.pairs.size()) +
                 static_cast<std::uint64_t>(meeting.pair);
    if (meeting.time > 0.5 * stage.terms.step) raise(&progress->late, 1u);
    if (std::max(heavy_i ? 0.0 : stage.weary[i], heavy_j ? 0.0 : stage.weary[j]) >= impacts_end)
      raise(&progress->hit_bound, 1u);
  }

  SCREE_HD void mark(const StruckBody& before) const {
    if (!round.stage.is_free(before.body)) return;
    if (struck_in[before.body] == 0) struck[static_cast<std::int64_t>(count_up(&progress->struck))] = before;
    struck_in[before.body] = round.number;
  }
};

/// Gives each volley to its heavy body.
struct EndVolleys {
  ResolveFirst resolve;
  SCREE_HD void operator()(std::int64_t e) const {
    const Round& round = resolve.round;
    const auto [i, j] = round.pairs[round.meetings[e].pair];
    if (!round.stage.is_heavy_to(i, j) && !round.stage.is_heavy_to(j, i)) return;
    const std::int32_t heavy = round.stage.is_heavy_to(i, j) ? i : j;
    if (round.volley_of[heavy] != static_cast<std::uint32_t>(e)) return;
    round.volley_of[heavy] = no_volley;
    const Volley& volley = round.volleys[e];
    if (volley.impacts == 0) return;
    resolve.mark(before_impacts(round.stage, heavy));
    const detail::VolleyOutcome outcome(round.stage, heavy, volley);
    Ledger& moved = resolve.resolved[static_cast<std::int64_t>(volley.place)].moved;
    moved = moved + outcome.fly_on(round.stage, heavy);
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
  View<Impact> impacts;
  SCREE_HD void operator()(std::int64_t k) const { impacts[k] = resolved[order[k]].impact; }
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
void make_room(Array<T, Space>& list, std::int64_t used, std::int64_t needed) {
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
  constexpr std::int64_t most_rounds = 1 << 16;
  log_.resize(bodies.count());
  const FlightStage stage(problem.terms, parameters, bodies, log_);
  start(stage);
  for (;;) {
    foresee(stage, problem);
    if (meetings_.empty()) break;
    if (rounds_ == most_rounds) {
      progress_.hit_bound = 1;
      break;
    }
    resolve_first(stage, problem);
  }
  struck_.resize(signed_count(progress_.struck));
  return put_in_order(problem.pairs.size());
}

template <class Space>
void ImpactRounds<Space>::start(const FlightStage& stage) {
  meetings_.resize(0);
  rounds_ = 0;
  progress_ = {};
  joined_in_.resize(stage.bodies.count());
  shared_progress_.resize(1);
  ImpactProgress* progress = shared_progress_.data();
  copy_bytes<Space, Host>(progress, &progress_, sizeof(progress_));
  bounds_.resize(1);
  parallel::sum_into<FlightBounds, Space>(
      "impact.start", std::max(stage.bodies.count(), stage.terms.laws.table.size()),
      StartFlight{stage, joined_in_.view()}, bounds_scratch_, bounds_.data());
  parallel::for_each<Space>("impact.start", 1, SetHarmless{stage, std::as_const(bounds_).view(), progress});
}

/// Lists the meetings of the next round.
template <class Space>
void ImpactRounds<Space>::foresee(const FlightStage& stage, const Problem& problem) {
  const auto round = static_cast<std::uint32_t>(rounds_ + 1);
  const ConstView<Pair> pairs = problem.pairs;
  const ConstView<std::uint32_t> struck_in = struck_in_.view();
  ImpactProgress* progress = shared_progress_.data();
  const std::int64_t busy = signed_count(progress_.round.busy);
  const detail::RoundCounts start{.busy = progress_.round.busy};
  make_room(suspects_, 0, least_room);
  make_room(busy_, busy, least_room);
  last_.swap(meetings_);
  for (bool fits = false; !fits;) {
    const std::int64_t room = suspects_.size();
    meetings_.resize(room + last_.size());
    const MeetingList meetings{stage, pairs, progress, meetings_.view()};
    copy_bytes<Space, Host>(&progress->round, &start, sizeof(start));
    parallel::for_each<Space>("impact.keep", last_.size(),
                              KeepMeetings{last_.view(), pairs, struck_in, first_.view(), round, meetings});
    parallel::for_each<Space>(
        "impact.suspect", rounds_ > 0 ? busy : pairs.size(),
        Suspect{stage, pairs, busy_.view(), struck_in, round, progress, suspects_.view()});
    // As many as there is room for: how many there are is read once, with what comes of them.
    parallel::for_each<Space>(
        "impact.foresee", room,
        Foresee{stage, pairs, problem.loaded, suspects_.view(), joined_in_.view(), round, meetings});
    parallel::for_each<Space>("impact.busy", pairs.size(),
                              ListBusy{pairs, joined_in_.view(), round, progress, busy_.view()});
    copy_bytes<Host, Space>(&progress_, progress, sizeof(progress_));
    const std::int64_t suspects = signed_count(progress_.round.suspects);
    const std::int64_t now_busy = signed_count(progress_.round.busy);
    fits = suspects <= room && now_busy <= busy_.size();
    make_room(suspects_, 0, suspects);
    make_room(busy_, busy, now_busy);
  }
  meetings_.resize(signed_count(progress_.round.meetings));
}

template <class Space>
void ImpactRounds<Space>::resolve_first(const FlightStage& stage, const Problem& problem) {
  const std::int64_t n = stage.bodies.count();
  if (++rounds_ == 1) {
    struck_in_.resize(n);
    waits_in_.resize(n);
    first_.resize(n);
    parallel::fill("impact.reset", struck_in_, std::uint32_t{0});
    parallel::fill("impact.reset", waits_in_, std::uint32_t{0});
    volley_of_.resize(n);
    parallel::fill("impact.reset", volley_of_, no_volley);
    parallel::fill("impact.reset", first_, none);
  }
  const std::int64_t count = meetings_.size();
  const std::int64_t impacts = signed_count(progress_.impacts);
  const std::int64_t struck = signed_count(progress_.struck);
  make_room(resolved_, impacts, impacts + count);
  make_room(key_, impacts, impacts + count);
  make_room(struck_, struck, struck + 2 * count);
  const bool any_heavy = progress_.round.with_heavy > 0;
  if (any_heavy) {
    volleys_.resize(count);
    parallel::fill("impact.reset", volleys_, Volley{});
  }
  const Round round{.stage = stage,
                    .pairs = problem.pairs,
                    .meetings = meetings_.view(),
                    .first = first_.view(),
                    .waits_in = waits_in_.view(),
                    .volley_of = volley_of_.view(),
                    .volleys = volleys_.view(),
                    .number = static_cast<std::uint32_t>(rounds_)};
  const ResolveFirst resolve{
      round,       problem.loaded, struck_in_.view(), shared_progress_.data(), resolved_.view(),
      key_.view(), struck_.view()};
  parallel::for_each<Space>("impact.times", count, FindFirstTimes{round});
  parallel::for_each<Space>("impact.pairs", count, FindFirstPairs{round});
  parallel::for_each<Space>("impact.wait", signed_count(progress_.round.busy), MakeWait{round, busy_.view()});
  if (any_heavy) {
    parallel::for_each<Space>("impact.volley", count, ScaleVolleys{round});
    parallel::for_each<Space>("impact.volley", count, GatherVolleys{round, problem.loaded});
  }
  parallel::for_each<Space>("impact.resolve", count, resolve);
  if (any_heavy) parallel::for_each<Space>("impact.volley", count, EndVolleys{resolve});
}

/// Returns the sum of what the impacts moved.
template <class Space>
Ledger ImpactRounds<Space>::put_in_order(std::int64_t pairs) {
  const std::int64_t n = signed_count(progress_.impacts);
  impacts_.resize(n);
  if (n == 0) return {};
  key_.resize(n);
  order_.resize(n);
  parallel::for_each<Space>("impact.order", n, CountOff{order_.view()});
  parallel::sort_by_key("impact.order", key_, order_,
                        std::bit_width(static_cast<std::uint64_t>((rounds_ + 1) * pairs)));
  const ConstView<std::int64_t> order = order_.view();
  parallel::for_each<Space>("impact.order", n, PutInOrder{order, resolved_.view(), impacts_.view()});
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
