// The settings of the response, resolved, as the stages of a substep share them.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/laws/restitution.hpp"

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

}  // namespace scree
