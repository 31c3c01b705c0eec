// Random orientations.
#pragma once

#include "core/math.hpp"
#include "core/rng.hpp"

namespace scree {

/// Returns an orientation with uniform distribution over all rotations (Shoemake 1992, "Uniform random
/// rotations", Graphics Gems III).
SCREE_HD inline Quat random_orientation(Random& random) {
  const double u = random.uniform();
  const double a = 2 * pi * random.uniform();
  const double b = 2 * pi * random.uniform();
  const double s = sqrt(1 - u);
  const double t = sqrt(u);
  return Quat(t * cos(b), s * sin(a), s * cos(a), t * sin(b));
}

}  // namespace scree
