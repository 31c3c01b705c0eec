// The resolution of all impacts of a flight in one space. It works in rounds, each of which resolves all
// impacts that are the first in their neighbourhood.
#pragma once

#include "core/array.hpp"
#include "sim/impacts/adjacency.hpp"
#include "sim/impacts/impact_program.hpp"
#include "sim/observe/observation.hpp"

#include <cmath>
#include <cstdint>

namespace scree {

namespace detail {

/// Bounds on all bodies and laws.
struct FlightBounds {
  double top_speed = 0;        ///< largest top speed of the bodies (m/s)
  double smallest = HUGE_VAL;  ///< smallest FlightStage::size_of() of the bodies (m)
  double restitution = 0;      ///< largest restitution of the laws
  bool needs_search = false;   ///< whether any body needs a search (FlightStage::needs_search)
  SCREE_HD friend FlightBounds operator+(const FlightBounds& a, const FlightBounds& b) {
    return {fmax(a.top_speed, b.top_speed), fmin(a.smallest, b.smallest), fmax(a.restitution, b.restitution),
            a.needs_search || b.needs_search};
  }
};

}  // namespace detail

/// Finds and resolves all impacts of a flight. An impact is the meeting of a pair that was not loaded before,
/// bounces, and closes faster than the threshold; or of any pair whose approach would go on for more than
/// tolerance::deep_approach by the end of the substep: the response, which only knows the midpoint, could not
/// tell in which direction to separate such a pair. A body in flight is, at the time s into the substep, at
///   x(s) = x_mid + (s - step/2) v + g s^2 / 2,
/// and turns freely; after an impact its midpoint is the one from which its new velocity leads through the
/// impact. So flight, bounce and energy are exact whatever the step (docs/method.md). The bodies are at the
/// midpoint, with their velocities before gravity's kick. Chains of impacts run on until nothing meets; a
/// body that has used up its budget for bounces takes e = 0.
///
/// In each round a meeting is resolved if neither of its two bodies has an earlier one, and if no earlier
/// meeting could drive another body into one of them before. So a later meeting waits for an earlier one in
/// the same place, and meetings in places apart do not wait for each other. A chain that would run through
/// two bodies and reach a third one before that body's own meeting is found too late for that, and strikes
/// the third body right after its meeting. Bodies that are not free do not change, and no meeting waits for
/// them. A heavy body is struck by many light ones in one round, and between light ones it counts like a body
/// that is not free. Results do not depend on the threads.
template <class Space>
class ImpactRounds {
 public:
  /// The pairs that may meet in one flight, and the terms of the flight.
  struct Problem {
    ConstView<Pair> pairs;          ///< candidates, among which are all that may meet; each has a free body
    ConstView<LoadedParts> loaded;  ///< loaded parts of each pair; empty: none
    FlightTerms terms;
    bool one_by_one = false;      ///< resolve strictly in the order of the times, whatever that costs
    std::int64_t pairs_made = 0;  ///< equal numbers mean the same pairs of the same bodies; 0: unknown
  };

  /// Returns false if all bodies are too slow for an impact in the flight, wherever they are.
  bool any_may_meet(const FlightTerms& terms, const ResponseParameters& parameters, BodyView bodies);
  /// Finds and resolves the impacts of the flight. Returns the ledger of what they moved. All views are of
  /// Space.
  Ledger resolve(const Problem& problem, const ResponseParameters& parameters, BodyView bodies);
  /// Puts the bodies back to where they were before the last resolve().
  void undo(BodyView bodies);

  /// Returns the impacts of the last resolve(), with bodies by their numbers. They are in the order of the
  /// rounds, and within a round in that of the pairs, so that the impacts of one body are in the order of
  /// their times.
  ConstView<Impact> impacts() const { return impacts_.view(); }
  /// Returns the bodies that have had an impact, as they were before their first one, in any order.
  ConstView<StruckBody> struck() const { return struck_.view(); }
  /// Returns whether a body was struck after the midpoint.
  bool any_late_impact() const { return progress_.late_impact != 0; }
  /// Returns whether a body has used up its impact budget, or the number of rounds has reached its bound.
  bool hit_bound() const { return progress_.hit_bound != 0; }
  std::int64_t rounds() const { return rounds_; }

  /// Returns the bodies after resolve(), for flight_of_contact() and shift_after_late_impact().
  FlightStage stage(const FlightTerms& terms, const ResponseParameters& parameters, const BodyView& bodies) {
    return {terms, parameters, bodies, log_};
  }

 private:
  template <class BoundsOf>
  bool any_may_meet(const FlightStage& stage, const BoundsOf& bounds_of);
  detail::ImpactProgram program(const FlightStage& stage, const Problem& problem);
  void list_fast(const FlightStage& stage, const Problem& problem);
  /// Lists the pairs that come near each other, as far as there is room.
  void list_near(const FlightStage& stage, const Problem& problem);
  /// Makes room in the lists for rounds that have halted for want of it.
  void make_room(const FlightStage& stage, const Problem& problem, detail::RoundsState& state);
  Ledger put_in_order(std::int64_t pairs, ConstView<BodyNumber> number);

  FlightLog<Space> log_;
  detail::ImpactProgress progress_;                       ///< progress as the host last read it
  Array<detail::ImpactProgress, Space> shared_progress_;  // one element
  Array<detail::FlightBounds, Space> bounds_, bounds_scratch_;
  std::int64_t rounds_ = 0;
  Array<std::int32_t, Space> fast_;  // pairs that are fast enough for an impact; empty if they are not listed
  // Whether most pairs were fast in the last flight from 0 on, and in the last one from later on.
  bool most_were_fast_[2] = {false, false};
  // Arrays that detail::ImpactProgram views:
  Array<std::uint64_t, Space> first_[2];
  Array<std::uint32_t, Space> struck_in_, waits_in_, impact_group_of_, walls_of_;
  Array<std::int64_t, Space> near_, to_search_;
  Array<detail::PredictedMeeting, Space> meetings_[2];
  Array<detail::ImpactGroup, Space> impact_groups_;
  Array<detail::Resolved, Space> resolved_;
  Array<std::uint64_t, Space> key_;
  Array<StruckBody, Space> struck_;
  Array<detail::StruckPairs, Space> chunks_;
  Array<std::int32_t, Space> struck_large_bodies_;
  Adjacency<Space> adjacency_;
  std::int64_t adjacency_of_ = 0;  // Problem::pairs_made of the adjacency
  // Impacts in order:
  Array<std::int64_t, Space> order_;
  Array<Impact, Space> impacts_;
};

}  // namespace scree
