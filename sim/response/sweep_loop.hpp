// The two loops of a substep over all contacts, colour by colour, as programs of phases
// (core/space_phases.hpp): sweeps until the impulses have converged, and the position correction.
#pragma once

#include "core/space_phases.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/rolling_visits.hpp"
#include "sim/contacts/slots.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/contacts/visit_kernels.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/response/hubs.hpp"

#include <algorithm>
#include <cstdint>
#include <type_traits>

namespace scree::solver {

/// The phases of a sweep over the contacts of one kind: one for each colour.
struct ColorPhases {
  int count = 0;
  int width;                         ///< contacts in one visit
  std::int32_t begin[most_colors];   ///< first contact of each colour
  std::int32_t visits[most_colors];  ///< number of visits for each colour

  ColorPhases(const ColorRanges& colors, int contacts_of_visit)
      : count(colors.colors()), width(contacts_of_visit) {
    for (std::size_t k = 0; k < colors.count.size(); ++k) {
      begin[k] = static_cast<std::int32_t>(colors.begin[k]);
      visits[k] = static_cast<std::int32_t>((colors.count[k] + width - 1) / width);
    }
  }
  SCREE_HD std::int64_t items(int color) const { return visits[color]; }
  SCREE_HD std::int64_t place(int color, std::int64_t item) const { return begin[color] + item * width; }
  std::int64_t most_items() const {
    std::int64_t most = 0;
    for (int c = 0; c < count; ++c) most = std::max(most, items(c));
    return most;
  }
};

/// One item of a phase, on which one thread works.
template <class Number>
struct OneItem {
  using Real = Number;
  std::int64_t item;

  template <class Visit, class... More>
  SCREE_HD auto visit(const ColorPhases& colors, int color, const Visit& visit, More... more) const {
    return visit.template visit<Scalar<Real>>(colors.place(color, item), more...);
  }
  template <class Visit>
  SCREE_HD Overlaps part(const ColorPhases& colors, int color, const Visit& visit, Real beta) const {
    return Overlaps::of_gap(static_cast<float>(this->visit(colors, color, visit, beta)));
  }
  SCREE_HD void accelerate(const Accelerate<Real>& bodies, Real beta) const { bodies.visit(item, beta); }
  template <class F>
  SCREE_HD void each(const F& f) const {
    f(item);
  }
};

/// A range of items of a phase, on which one thread of Host works.
template <class Number>
struct RunOfItems {
  using Real = Number;
  std::int64_t begin, end;

  template <class Visit, class... More>
  auto visit(const ColorPhases& colors, int color, const Visit& visit, More... more) const {
    return kernels()(visit, Blocks{colors.place(color, begin), end - begin}, more...);
  }
  template <class Visit>
  Overlaps part(const ColorPhases& colors, int color, const Visit& visit, Real beta) const {
    return this->visit(colors, color, visit, beta);
  }
  void accelerate(const Accelerate<Real>& bodies, Real beta) const {
    kernels().accelerate(bodies, begin, end, beta);
  }
  template <class F>
  void each(const F& f) const {
    for (std::int64_t k = begin; k < end; ++k) f(k);
  }

 private:
  static const VisitKernels<Real>& kernels() { return contact_kernels().template visits<Real>(); }
};

/// Holds bodies of the solver that move along one axis alone to that axis, since the visits to contacts treat
/// them as free. This is the last phase of each pass, if there are such bodies.
template <class Record>
struct HoldToGuides {
  ConstView<Guide> guides;  ///< Guide::body is a body of the solver
  Record* bodies;

