// The bodies of one flight, as the search for their impacts sees them.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "narrowphase/narrow_phase.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/meeting.hpp"
#include "sim/dynamics/state.hpp"

#include <cstdint>

namespace scree {

/// Impacts of one body in a flight after which it bounces no more, and after which it has no more.
inline constexpr std::int32_t most_bounces = 64;
inline constexpr std::int32_t most_hits = 256;

/// What may meet, and how, in one flight.
struct ImpactProblem {
  ConstView<Pair> pairs;  ///< candidates, among which are all that may meet
  ContactLaws laws;
  const ImpulseMemory& memory;  ///< contacts that carried a load do not bounce
  double step;                  ///< length of the substep (s)
  double from;   ///< start of the flight, into the substep (s); it ends with the substep. If not 0, the
                 ///< last one began at 0 (who was struck later in it starts then), and the response
                 ///< has kicked the bodies since
  bool bounces;  ///< whether approaches faster than the threshold count; else only those that would go deep
};

/// Of each body in a flight.
struct FlightLog {
  Array<double, Host> clock;       ///< time of its last impact (s); the start if it had none
  Array<std::int32_t, Host> hits;  ///< its impacts so far
  Array<double, Host> turn;        ///< bound on the speed that turning gives its surface (m/s)
  Array<double, Host> top_speed;   ///< bound on that of its surface, but for what gravity adds (m/s)
  Array<double, Host> reach;       ///< of its surface from the midpoint, to either end of the substep (m)
  Array<double, Host> extent;  ///< how far from its centre it may be in the substep (m); infinite: boundary

  void resize(std::int64_t bodies) {
    clock.resize(bodies);
    hits.resize(bodies);
    turn.resize(bodies);
    top_speed.resize(bodies);
    reach.resize(bodies);
    extent.resize(bodies);
  }
};

/// The bodies in flight, and what has become of them. Cheap to copy; the bodies and the log are the caller's.
struct FlightStage {
  FlightStage(const ImpactProblem& p, const ResponseParameters& r, const BodyView& b, FlightLog& log)
      : problem(p),
        parameters(r),
        bodies(b),
        clock(log.clock.view()),
        hits(log.hits.view()),
        turn(log.turn.view()),
        top_speed(log.top_speed.view()),
        reach(log.reach.view()),
        extent(log.extent.view()) {}

  ImpactProblem problem;
  ResponseParameters parameters;
  BodyView bodies;
  View<double> clock;
  View<std::int32_t> hits;
  View<double> turn;
  View<double> top_speed;
  View<double> reach;
  View<double> extent;
  double harmless = -1;  ///< two bodies whose top speeds sum to no more have no impact (m/s)

  bool is_free(std::int32_t body) const { return bodies.mobility[body] == Mobility::free; }

  BodyFlight flight(std::int32_t body) const;
  /// What the bodies' velocities have of the substep's kick already (m/s).
  Vec3 kick_of(std::int32_t body) const {
    return problem.from > 0 && is_free(body) ? Vec3(problem.step * parameters.acceleration_of(body))
                                             : Vec3(Vec3::Zero());
  }

  /// The slowest approach that bounces on a part without load (m/s).
  double slowest_bounce(std::int32_t i, std::int32_t j) const;

  /// Two bodies until the end of the substep; no meeting of theirs counts yet.
  PairFlight pair_of(std::int32_t i, std::int32_t j, double until) const;

  /// Sets the turn and the reach of a body as it flies now.
  void bound(std::int32_t body) const;

  /// What `harmless` may be, for the bodies as bound() has seen them (m/s): such two neither go deep, nor do
  /// they close as fast as what bounces, even if gravity adds to it.
  double harmless_speed() const;

  /// The next impact of two bodies, of which one is free.
  Meeting next(std::int32_t i, std::int32_t j) const;

 private:
  /// True if two bodies do not come near one another in the substep.
  bool are_far(std::int32_t i, std::int32_t j) const;
  /// Bound on how fast two bodies come closer in the substep (m/s).
  double fastest(std::int32_t i, std::int32_t j) const;
};

}  // namespace scree
