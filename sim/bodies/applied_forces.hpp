// Forces besides gravity: which act in a step, and what they did.
#pragma once

#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// On bodies in a space, and those that drive servos. Costs nothing in a scene without such forces.
template <class Space>
class AppliedForces {
 public:
  AppliedForces(const Scene& scene, const TimeGrid& grid);

  /// Points the parameters at the forces and torques that act in the step after the state `step`. They are
  /// summed up anew only where others act than before, or after forget().
  void act(std::int64_t step, const Bodies<Space>& bodies, ResponseParameters& parameters);
  /// The bodies are others, or gravity is, which servos bear.
  void forget() { summed_up_ = false; }
  /// From here on work is counted.
  void start_substep(const Bodies<Space>& bodies);
  /// Work of the forces since then (J); that of the torques is the response's.
  double work(const Bodies<Space>& bodies) const;

 private:
  bool are_none() const { return forces_.empty() && servos_.empty(); }
  void sum_up(const Bodies<Space>& bodies, const Vec3& gravity);

  std::vector<AppliedForce> forces_;
  std::vector<Servo> servos_;
  std::vector<TimeGrid::Steps> steps_;  // of each force
  std::vector<bool> acting_;            // each force, in what is summed up
  bool summed_up_ = false;
  Array<Vec3, Space> acceleration_;  // of each body (m/s^2)
  Array<Vec3, Space> torque_;        // on each body (N m)
  Array<Vec3, Space> start_;         // of each body in the substep (m)
};

}  // namespace scree
