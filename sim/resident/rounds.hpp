// The rounds of a substep: sweeps over all contacts, colour by colour, until their impulses have converged,
// and until nothing overlaps (core/space_rounds.hpp).
#pragma once

#include "sim/resident/contact_list.hpp"
#include "sim/resident/hubs.hpp"
#include "sim/resident/layout.hpp"
#include "sim/resident/rolling.hpp"
#include "sim/resident/slots.hpp"
#include "sim/resident/sweeps.hpp"

#include <algorithm>
#include <cstdint>
#include <type_traits>

namespace scree::resident {

/// The colours of one kind of contacts as phases.
struct ColorPhases {
  std::int64_t begin[most_colors + 1];
  int count = 0;
  ConstView<std::int32_t> places;

  template <class Space>
  explicit ColorPhases(const ContactList<Space>& list)
      : count(static_cast<int>(list.begin().size()) - 1), places(list.places()) {
    std::ranges::copy(list.begin(), begin);
  }
  SCREE_HD std::int64_t items(int color) const { return begin[color + 1] - begin[color]; }
  SCREE_HD std::int64_t place(int color, std::int64_t item) const { return places[begin[color] + item]; }
  std::int64_t most_items() const {
    std::int64_t most = 0;
    for (int c = 0; c < count; ++c) most = std::max(most, items(c));
    return most;
  }
};

/// Finds impulses. The first round gives the bodies what their contacts remember, each other one is a sweep:
/// the bodies go on by beta (with momentum), then each colour, then the couples of each colour if anything
/// rolls, then the parts of hubs agree.
/// only_balls: there are no other contacts, whose laws ask for many registers.
template <class Real, bool only_balls>
struct ImpulseRounds {
  using State = SweepState;
  using Sum = SweepChange<Real>;
  /// Memory is waited for: many contacts must be on their way.
  static constexpr int threads = only_balls ? 512 : 256;
  static constexpr int blocks_at_once = only_balls && std::is_same_v<Real, float> ? 2 : 1;

  ColorPhases ball_colors, point_colors;
  BallContacts<Real> balls;
  PointContacts<Real> points;
  bool rolls;
  RollingFields<Real> ball_rolling, point_rolling;
  const InertiaRecord<Real>* inertia;
  BodyRecord<Real>* bodies;
  BodyRecord<Real>* last;
  std::int64_t body_count;
  JoinHubs<BodyRecord<Real>> hubs;
  int least, most, block_sweeps;
  double tolerance;
  bool momentum;

