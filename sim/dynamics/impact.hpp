// Impacts that bounce: at their time inside the substep, one contact after the other.
#pragma once

#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/state.hpp"

namespace scree {

struct ImpactProblem {
  ConstView<Manifold> manifolds;
  double step;      ///< length of the substep (s)
  BodyView bodies;  ///< at the midpoint
};

class ImpactSolver {
 public:
  /// Finds and resolves every impact of the substep whose contact was not loaded before, bounces, and closes
  /// faster than the threshold. A body in flight is, at the time s into the substep, at
  ///   x(s) = x_mid + (s - step/2) v + g s^2 / 2,
  /// so an impulse dv at s shifts x_mid by -(s - step/2) dv, and flight, bounce and energy are exact for a
  /// sphere whatever the step (docs/method.md). Chains run on until nothing closes; if a bound is hit, the
  /// rest is left to the response with e = 0 and counted. Sets Contact::falling and set.shift, moves the
  /// positions by the shift. `solver` holds the velocities before gravity's kick. Returns what the impacts
  /// moved.
  Ledger resolve(const ImpactProblem& problem, const ResponseParameters& parameters,
                 Array<SolverBody, Host>& solver, ContactSet& set, Counters& counters);

 private:
  Array<double, Host> clock_;            // time of each body's last impact in this substep
  Array<std::int32_t, Host> last_pass_;  // in which each body was last hit
  Array<Ledger, Host> ledger_;           // per contact
  Array<std::uint8_t, Host> hit_;        // per contact, in the last pass
};

}  // namespace scree
