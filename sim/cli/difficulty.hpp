// The properties of a scene that make it hard to simulate, from its state at the start.
#pragma once

#include "sim/scene/scene.hpp"

namespace scree::cli {

struct Difficulty {
  double speed = 0;          ///< largest speed that a body has, or gains by falling during the run (m/s)
  double fall = 0;           ///< longest way that a free body can fall during the run until it is stopped (m)
  double smallest_size = 0;  ///< smallest radius or half edge of all but surfaces (m); 0: there are none
  double largest_size = 0;   ///< largest bounding radius of the free bodies (m)
  double least_size = 0;     ///< smallest radius or half edge of the free bodies (m); 0: there are none
  double mass_ratio = 1;     ///< mass of the heaviest free body / mass of the lightest one

  /// Returns how far the fastest body moves in a substep (s), in units of the smallest size.
  double travel(double substep) const { return smallest_size > 0 ? speed * substep / smallest_size : 0; }
};

Difficulty difficulty_of(const Scene& scene);

}  // namespace scree::cli