  SCREE_HD bool goes_on(const State& state) const { return state.pushed && momentum; }
  SCREE_HD int phases(const State& state) const {
    if (state.converged || state.sweeps >= most) return 0;
    return (goes_on(state) ? 1 : 0) + (rolls ? 2 : 1) * (ball_colors.count + point_colors.count) +
           hubs.phases();
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
    return hubs.items(phase);
  }
  std::int64_t most_items() const {
    return std::max({body_count, ball_colors.most_items(), point_colors.most_items()});
  }
  SCREE_HD Sum operator()(const State& state, int phase, std::int64_t item) const {
    const auto beta = static_cast<Real>(state.beta);
    if (goes_on(state) && phase-- == 0) {
      Accelerate<Real>{bodies, last}(item, beta);
      return {};
    }
    if (phase < ball_colors.count) {
      const std::int64_t c = ball_colors.place(phase, item);
      if (state.pushed) return SweepBalls<Real>{balls, bodies, momentum}(c, beta);
      PushBalls<Real>{balls, bodies}(c);
      return {};
    }
    phase -= ball_colors.count;
    if constexpr (!only_balls) {
      if (phase < point_colors.count) {
        const std::int64_t c = point_colors.place(phase, item);
        if (state.pushed) return SweepPoints<Real>{points, inertia, bodies, block_sweeps}(c, beta);
        PushPoints<Real>{points, inertia, bodies}(c);
        return {};
      }
    }
    phase -= point_colors.count;
    if (rolls) {
      if (phase < ball_colors.count)
        return roll(
            Roll<Real, BallContacts<Real>, TurnBalls<Real>>{balls, ball_rolling, {}, bodies, momentum}, state,
            ball_colors.place(phase, item));
      phase -= ball_colors.count;
      if constexpr (!only_balls) {
        if (phase < point_colors.count)
          return roll(
              Roll<Real, PointContacts<Real>, TurnPoints<Real>>{
                  points, point_rolling, {inertia}, bodies, true},
              state, point_colors.place(phase, item));
      }
      phase -= point_colors.count;
    }
    hubs(phase, item);
    return {};
  }
  template <class Roll>
  SCREE_HD static Sum roll(const Roll& contacts, const State& state, std::int64_t c) {
    if (state.pushed) return contacts.sweep(c, static_cast<Real>(state.beta));
    contacts.push(c);
    return {};
  }
  /// After a sweep: have the impulses converged, and by how much does the next one go on (Sweeps).
  SCREE_HD State judge(State state, const Sum& change) const {
    if (!state.pushed) {
      state.pushed = true;
      return state;
    }
    ++state.sweeps;
    const auto step = static_cast<double>(change.step);
    state.converged =
        state.sweeps >= least && step <= tolerance * tolerance * static_cast<double>(change.size);
    const double ratio = goes_on(state) && state.sweeps > 1 ? step / state.last_step : 0.0;
    state.beta = ratio < 1.0 ? ratio : 0.0;
    state.last_step = step;
    return state;
  }
};

struct PartingState {
  std::int32_t sweeps = 0;
  bool corrected = false;
};

/// Parts what overlaps, as the position correction of Host: displacements and turns of bodies that start
/// where they are.
template <class Real, bool only_balls>
struct PartingRounds {
  using State = PartingState;
  using Sum = Overlaps;
  static constexpr int threads = only_balls ? 512 : 256;
  static constexpr int blocks_at_once = only_balls ? 2 : 1;

  ColorPhases ball_colors, point_colors;
  BallContacts<Real> balls;
  PointContacts<Real> points;
  const InertiaRecord<Real>* inertia;
  CentreRecord<Real>* displacement;
  CentreRecord<Real>* turn;  ///< none if all contacts are of balls
  JoinHubs<CentreRecord<Real>> shifted_hubs, turned_hubs;
  Real share;
  int least, most;
  float deepest, mean;  ///< that are left (of the cap)

  SCREE_HD int phases(const State& state) const {
    if (state.corrected || state.sweeps >= most) return 0;
    return ball_colors.count + point_colors.count + shifted_hubs.phases() + turned_hubs.phases();
  }
  SCREE_HD std::int64_t items(const State&, int phase) const {
    if (phase < ball_colors.count) return ball_colors.items(phase);
    phase -= ball_colors.count;
    if (phase < point_colors.count) return point_colors.items(phase);
    phase -= point_colors.count;
    if (phase < shifted_hubs.phases()) return shifted_hubs.items(phase);
    return turned_hubs.items(phase - shifted_hubs.phases());
  }
  std::int64_t most_items() const { return std::max(ball_colors.most_items(), point_colors.most_items()); }
  SCREE_HD Sum operator()(const State&, int phase, std::int64_t item) const {
    if (phase < ball_colors.count)
      return PartBalls<Real>{balls, displacement, share}(ball_colors.place(phase, item));
    phase -= ball_colors.count;
    if constexpr (!only_balls) {
      if (phase < point_colors.count)
        return PartPoints<Real>{points, inertia, displacement, turn, share}(point_colors.place(phase, item));
    }
    phase -= point_colors.count;
    if (phase < shifted_hubs.phases()) {
      shifted_hubs(phase, item);
    } else {
      turned_hubs(phase - shifted_hubs.phases(), item);
    }
    return {};
  }
  SCREE_HD State judge(const State& state, const Sum& seen) const {
    const int sweeps = state.sweeps + 1;
    return {sweeps, sweeps >= least && seen.deepest <= deepest && seen.sum <= mean * seen.count};
  }
};

}  // namespace scree::resident
