// A cheap early-out test of two bodies, which spares most pairs the full test.
#pragma once

#include "core/bodies.hpp"
#include "core/tolerances.hpp"

namespace scree {

/// Returns whether two centres, the second at `offset` from the first (m), are farther apart than `reach`
/// (m), the sum of the radii around the bodies and of their margins: then they cannot have a contact. It does
/// not apply to boundaries, because other bodies are inside them.
SCREE_HD inline bool are_far_apart(const Vec3& offset, double reach) {
  return offset.squaredNorm() > (1 + tolerance::far_rounding) * reach * reach;
}

}  // namespace scree
