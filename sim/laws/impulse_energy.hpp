// The energy that impulses move.
#pragma once

#include "core/math.hpp"
#include "sim/laws/contact_row.hpp"
#include "sim/observe/observation.hpp"

namespace scree {

/// Energy that a row's impulse p on j (and -p on i) moves, from the relative velocity before: dE = p.(u- +
/// u+)/2 exactly, when u is taken at one configuration (Moreau's midpoint). Its normal part is restitution's,
/// its tangential part friction's; what a body that is not free gives is work. `i` and `j` are as after the
/// impulse.
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

/// What impulses p move, as a parabola in their common scale s: linear s + square s^2 (J), where linear is
/// p.u before (half of it from before a kick, half from after) and square is p.W p / 2.
struct Moved {
  double linear = 0;
  double square = 0;

  /// `rounding`: of the square part.
  SCREE_HD bool gains(double rounding) const { return linear + square > rounding * square; }
  /// The scale at which nothing is gained; momentum and the cone allow any from 0 to 1.
  SCREE_HD double scale_without_gain() const { return linear < 0 ? -linear / square : 0.0; }
  SCREE_HD friend Moved operator+(const Moved& a, const Moved& b) {
    return {a.linear + b.linear, a.square + b.square};
  }
};

}  // namespace scree
