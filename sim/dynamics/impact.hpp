// Impacts: at their time inside the substep, in order, each one's outcome before the next.
#pragma once

#include "narrowphase/narrow_phase.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/meeting.hpp"
#include "sim/dynamics/state.hpp"

#include <memory>
#include <vector>

namespace scree {

struct ImpactProblem {
  ConstView<Pair> pairs;  ///< among which are all that may meet, but for planes, which may meet everybody
  ContactLaws laws;
  const ImpulseMemory& memory;  ///< contacts that carried a load do not bounce
  double step;                  ///< length of the substep (s)
  double from;   ///< start of the flight, into the substep (s); it ends with the substep. If not 0, the
                 ///< last one began at 0 (who was struck later in it starts then), and the response
                 ///< has kicked the bodies since
  bool bounces;  ///< whether approaches faster than the threshold count; else only those that would go deep
};

/// What an impact gave to body j, and reversed to i.
struct Impact {
  std::int32_t i, j;
  Vec3 impulse;  ///< N s
  Vec3 point;    ///< m
};

/// Of each body in a flight.
struct FlightLog {
  Array<double, Host> clock;       ///< time of its last impact (s); the start if it had none
  Array<std::int32_t, Host> hits;  ///< its impacts so far
  Array<double, Host> reach;       ///< of its surface from the midpoint, to either end of the substep (m)
};

class ImpactSolver {
 public:
  /// Finds and resolves the impacts of the flight. One is the meeting of a pair that was not loaded before,
  /// bounces, and closes faster than the threshold; or of any pair whose approach would go on for more than
  /// tolerance::deep_approach by the end of the substep: the response, which sees the midpoint alone, could
  /// not tell which way to part them. A body in flight is, at the time s into the substep, at
  ///   x(s) = x_mid + (s - step/2) v + g s^2 / 2,
  /// and turns freely; after an impact its midpoint is that from which its new velocity leads through the
  /// impact. So flight, bounce and energy are exact whatever the step (docs/method.md). The bodies are at the
  /// midpoint, with their velocities before gravity's kick. Chains run on until nothing meets; a body that
  /// has had its bound of impacts takes e = 0. Returns what the impacts moved.
  Ledger resolve(const ImpactProblem& problem, const ResponseParameters& parameters, BodyView bodies);
  /// Puts the bodies back to where they were before the last resolve().
  void undo(BodyView bodies);

  /// Which pairs have had an impact after the midpoint, after resolve(); null if none has. The contacts of
  /// such a pair are those of the impact's time, from which a straight flight leads to the end of the
  /// substep. Valid until the next call.
  const LateBodies* late_bodies(const ImpactProblem& problem, const ResponseParameters& parameters,
                                BodyView bodies);
  /// Sets Contact::flying and Contact::lead, after resolve().
  void mark_flights(const ImpactProblem& problem, const ResponseParameters& parameters,
                    ConstView<Manifold> manifolds, BodyView bodies, ContactSet& set);

  /// After the response: a body that was struck late has been where it was until then, so its midpoint moves
  /// to that from which its new flight leads on from its last impact. Returns what that moved.
  Ledger shift_late(const ImpactProblem& problem, const ResponseParameters& parameters, BodyView bodies,
                    const ContactSet& set);

  /// Of the last resolve(), in their order.
  const std::vector<Impact>& impacts() const { return impacts_; }
  /// Whether a body has had its bound of them.
  bool hit_bound() const { return hit_bound_; }

  /// A body before its first impact of the flight.
  struct Saved {
    std::int32_t body;
    Vec3 position;
    Quat orientation;
    Vec3 velocity, spin;
    double clock;
  };

 private:
  void list_partners(ConstView<Pair> pairs, const BodyView& bodies);

  FlightLog log_;
  Array<Meeting, Host> first_;  // of each candidate
  std::vector<std::int32_t> planes_;
  std::vector<std::int64_t> begin_;  // of the partners of each body
  std::vector<std::int32_t> partners_;
  std::vector<std::int64_t> next_;  // scratch of list_partners()
  std::vector<Impact> impacts_;
  std::vector<Saved> saved_;
  std::vector<Vec3> impulse_;  // on each body, by the contacts
  bool hit_bound_ = false;
  std::unique_ptr<LateBodies> late_;
};

}  // namespace scree
