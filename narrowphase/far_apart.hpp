// A look at two bodies that spares the test of most pairs.
#pragma once

#include "core/bodies.hpp"
#include "core/tolerances.hpp"

namespace scree {

/// True if two centres (m) are farther apart than `reach` (m), the sum of the radii around the bodies and of
/// their margins: they cannot have a contact. Not of boundaries, in which other bodies are.
SCREE_HD inline bool are_far_apart(const Vec3& a, const Vec3& b, double reach) {
  return (b - a).squaredNorm() > (1 + tolerance::far_rounding) * reach * reach;
}

}  // namespace scree
