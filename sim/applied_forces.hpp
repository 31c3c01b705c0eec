// Forces besides gravity: which act in a step, and what they did.
#pragma once

#include "core/bodies.hpp"
#include "sim/dynamics/state.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// Costs nothing in a scene without such forces.
class AppliedForces {
 public:
  AppliedForces(const Scene& scene, const TimeGrid& grid);

  /// Points the parameters at the forces and torques that act in the step after the state `step`.
  void act(std::int64_t step, const Bodies<Host>& bodies, ResponseParameters& parameters);
  /// From here on work is counted.
  void start_substep(const Bodies<Host>& bodies);
  /// Work of the forces since then (J); that of the torques is the response's.
  double work(const Bodies<Host>& bodies) const;

 private:
  std::vector<AppliedForce> forces_;
  std::vector<TimeGrid::Steps> steps_;  // of each force
  Array<Vec3, Host> acceleration_;      // of each body (m/s^2)
  Array<Vec3, Host> torque_;            // on each body (N m)
  Array<Vec3, Host> start_;             // of each body in the substep (m)
};

}  // namespace scree
