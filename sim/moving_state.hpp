// The fields of the bodies that a step changes, to go back to.
#pragma once

#include "core/bodies.hpp"

#include <vector>

namespace scree {

struct MovingState {
  std::vector<Vec3> position, velocity, spin;
  std::vector<Quat> orientation;

  void save(const Bodies<Host>& bodies) {
    copy(position, bodies.position);
    copy(velocity, bodies.velocity);
    copy(spin, bodies.spin);
    copy(orientation, bodies.orientation);
  }
  void restore(Bodies<Host>& bodies) const {
    copy(bodies.position, position);
    copy(bodies.velocity, velocity);
    copy(bodies.spin, spin);
    copy(bodies.orientation, orientation);
  }
};

}  // namespace scree
