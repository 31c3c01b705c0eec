// What the stages of one substep share.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/dynamics/contact_row.hpp"
#include "sim/dynamics/restitution.hpp"
#include "sim/observation.hpp"

#include <cstdint>

namespace scree {

/// The settings of the response, resolved.
struct ResponseParameters {
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
  /// Of each body by the forces applied to it (m/s^2), and the torques on it (N m). Empty without such
  /// forces.
  ConstView<Vec3> acceleration;
  ConstView<Vec3> torque;
  bool friction = true;
  bool restitution = true;
  bool rotation = true;
  bool gyroscopic = true;
  bool continuous = true;
  bool warm_start = true;
  bool accurate = false;     ///< solve to the natural residual; rotate to fourth order
  int iterations = 0;        ///< most sweeps; 0: automatic_sweeps()
  int block_sweeps = 0;      ///< over the points of a contact at each visit; 0: likewise
  double tolerance = 1e-10;  ///< of the impulses' change in one sweep, relative
  RestitutionThreshold restitution_threshold;

  /// Of a free body in flight (m/s^2).
  SCREE_HD Vec3 acceleration_of(std::int64_t body) const {
    return acceleration.size() > 0 ? Vec3(gravity + acceleration[body]) : gravity;
  }
};

/// Energy that one impulse p on j (and -p on i) at a common point moves, from the relative velocities before
/// and after: dE = p.(u- + u+)/2 exactly, when u is taken at one configuration (Moreau's midpoint). Its
/// normal part is restitution's, its tangential part friction's; what a prescribed partner gives is work.
SCREE_HD inline Ledger account(const Vec3& impulse, const Vec3& normal, const Vec3& before, const Vec3& after,
                               const Vec3& driver_velocity, double driver_sign) {
  const Vec3 mean = 0.5 * (before + after);
  const double pn = impulse.dot(normal);
  const double normal_part = pn * mean.dot(normal);
  Ledger ledger;
  ledger.restitution = -normal_part;
  ledger.friction = -(impulse.dot(mean) - normal_part);
  ledger.work = driver_sign * impulse.dot(driver_velocity);
  return ledger;
}

}  // namespace scree
