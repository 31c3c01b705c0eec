// All impacts of a flight on the host: in the order of their times, each one's outcome before the next.
#pragma once

#include "sim/dynamics/impact.hpp"
#include "sim/dynamics/late_contacts.hpp"

#include <optional>
#include <tuple>
#include <vector>

namespace scree {

/// What may meet, and how, in one flight.
struct ImpactProblem {
  ConstView<Pair> pairs;        ///< candidates, among which are all that may meet
  const ImpulseMemory& memory;  ///< contacts that carried a load do not bounce
  FlightTerms terms;
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
  /// As take_normal_of_face(), of all manifolds, after resolve().
  void take_normals_of_faces(const ImpactProblem& problem, const ResponseParameters& parameters,
                             BodyView bodies, View<ManifoldHeader> headers, View<ContactPoint> points);
  /// As the function of this name, after resolve().
  void mark_flights(const ImpactProblem& problem, const ResponseParameters& parameters,
                    const Manifolds& manifolds, BodyView bodies, ContactSet& set, BallPairs& balls);

  /// As the function of this name.
  Ledger shift_late(const ImpactProblem& problem, const ResponseParameters& parameters, BodyView bodies,
                    const ContactSet& set);

  /// Of the last resolve(), in their order.
  const std::vector<Impact>& impacts() const { return impacts_; }
  /// Whether a body has had its bound of them.
  bool hit_bound() const { return hit_bound_; }

 private:
  /// A meeting, as foreseen.
  struct Event {
    Meeting meeting;
    std::int32_t i, j;
    std::int32_t version_i, version_j;  // of the bodies' flights when it was foreseen

    friend bool operator>(const Event& a, const Event& b) {
      return std::tuple(a.meeting.time, a.i, a.j, a.meeting.part) >
             std::tuple(b.meeting.time, b.i, b.j, b.meeting.part);
    }
  };

  void foresee(const FlightStage& stage, std::int32_t i, std::int32_t j, const Meeting& meeting);
  void list_partners(ConstView<Pair> pairs, std::int64_t bodies);

  FlightLog<Host> log_;
  Array<Meeting, Host> first_;         // of each candidate
  std::vector<std::int32_t> version_;  // of each body's flight: how many impacts led to it
  std::vector<std::int64_t> begin_;    // of the partners of each body
  std::vector<std::int32_t> partners_;
  std::vector<std::int64_t> next_;  // scratch of list_partners()
  std::vector<Impact> impacts_;
  std::vector<StruckBody> saved_;
  std::vector<Event> events_;  // a heap, the earliest first
  std::vector<Vec3> impulse_;  // scratch of shift_late()
  bool hit_bound_ = false;
  std::optional<StruckBodies> late_;
};

}  // namespace scree
