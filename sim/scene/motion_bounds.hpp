// Gravity as a function of time, and bounds on the motions that a scene prescribes.
#pragma once

#include "sim/scene/scene.hpp"

namespace scree {

/// Returns gravity at a time (s), if it is `at_start` at t = 0 (m/s^2).
Vec3 gravity_at(const GravityTurn& turn, const Vec3& at_start, double time);

/// Returns the largest magnitude of gravity at any time (m/s^2).
double largest_gravity(const Scene& scene);

/// Bounds on the speeds and accelerations of a motion. The acceleration that constant spin causes is not
/// included.
struct MotionBounds {
  double speed = 0;                 ///< speed of the point about which the body turns (m/s)
  double spin = 0;                  ///< angular speed (rad/s)
  double acceleration = 0;          ///< acceleration of that point (m/s^2)
  double angular_acceleration = 0;  ///< angular acceleration (rad/s^2)
};
MotionBounds bounds_of(const Motion& motion);

}  // namespace scree
