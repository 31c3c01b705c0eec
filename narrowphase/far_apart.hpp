// A look at two bodies that spares the test of most pairs.
#pragma once

#include "core/bodies.hpp"
#include "core/tolerances.hpp"

namespace scree {

/// True if two centres, one `offset` from the other (m), are farther apart than `reach` (m), the sum of the
/// radii around the bodies and of their margins: they cannot have a contact. Not of boundaries, in which
/// other bodies are.
SCREE_HD inline bool are_far_apart(const Vec3& offset, double reach) {
  return offset.squaredNorm() > (1 + tolerance::far_rounding) * reach * reach;
}

}  // namespace scree