  SCREE_HD int phases() const { return guides.size() > 0 && bodies != nullptr ? 1 : 0; }
  SCREE_HD void operator()(std::int64_t g) const {
    using Real = decltype(Record::inverse_mass);
    Record& body = bodies[guides[g].body];
    Vec3 along = vec3(body.velocity);
    guides[g].hold(along);
    body.velocity = v3<Real>(along);
  }
};

/// Rounds a ratio to a multiple of 1/1024. Sums whose terms are added in another order (on another GPU, or
/// with bodies at other places) differ in their last digits; ratios rounded from them do not, except one in
/// about 1e12. Ratios of small integers, which symmetric heaps have, are far from the steps of the
/// rounding.
SCREE_HD inline double rounded(double ratio) {
  constexpr double levels = 1024;
  constexpr double leap = 0.618;
  return fmin(floor(levels * ratio + leap), levels - 1) / levels;
}

/// Finds the impulses. The first pass applies the warm-start impulses to the bodies. Each other pass is a
/// sweep with these phases: the bodies repeat their last change times beta (momentum), the contacts of each
/// colour are visited, then the couples of each colour if anything rolls, the parts of hubs get equal
/// velocities, and bodies in guides are held to their axes. `only_balls` says that there are no contacts of
/// other bodies, whose code needs many registers.
template <class Real, bool only_balls>
struct ImpulsePhases {
  using State = SweepState;
  using Sum = SweepChange;
  /// Threads mostly wait for memory, so many contacts must be loaded at the same time.
  static constexpr int threads = only_balls ? 512 : 256;
  static constexpr int blocks_at_once = only_balls && std::is_same_v<Real, float> ? 2 : 1;

  ColorPhases ball_colors, point_colors;
  BallContacts<Real> balls;
  PointContacts<Real> points;
  bool rolls;
  RollingFields<Real> ball_rolling, point_rolling;
  BodyRecord<Real>* bodies;
  BodyRecord<Real>* last;
  std::int64_t body_count;
  JoinHubs<BodyRecord<Real>> hubs;
  HoldToGuides<BodyRecord<Real>> guides;
  int least, most, block_sweeps;
  double tolerance;
  int first_with_momentum;  ///< first sweep with momentum, counted from 0

  SCREE_HD bool goes_on(const State& state) const {
    return state.pushed && state.sweeps >= first_with_momentum;
  }
  SCREE_HD int phases(const State& state) const {
    if (state.pushed && (state.converged || state.sweeps >= most)) return 0;
    return (goes_on(state) ? 1 : 0) + (rolls ? 2 : 1) * (ball_colors.count + point_colors.count) +
           hubs.phases() + guides.phases();
  }
  SCREE_HD std::int64_t items(const State& state, int phase) const {
    if (goes_on(state) && phase-- == 0) return body_count;
    if (phase < ball_colors.count) return ball_colors.items(phase);
    phase -= ball_colors.count;
    if (phase < point_colors.count) return point_colors.items(phase);
    phase -= point_colors.count;
    if (rolls) {
      if (phase < ball_colors.count) return ball_colors.items(phase);
      phase -= ball_colors.count;
      if (phase < point_colors.count) return point_colors.items(phase);
      phase -= point_colors.count;
    }
    return phase < hubs.phases() ? hubs.items(phase) : guides.guides.size();
  }
  std::int64_t most_items() const {
    return std::max({body_count, ball_colors.most_items(), point_colors.most_items()});
  }
  SCREE_HD Sum operator()(const State& state, int phase, std::int64_t item) const {
    return work(state, phase, OneItem<Real>{item});
  }
  Sum over(const State& state, int phase, std::int64_t begin, std::int64_t end) const {
    return work(state, phase, RunOfItems<Real>{begin, end});
  }
  /// Decides after a sweep whether the impulses have converged, and finds the beta of the next sweep.
  SCREE_HD State judge(State state, const Sum& change) const {
    if (!state.pushed) {
      state.pushed = true;
      return state;
    }
    const bool remembered = goes_on(state);
    ++state.sweeps;
    state.converged = state.sweeps >= least && change.step <= tolerance * tolerance * change.size;
    const double ratio = remembered && state.sweeps > 1 ? change.step / state.last_step : 0.0;
    state.beta = ratio < 1.0 ? rounded(ratio) : 0.0;
    state.last_step = change.step;
    return state;
  }

