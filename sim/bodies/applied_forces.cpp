#include "sim/bodies/applied_forces.hpp"

#include "sim/bodies/motion.hpp"

#include <utility>

namespace scree {

template <class Space>
AppliedForces<Space>::AppliedForces(const Scene& scene, const TimeGrid& grid)
    : forces_(scene.forces), servos_(scene.servos) {
  for (const AppliedForce& force : forces_) steps_.push_back(grid.steps_in(force.during));
}

template <class Space>
void AppliedForces<Space>::act(std::int64_t step, const Bodies<Space>& bodies,
                               ResponseParameters& parameters) {
  if (are_none()) return;
  std::vector<bool> acting;
  for (const TimeGrid::Steps& steps : steps_) acting.push_back(steps.holds(step));
  if (!summed_up_ || acting != acting_) {
    acting_ = std::move(acting);
    sum_up(bodies, parameters.gravity);
    summed_up_ = true;
  }
  parameters.acceleration = acceleration_.view();
  parameters.torque = torque_.view();
}

template <class Space>
void AppliedForces<Space>::sum_up(const Bodies<Space>& bodies, const Vec3& gravity) {
  const std::vector<double> inverse_mass = to_vector(bodies.inverse_mass);
  const std::vector<std::int32_t> place_of = to_vector(bodies.place_of);
  const auto place = [&place_of](BodyNumber number) {
    return place_of.empty() ? index_of(number) : static_cast<std::size_t>(place_of[index_of(number)]);
  };
  std::vector<Vec3> acceleration(inverse_mass.size(), Vec3::Zero());
  std::vector<Vec3> torque(inverse_mass.size(), Vec3::Zero());
  for (std::size_t f = 0; f < forces_.size(); ++f) {
    if (!acting_[f]) continue;
    for (std::int32_t number = 0; number < forces_[f].on.count; ++number) {
      const std::size_t k = place(BodyNumber{forces_[f].on.first + number});
      acceleration[k] += inverse_mass[k] * forces_[f].force;
      torque[k] += forces_[f].torque;
    }
  }
  for (const Servo& servo : servos_) {
    const std::size_t k = place(BodyNumber{servo.body});
    acceleration[k] = inverse_mass[k] * servo.force * servo.axis - gravity;
  }
  copy(acceleration_, acceleration);
  copy(torque_, torque);
}

template <class Space>
void AppliedForces<Space>::start_substep(const Bodies<Space>& bodies) {
  if (!are_none()) copy(start_, bodies.position);
}

template <class Space>
double AppliedForces<Space>::work(const Bodies<Space>& bodies) const {
  if (are_none()) return 0;
  return work_of_forces(bodies, start_, acceleration_.view());
}

#define SCREE_INSTANTIATE(Space) template class AppliedForces<Space>;
SCREE_FOR_EACH_SPACE(SCREE_INSTANTIATE)
#undef SCREE_INSTANTIATE

}  // namespace scree
