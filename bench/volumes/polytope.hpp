// Volume of a convex polytope that is given by slabs.
#pragma once

#include "core/math.hpp"

#include <vector>

namespace scree::bench {

/// The points x with lo <= direction * x <= hi.
struct Slab {
  Vec3 direction;
  double lo, hi;
};

/// Volume of what the slabs have in common, exact but for rounding. The directions of the first three are
/// independent; 0 if nothing is in all slabs.
double volume_of(const std::vector<Slab>& slabs);

}  // namespace scree::bench