 private:
  SCREE_CALLS_ITS_ARGUMENTS
  template <class Items>
  SCREE_HD Sum work(const State& state, int phase, const Items& items) const {
    const auto beta = static_cast<Real>(state.beta);
    const bool remembers = goes_on(state);
    if (remembers && phase-- == 0) {
      items.accelerate(Accelerate<Real>{bodies, last}, beta);
      return {};
    }
    if (phase < ball_colors.count) {
      if (state.pushed)
        return items.visit(ball_colors, phase, SweepBalls<Real>{balls, bodies, remembers}, beta);
      items.visit(ball_colors, phase, PushBalls<Real>{balls, bodies});
      return {};
    }
    phase -= ball_colors.count;
    if constexpr (!only_balls) {
      if (phase < point_colors.count) {
        if (state.pushed)
          return items.visit(point_colors, phase, SweepPoints<Real>{points, bodies, block_sweeps}, beta);
        items.visit(point_colors, phase, PushPoints<Real>{points, bodies});
        return {};
      }
    }
    phase -= point_colors.count;
    if (rolls) {
      if (phase < ball_colors.count)
        return roll(state, phase, ball_colors, balls, ball_rolling, TurnBalls{}, items);
      phase -= ball_colors.count;
      if constexpr (!only_balls) {
        if (phase < point_colors.count)
          return roll(state, phase, point_colors, points, point_rolling, TurnPoints{}, items);
      }
      phase -= point_colors.count;
    }
    items.each([&](std::int64_t item) {
      if (phase < hubs.phases()) {
        hubs(phase, item);
      } else {
        guides(item);
      }
    });
    return {};
  }
  SCREE_CALLS_ITS_ARGUMENTS
  template <class Contacts, class Turn, class Items>
  SCREE_HD Sum roll(const State& state, int color, const ColorPhases& colors, const Contacts& contacts,
                    const RollingFields<Real>& rolling, const Turn&, const Items& items) const {
    if (state.pushed)
      return items.visit(colors, color, Roll<Real, Contacts, Turn>{contacts, rolling, bodies, goes_on(state)},
                         static_cast<Real>(state.beta));
    items.visit(colors, color, PushRolling<Real, Contacts, Turn>{contacts, rolling, bodies});
    return {};
  }
};

struct CorrectionState {
  std::int32_t sweeps = 0;
  bool corrected = false;
  double first = 0;   ///< mean of the overlaps that the first sweep has found, relative to the cap
  double sum = 0;     ///< the same of the last sweep
  double beta = 0;    ///< factor by which the next sweep extrapolates the last change, rounded
  float deepest = 0;  ///< deepest overlap when judge() last checked how fast it falls
};

/// Corrects positions: finds displacements and turns of the bodies that move overlapping bodies apart. They
/// start from zero. Sweeps have momentum as in ImpulsePhases, but beta is the ratio of the sums of the
/// overlaps that two sweeps have found.
template <class Real, bool only_balls>
struct CorrectionPhases {
  using State = CorrectionState;
  using Sum = Overlaps;
  static constexpr int threads = only_balls ? 512 : 256;
  static constexpr int blocks_at_once = only_balls ? 2 : 1;

  ColorPhases ball_colors, point_colors;
  BallContacts<Real> balls;
  PointContacts<Real> points;
  Displacements<Real> displacements;
  Displacements<Real> turns;  ///< not used if all contacts are of balls
  std::int64_t body_count;
  JoinHubs<CentreRecord<Real>> shifted_hubs, turned_hubs;
  HoldToGuides<CentreRecord<Real>> guides;
  Real share;
  int first_with_momentum;        ///< first sweep with momentum, counted from 0
  int least, usual, most;         ///< numbers of sweeps of the CorrectionPlan
  float deepest, mean, too_deep;  ///< overlaps of the CorrectionPlan, relative to the cap

