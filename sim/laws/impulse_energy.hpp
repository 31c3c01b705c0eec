// The energy accounting of impulses.
#pragma once

#include "core/math.hpp"
#include "sim/laws/contact_row.hpp"
#include "sim/observe/observation.hpp"

namespace scree {

/// Returns the energy that a row's impulse p on j (and -p on i) moves, given the relative velocity `before`
/// the impulse: dE = p.(u- + u+)/2 exactly, if u is taken at one configuration (Moreau's midpoint). The
/// normal part of dE counts as restitution, the tangential part as friction, and what a body that is not free
/// contributes as work. `i` and `j` are the bodies after the impulse.
SCREE_HD inline Ledger account(const ContactRow& row, const Vec3& normal, const Vec3& before,
                               const SolverBody& i, const SolverBody& j) {
  const Vec3 mean = 0.5 * (before + row.relative_velocity(i, j));
  const double pn = row.impulse.dot(normal);
  const double normal_part = pn * mean.dot(normal);
  Ledger ledger;
  ledger.restitution = -normal_part;
  ledger.friction = -(row.impulse.dot(mean) - normal_part);
  if (!i.is_free()) ledger.work += row.impulse.dot(i.velocity_at(row.arm_i));
  if (!j.is_free()) ledger.work -= row.impulse.dot(j.velocity_at(row.arm_j));
  return ledger;
}

/// The energy that impulses p move, as a parabola in their common scale s: linear s + square s^2 (J).
/// `linear` is p.u before the impulses (half of it with u before a kick, half with u after it), and `square`
/// is p.W p / 2.
struct Moved {
  double linear = 0;
  double square = 0;

  /// Returns whether the impulses gain energy. `rounding`: share of the square part that counts as no gain.
  SCREE_HD bool gains(double rounding) const { return linear + square > rounding * square; }
  /// Returns the scale at which no energy is gained; momentum and the friction cone allow any from 0 to 1.
  SCREE_HD double scale_without_gain() const { return linear < 0 ? -linear / square : 0.0; }
  SCREE_HD friend Moved operator+(const Moved& a, const Moved& b) {
    return {a.linear + b.linear, a.square + b.square};
  }
};

}  // namespace scree
