// The fields of the bodies that a step changes, saved so that the step can be undone.
#pragma once

#include "core/bodies.hpp"

namespace scree {

template <class Space>
struct MovingState {
  Array<Vec3, Space> position, velocity, spin;
  Array<Quat, Space> orientation;

  void save(const Bodies<Space>& bodies) {
    copy(position, bodies.position);
    copy(velocity, bodies.velocity);
    copy(spin, bodies.spin);
    copy(orientation, bodies.orientation);
  }
  void restore(Bodies<Space>& bodies) const {
    copy(bodies.position, position);
    copy(bodies.velocity, velocity);
    copy(bodies.spin, spin);
    copy(bodies.orientation, orientation);
  }
};

}  // namespace scree