  SCREE_HD bool goes_on(const State& state) const { return state.sweeps >= first_with_momentum; }
  SCREE_HD int phases(const State& state) const {
    if (state.corrected || state.sweeps >= most) return 0;
    return (goes_on(state) ? 1 : 0) + ball_colors.count + point_colors.count + shifted_hubs.phases() +
           turned_hubs.phases() + guides.phases();
  }
  SCREE_HD std::int64_t items(const State& state, int phase) const {
    if (goes_on(state) && phase-- == 0) return body_count;
    if (phase < ball_colors.count) return ball_colors.items(phase);
    phase -= ball_colors.count;
    if (phase < point_colors.count) return point_colors.items(phase);
    phase -= point_colors.count;
    if (phase < shifted_hubs.phases()) return shifted_hubs.items(phase);
    phase -= shifted_hubs.phases();
    return phase < turned_hubs.phases() ? turned_hubs.items(phase) : guides.guides.size();
  }
  std::int64_t most_items() const {
    return std::max({body_count, ball_colors.most_items(), point_colors.most_items()});
  }
  SCREE_HD Sum operator()(const State& state, int phase, std::int64_t item) const {
    return work(state, phase, OneItem<Real>{item});
  }
  Sum over(const State& state, int phase, std::int64_t begin, std::int64_t end) const {
    return work(state, phase, RunOfItems<Real>{begin, end});
  }
  SCREE_HD State judge(const State& state, const Sum& seen) const {
    const int sweeps = state.sweeps + 1;
    const bool is_small_mean = seen.sum <= static_cast<double>(mean) * seen.count;
    const bool are_small = sweeps >= least && seen.deepest <= deepest && is_small_mean;
    const bool checks = sweeps % sweeps_between_checks == 0;
    // The deepest of many small overlaps that hardly changes, as with a wedged body, would be too deep after
    // the last sweep as well.
    const bool is_stuck =
        checks && is_small_mean && fabsf(seen.deepest - state.deepest) < hardly * seen.deepest;
    const double ratio = goes_on(state) && state.sweeps > 0 ? seen.sum / state.sum : 0.0;
    return {.sweeps = sweeps,
            .corrected = are_small || (sweeps >= usual && (seen.deepest <= too_deep || is_stuck)),
            .first = state.sweeps == 0 ? seen.sum / fmax(seen.count, 1.0) : state.first,
            .sum = seen.sum,
            .beta = ratio < 1.0 ? rounded(ratio) : 0.0,
            .deepest = checks ? seen.deepest : state.deepest};
  }

 private:
  static constexpr int sweeps_between_checks =
      4;  // sweeps between two checks of how fast the deepest overlap falls
  // Share by which the deepest overlap has to change between two checks. Larger: fewer sweeps for the sake of
  // a few contacts, which stay deeper.
  static constexpr float hardly = 0.01f;

  SCREE_CALLS_ITS_ARGUMENTS
  template <class Items>
  SCREE_HD Sum work(const State& state, int phase, const Items& items) const {
    const auto beta = static_cast<Real>(state.beta);
    const bool remembers = goes_on(state);
    if (remembers && phase-- == 0) {
      items.each([&](std::int64_t k) {
        displacements.extrapolate(k, beta);
        if constexpr (!only_balls) turns.extrapolate(k, beta);
      });
      return {};
    }
    if (phase < ball_colors.count)
      return items.part(ball_colors, phase, CorrectBalls<Real>{balls, displacements.now, share, remembers},
                        beta);
    phase -= ball_colors.count;
    if constexpr (!only_balls) {
      if (phase < point_colors.count)
        return items.part(point_colors, phase,
                          CorrectPoints<Real>{points, displacements.now, turns.now, share, remembers}, beta);
    }
    phase -= point_colors.count;
    items.each([&](std::int64_t item) {
      if (phase < shifted_hubs.phases()) {
        shifted_hubs(phase, item);
      } else if (phase - shifted_hubs.phases() < turned_hubs.phases()) {
        turned_hubs(phase - shifted_hubs.phases(), item);
      } else {
        guides(item);
      }
    });
    return {};
  }
};

}  // namespace scree::solver
