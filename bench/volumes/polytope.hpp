// The volume of a convex polytope that is given by slabs.
#pragma once

#include "core/math.hpp"

#include <vector>

namespace scree::bench {

/// The set of points x with lo <= direction * x <= hi.
struct Slab {
  Vec3 direction;
  double lo, hi;
};

/// Returns the volume of the intersection of the slabs, exact to rounding; 0 if it is empty. The directions
/// of the first three slabs must be independent.
double volume_of(const std::vector<Slab>& slabs);

}  // namespace scree::bench
