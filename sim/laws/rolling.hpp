// Rolling friction of one contact: a couple against the spin with which its two bodies roll on one another.
#pragma once

#include "sim/laws/contact_row.hpp"
#include "sim/laws/impulse_energy.hpp"
#include "sim/observe/observation.hpp"

#include <cmath>

namespace scree {

/// Returns the smallest ratio of a couple to the change of the relative spin with which two bodies roll (kg
/// m^2); 0 where neither body turns.
SCREE_HD inline double rolling_mass(const SolverBody& i, const SolverBody& j, const Vec3& normal) {
  const double largest = largest_across(i.inverse_inertia + j.inverse_inertia, normal);
  return largest > 0 ? 1.0 / largest : 0.0;
}

/// Returns the value to which a projected step of the length `mass` takes a couple on j (N m s), given the
/// present spin of j relative to i. It lies across the normal, in the disc of radius `most`.
SCREE_HD inline Vec3 rolling_couple(const Vec3& couple, const Vec3& normal, double most, double mass,
                                    const Vec3& spin) {
  const Vec3 step = couple - mass * spin;
  const Vec3 across = step - step.dot(normal) * normal;
  const double square = across.squaredNorm();
  return square <= most * most ? across : Vec3((most / sqrt(square)) * across);
}

/// Applies a couple to the spin of j, and the opposite couple to that of i.
SCREE_HD inline void turn(const Vec3& couple, SolverBody& i, SolverBody& j) {
  i.spin -= i.inverse_inertia * couple;
  j.spin += j.inverse_inertia * couple;
}

/// Returns the energy that a couple moves, as account() does for an impulse. `before`: the spin of j relative
/// to i before the couple (rad/s).
SCREE_HD inline Ledger account_couple(const Vec3& couple, const Vec3& before, const SolverBody& i,
                                      const SolverBody& j) {
  Ledger ledger;
  ledger.friction = -0.5 * couple.dot(before + j.spin - i.spin);
  if (!i.is_free()) ledger.work += couple.dot(i.spin);
  if (!j.is_free()) ledger.work -= couple.dot(j.spin);
  return ledger;
}

}  // namespace scree
