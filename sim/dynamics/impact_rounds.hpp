// All impacts of a flight in a space: in rounds, all at once in each that are the first in their
// neighbourhood.
#pragma once

#include "core/array.hpp"
#include "narrowphase/narrow_phase.hpp"
#include "sim/dynamics/impact.hpp"
#include "sim/dynamics/volley.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace scree {

namespace detail {

/// A meeting, as foreseen.
struct Foreseen {
  double time;        ///< into the substep (s); infinite: it has come to nothing
  std::int64_t pair;  ///< in the list of the pairs
  std::int32_t part;
};

/// The first meeting of a body: the earliest, of equal ones that of the first pair.
struct FirstMeeting {
  std::uint64_t time;  ///< its bits, which are in the order of times
  std::uint64_t pair;
};

/// An impact, and what it moved.
struct Resolved {
  Impact impact;
  Ledger moved;
};

/// The bits of a number that is not negative are in the order of such numbers. Those of infinity:
inline constexpr auto infinite = std::bit_cast<std::uint64_t>(HUGE_VAL);

/// How many a round has found.
struct RoundCounts {
  std::uint64_t suspects = 0;
  std::uint64_t meetings = 0;
  std::uint64_t with_heavy = 0;  ///< of these, with a body that is heavy to the other
  std::uint64_t busy = 0;        ///< pairs, with those of the rounds before
};

/// What all bodies and laws stay within.
struct FlightBounds {
  double top_speed = 0;        ///< the largest of the bodies' (m/s)
  double smallest = HUGE_VAL;  ///< of their sizes (m)
  double restitution = 0;      ///< the largest of the laws'
  SCREE_HD friend FlightBounds operator+(const FlightBounds& a, const FlightBounds& b) {
    return {fmax(a.top_speed, b.top_speed), fmin(a.smallest, b.smallest), fmax(a.restitution, b.restitution)};
  }
};

/// What the threads of a flight tell the host, which reads it once in a round.
struct ImpactProgress {
  RoundCounts round;
  double harmless = 0;  ///< FlightStage::harmless; infinite where nobody is faster (m/s)
  std::uint64_t impacts = 0;
  std::uint64_t struck = 0;     ///< bodies
  std::uint32_t last_join = 0;  ///< the last round in which a body first had a meeting to come
  std::uint32_t late = 0;       ///< whether one of them was struck after the midpoint
  std::uint32_t hit_bound = 0;
};

}  // namespace detail

/// The same impacts as ImpactSolver's, with its bounds. In each round a meeting is resolved if no other of
/// its two bodies is earlier, nor any that could drive a body into these before: what comes later in one
/// place waits for what is earlier there, while places apart do not wait for each other. A chain that would
/// run through two bodies and reach a third before its own meeting comes too late for that, and strikes it
/// right after. Bodies that are not free change nothing, and nobody waits for them. A heavy body is struck by
/// many light ones in one round, and between light ones it is as one that is not free. Results do not depend
/// on the threads.
template <class Space>
class ImpactRounds {
 public:
  /// What may meet, and how, in one flight.
  struct Problem {
    ConstView<Pair> pairs;          ///< candidates, among which are all that may meet; each has a free body
    ConstView<LoadedParts> loaded;  ///< of each pair; empty: none
    FlightTerms terms;
  };

  /// False if all are too slow for one in the flight, wherever they are.
  bool any_may_meet(const FlightTerms& terms, const ResponseParameters& parameters, BodyView bodies);
  /// Finds and resolves the impacts of the flight, as ImpactSolver::resolve(). All views are of the space.
  Ledger resolve(const Problem& problem, const ResponseParameters& parameters, BodyView bodies);
  /// Puts the bodies back to where they were before the last resolve().
  void undo(BodyView bodies);

  /// Of the last resolve(): round by round, in each in the order of the pairs, so that those of one body are
  /// in the order of their times.
  ConstView<Impact> impacts() const { return impacts_.view(); }
  /// The bodies that have had one, as they were before it, in any order.
  ConstView<StruckBody> struck() const { return struck_.view(); }
  /// Whether one of them had it after the midpoint.
  bool any_is_late() const { return progress_.late != 0; }
  /// Whether a body, or the rounds, have had their bound.
  bool hit_bound() const { return progress_.hit_bound != 0; }
  std::int64_t rounds() const { return rounds_; }

  /// The bodies after resolve(), for flight_of_contact() and shift_late().
  FlightStage stage(const FlightTerms& terms, const ResponseParameters& parameters, const BodyView& bodies) {
    return {terms, parameters, bodies, log_};
  }

 private:
  void start(const FlightStage& stage);
  void foresee(const FlightStage& stage, const Problem& problem);
  void resolve_first(const FlightStage& stage, const Problem& problem);
  Ledger put_in_order(std::int64_t pairs);

  FlightLog<Space> log_;
  detail::ImpactProgress progress_;                       ///< as the host last saw it
  Array<detail::ImpactProgress, Space> shared_progress_;  // one
  Array<detail::FlightBounds, Space> bounds_, bounds_scratch_;
  std::int64_t rounds_ = 0;
  Array<std::int64_t, Space> suspects_;             // pairs that are to be looked at in this round
  Array<std::int64_t, Space> busy_;                 // pairs of bodies that have joined
  Array<detail::Foreseen, Space> meetings_, last_;  // of this round, and of the one before
  Array<detail::FirstMeeting, Space> first_;        // of each body
  Array<std::uint32_t, Space> joined_in_;  // of each body: the round that first foresaw one of its own
  Array<std::uint32_t, Space> struck_in_, waits_in_;  // of each body: the last such round, 0 for none
  Array<std::uint32_t, Space> volley_of_;  // of each body: its first meeting with a lighter one in meetings_
  Array<detail::Volley, Space> volleys_;   // as many as there are meetings
  Array<detail::Resolved, Space> resolved_;  // impacts, in any order
  Array<std::uint64_t, Space> key_;          // of each one's place
  Array<std::int64_t, Space> order_;
  Array<Impact, Space> impacts_;
  Array<StruckBody, Space> struck_;
};

}  // namespace scree
