// What in a scene makes it hard to simulate, from the state at the start.
#pragma once

#include "sim/scene/scene.hpp"

namespace scree::cli {

struct Difficulty {
  double speed = 0;          ///< the largest that a body has, or gains by falling through the scene (m/s)
  double fall = 0;           ///< the longest way that a free body can fall before something stops it (m)
  double smallest_size = 0;  ///< radius or half edge, of all spheres and boxes (m); 0: there are none
  double largest_size = 0;   ///< bounding radius, of the free ones (m)
  double least_size = 0;     ///< as smallest_size, of the free ones (m); 0: there are none
  double mass_ratio = 1;     ///< heaviest to lightest free body

  /// How far the fastest body moves in a substep (s), in units of the smallest size.
  double travel(double substep) const { return smallest_size > 0 ? speed * substep / smallest_size : 0; }
};

Difficulty difficulty_of(const Scene& scene);

}  // namespace scree::cli
