// All impacts of a flight in a space: in rounds, all at once in each that are the first in their
// neighbourhood.
#pragma once

#include "core/array.hpp"
#include "sim/impacts/adjacency.hpp"
#include "sim/impacts/impact_program.hpp"
#include "sim/observe/observation.hpp"

#include <cmath>
#include <cstdint>

namespace scree {

namespace detail {

/// What all bodies and laws stay within.
struct FlightBounds {
  double top_speed = 0;        ///< the largest of the bodies' (m/s)
  double smallest = HUGE_VAL;  ///< of their sizes (m)
  double restitution = 0;      ///< the largest of the laws'
  bool needs_search = false;   ///< one of them does (FlightStage::needs_search)
  SCREE_HD friend FlightBounds operator+(const FlightBounds& a, const FlightBounds& b) {
    return {fmax(a.top_speed, b.top_speed), fmin(a.smallest, b.smallest), fmax(a.restitution, b.restitution),
            a.needs_search || b.needs_search};
  }
};

}  // namespace detail

/// An impact is the meeting of a pair that was not loaded before, bounces, and closes faster than the
/// threshold; or of any pair whose approach would go on for more than tolerance::deep_approach by the end of
/// the substep: the response, which sees the midpoint alone, could not tell which way to part them. A body in
/// flight is, at the time s into the substep, at
///   x(s) = x_mid + (s - step/2) v + g s^2 / 2,
/// and turns freely; after an impact its midpoint is that from which its new velocity leads through the
/// impact. So flight, bounce and energy are exact whatever the step (docs/method.md). The bodies are at the
/// midpoint, with their velocities before gravity's kick. Chains run on until nothing meets; a body that has
/// had its bound of impacts takes e = 0.
///
/// In each round a meeting is resolved if no other of its two bodies is earlier, nor any that could drive a
/// body into these before: what comes later in one place waits for what is earlier there, while places apart
/// do not wait for each other. A chain that would run through two bodies and reach a third before its own
/// meeting comes too late for that, and strikes it right after. Bodies that are not free change nothing, and
/// nobody waits for them. A heavy body is struck by many light ones in one round, and between light ones it
/// is as one that is not free. Results do not depend on the threads.
template <class Space>
class ImpactRounds {
 public:
  /// What may meet, and how, in one flight.
  struct Problem {
    ConstView<Pair> pairs;          ///< candidates, among which are all that may meet; each has a free body
    ConstView<LoadedParts> loaded;  ///< of each pair; empty: none
    FlightTerms terms;
    bool one_by_one = false;      ///< strictly in the order of their times, whatever that costs
    std::int64_t pairs_made = 0;  ///< the same number: the same pairs of the same bodies; 0: unknown
  };

  /// False if all are too slow for one in the flight, wherever they are.
  bool any_may_meet(const FlightTerms& terms, const ResponseParameters& parameters, BodyView bodies);
  /// Finds and resolves the impacts of the flight. Returns what they moved. All views are of the space.
  Ledger resolve(const Problem& problem, const ResponseParameters& parameters, BodyView bodies);
  /// Puts the bodies back to where they were before the last resolve().
  void undo(BodyView bodies);

  /// Of the last resolve(), between bodies by their numbers: round by round, in each in the order of the
  /// pairs, so that those of one body are in the order of their times.
  ConstView<Impact> impacts() const { return impacts_.view(); }
  /// The bodies that have had one, as they were before it, in any order.
  ConstView<StruckBody> struck() const { return struck_.view(); }
  /// Whether one of them had it after the midpoint.
  bool any_late_impact() const { return progress_.late_impact != 0; }
  /// Whether a body, or the rounds, have had their bound.
  bool hit_bound() const { return progress_.hit_bound != 0; }
  std::int64_t rounds() const { return rounds_; }

  /// The bodies after resolve(), for flight_of_contact() and shift_after_late_impact().
  FlightStage stage(const FlightTerms& terms, const ResponseParameters& parameters, const BodyView& bodies) {
    return {terms, parameters, bodies, log_};
  }

 private:
  void start(const FlightStage& stage);
  detail::ImpactProgram program(const FlightStage& stage, const Problem& problem);
  /// Lists the pairs that may meet, as far as there is room.
  void list_near(const FlightStage& stage, const Problem& problem);
  /// For rounds that have halted for want of it.
  void make_room(const FlightStage& stage, const Problem& problem, detail::RoundsState& state);
  Ledger put_in_order(std::int64_t pairs, ConstView<BodyNumber> number);

  FlightLog<Space> log_;
  detail::ImpactProgress progress_;                       ///< as the host last saw it
  Array<detail::ImpactProgress, Space> shared_progress_;  // one
  Array<detail::FlightBounds, Space> bounds_, bounds_scratch_;
  std::int64_t rounds_ = 0;
  // As in detail::ImpactProgram:
  Array<std::uint64_t, Space> first_[2];
  Array<std::uint32_t, Space> struck_in_, waits_in_, impact_group_of_, walls_of_;
  Array<std::int64_t, Space> near_, to_search_;
  Array<detail::PredictedMeeting, Space> meetings_[2];
  Array<detail::ImpactGroup, Space> impact_groups_;
  Array<detail::Resolved, Space> resolved_;
  Array<std::uint64_t, Space> key_;
  Array<StruckBody, Space> struck_;
  Array<detail::StruckPairs, Space> chunks_;
  Adjacency<Space> adjacency_;
  std::int64_t adjacency_of_ = 0;  // Problem::pairs_made
  // In order:
  Array<std::int64_t, Space> order_;
  Array<Impact, Space> impacts_;
};

}  // namespace scree
