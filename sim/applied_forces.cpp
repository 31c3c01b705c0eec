#include "sim/applied_forces.hpp"

#include "sim/dynamics/motion.hpp"

#include <algorithm>

namespace scree {

AppliedForces::AppliedForces(const Scene& scene, const TimeGrid& grid) : forces_(scene.forces) {
  for (const AppliedForce& force : forces_) steps_.push_back(grid.steps_in(force.during));
}

void AppliedForces::act(std::int64_t step, const Bodies<Host>& bodies, ResponseParameters& parameters) {
  if (forces_.empty()) return;
  acceleration_.resize(bodies.count());
  torque_.resize(bodies.count());
  std::fill(acceleration_.view().begin(), acceleration_.view().end(), Vec3(Vec3::Zero()));
  std::fill(torque_.view().begin(), torque_.view().end(), Vec3(Vec3::Zero()));
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    if (!steps_[f].holds(step)) continue;
    const BodyRange& on = forces_[f].on;
    for (std::int64_t k = on.first; k < on.first + on.count; ++k) {
      acceleration_.view()[k] += bodies.inverse_mass.view()[k] * forces_[f].force;
      torque_.view()[k] += forces_[f].torque;
    }
  }
  parameters.acceleration = acceleration_.view();
  parameters.torque = torque_.view();
}

void AppliedForces::start_substep(const Bodies<Host>& bodies) {
  if (!forces_.empty()) copy(start_, bodies.position);
}

double AppliedForces::work(const Bodies<Host>& bodies) const {
  if (forces_.empty()) return 0;
  return work_of_forces(bodies, start_, acceleration_.view());
}

}  // namespace scree
