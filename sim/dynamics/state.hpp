// What the stages of one substep share.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/dynamics/contact_row.hpp"
#include "sim/dynamics/restitution.hpp"
#include "sim/observation.hpp"

#include <cstdint>

namespace scree {

/// A body that moves along one axis alone, and does not turn. What else pushes it the guide takes, which does
/// no work.
struct Guide {
  std::int32_t body;
  Vec3 axis;  ///< unit

  SCREE_HD void hold(Vec3& along) const { along = axis.dot(along) * axis; }
};

/// Leaves of a vector of a body (its velocity, say) what its guide does, if it has one.
SCREE_HD inline void hold_to_guide(ConstView<Guide> guides, std::int32_t body, Vec3& along) {
  for (std::int64_t g = 0; g < guides.size(); ++g) {
    if (guides[g].body == body) guides[g].hold(along);
  }
}

/// The settings of the response, resolved.
struct ResponseParameters {
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
  /// Of each body by the forces applied to it (m/s^2), and the torques on it (N m). Empty without such
  /// forces.
  ConstView<Vec3> acceleration;
  ConstView<Vec3> torque;
  ConstView<Guide> guides;  ///< by place; empty without such bodies
  /// Bound on how fast velocities of prescribed bodies' surfaces change, but for constant spin (m/s^2).
  double prescribed_acceleration = 0;
  bool friction = true;
  bool rolling_friction = false;
  bool restitution = true;
  bool rotation = true;
  bool gyroscopic = true;
  bool continuous = true;
  bool warm_start = true;
  bool accurate = false;  ///< solve to the natural residual; rotate to fourth order
  double quality = 1;     ///< response.quality: overlaps and changes that are left are divided by it
  int iterations = 0;     ///< most sweeps; 0: plan_sweeps()
  int block_sweeps = 0;   ///< over the points of a contact at each visit; 0: likewise
  double tolerance = 0;   ///< of the impulses' change in one sweep, relative; 0: plan_sweeps()
  RestitutionThreshold restitution_threshold;

  /// Of a free body in flight (m/s^2).
  SCREE_HD Vec3 acceleration_of(std::int64_t body) const {
    return acceleration.size() > 0 ? Vec3(gravity + acceleration[body]) : gravity;
  }
};

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
