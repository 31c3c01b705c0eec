// Forces besides gravity: which of them act in a step, and their work.
#pragma once

#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// The applied forces on bodies in a space, and the forces that drive servos. They cost nothing in a scene
/// that has none.
template <class Space>
class AppliedForces {
 public:
  AppliedForces(const Scene& scene, const TimeGrid& grid);

  /// Sets the views of `parameters` to the accelerations and torques of the step after the state `step`. They
  /// are summed up anew only if other forces act than before, or after forget().
  void act(std::int64_t step, const Bodies<Space>& bodies, ResponseParameters& parameters);
  /// Must be called when the bodies have changed, or gravity has, which servos cancel.
  void forget() { summed_up_ = false; }
  /// Saves the positions from which on work() counts.
  void start_substep(const Bodies<Space>& bodies);
  /// Returns the work of the forces since start_substep() (J). The response accounts for the work of the
  /// torques.
  double work(const Bodies<Space>& bodies) const;

 private:
  bool are_none() const { return forces_.empty() && servos_.empty(); }
  void sum_up(const Bodies<Space>& bodies, const Vec3& gravity);

  std::vector<AppliedForce> forces_;
  std::vector<Servo> servos_;
  std::vector<TimeGrid::Steps> steps_;  // steps in which each force acts
  std::vector<bool> acting_;            // whether each force is in the sums
  bool summed_up_ = false;
  Array<Vec3, Space> acceleration_;  // acceleration of each body (m/s^2)
  Array<Vec3, Space> torque_;        // torque on each body (N m)
  Array<Vec3, Space> start_;         // position of each body at the start of the substep (m)
};

}  // namespace scree
