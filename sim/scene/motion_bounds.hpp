// Gravity as a function of time, and bounds on the motions that a scene prescribes.
#pragma once

#include "sim/scene/scene.hpp"

namespace scree {

/// Gravity at a time (s), if it is `at_start` at t = 0 (m/s^2).
Vec3 gravity_at(const GravityTurn& turn, const Vec3& at_start, double time);

/// The largest size that gravity has at any time (m/s^2).
double largest_gravity(const Scene& scene);

/// Bounds on the speeds of a motion, and on how fast they change, but for what constant spin does.
struct MotionBounds {
  double speed = 0;                 ///< of the point about which the body turns (m/s)
  double spin = 0;                  ///< rad/s
  double acceleration = 0;          ///< of that point (m/s^2)
  double angular_acceleration = 0;  ///< rad/s^2
};
MotionBounds bounds_of(const Motion& motion);

}  // namespace scree
