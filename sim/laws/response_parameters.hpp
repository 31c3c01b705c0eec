// The resolved settings of the response, which the stages of a substep share.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/laws/restitution.hpp"

#include <cstdint>

namespace scree {

/// The guide of a body that moves along one axis only and does not turn. The guide takes up all other
/// components of what pushes the body, and does no work.
struct Guide {
  std::int32_t body;
  Vec3 axis;  ///< unit

  SCREE_HD void hold(Vec3& along) const { along = axis.dot(along) * axis; }
};

/// Keeps of a body's vector (its velocity, for example) only the part along its guide, if it has one.
SCREE_HD inline void hold_to_guide(ConstView<Guide> guides, std::int32_t body, Vec3& along) {
  for (std::int64_t g = 0; g < guides.size(); ++g) {
    if (guides[g].body == body) guides[g].hold(along);
  }
}

/// The resolved settings of the response.
struct ResponseParameters {
  Vec3 gravity = Vec3::Zero();  ///< m/s^2
  /// The acceleration of each body by the forces applied to it (m/s^2), and the torques on it (N m). Both are
  /// empty without such forces.
  ConstView<Vec3> acceleration;
  ConstView<Vec3> torque;
  ConstView<Guide> guides;  ///< guides by the places of their bodies; empty without such bodies
  /// A bound on how fast the surface velocities of prescribed bodies change, without the part of a constant
  /// spin (m/s^2).
  double prescribed_acceleration = 0;
  bool friction = true;
  bool rolling_friction = false;
  bool restitution = true;
  bool rotation = true;
  bool gyroscopic = true;
  bool continuous = true;
  bool warm_start = true;
  bool accurate = false;  ///< solve to the natural residual, and rotate to fourth order
  double quality = 1;     ///< response.quality: tolerated overlaps and changes are divided by it
  int iterations = 0;     ///< largest number of sweeps; 0: plan_sweeps() chooses it
  int block_sweeps = 0;   ///< sweeps over the points of a contact at each visit; 0: plan_sweeps() chooses it
  double tolerance = 0;   ///< relative change of impulses at which sweeps end; 0: plan_sweeps() chooses it
  RestitutionThreshold restitution_threshold;

  /// Returns the acceleration of a free body in flight (m/s^2).
  SCREE_HD Vec3 acceleration_of(std::int64_t body) const {
    return acceleration.size() > 0 ? Vec3(gravity + acceleration[body]) : gravity;
  }
};

}  // namespace scree
