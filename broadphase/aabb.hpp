// Formulas for closed float boxes, shared by all broad phases.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/space.hpp"

#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>

namespace scree {

/// Returns the empty box, which is the bounds of a body that takes no part in the broad phase (a plane, or an
/// absent body). No other box may be infinite or inverted.
SCREE_HD constexpr Aabb absent_bounds() {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}

SCREE_HD inline bool is_absent(const Aabb& box) {
  const Aabb absent = absent_bounds();
  for (int a = 0; a < 3; ++a) {
    if (box.lo[a] != absent.lo[a] || box.hi[a] != absent.hi[a]) return false;
  }
  return true;
}

/// Returns true for a finite box that is not inverted; a point counts as a box. Comparisons with NaN fail, so
/// NaN is refused.
SCREE_HD inline bool is_proper(const Aabb& box) {
  for (int a = 0; a < 3; ++a) {
    if (!(box.lo[a] >= -FLT_MAX && box.lo[a] <= box.hi[a] && box.hi[a] <= FLT_MAX)) return false;
  }
  return true;
}

/// Returns whether two boxes overlap. All six comparisons are made at once, because it cannot be predicted
/// which of them separates two boxes.
SCREE_HD inline bool overlap(const Aabb& a, const Aabb& b) {
  return (a.lo[0] <= b.hi[0]) & (b.lo[0] <= a.hi[0]) & (a.lo[1] <= b.hi[1]) & (b.lo[1] <= a.hi[1]) &
         (a.lo[2] <= b.hi[2]) & (b.lo[2] <= a.hi[2]);
}

/// Returns a coordinate of the centre, to double rounding (m).
SCREE_HD inline double centre_of(const Aabb& box, int axis) {
  return 0.5 * (static_cast<double>(box.lo[axis]) + static_cast<double>(box.hi[axis]));
}

/// Returns the largest of the three extents, to float rounding (m). Objects are sorted into levels by this
/// size.
SCREE_HD inline float extent_of(const Aabb& box) {
  double largest = 0;
  for (int a = 0; a < 3; ++a) {
    const double extent = static_cast<double>(box.hi[a]) - static_cast<double>(box.lo[a]);
    largest = extent > largest ? extent : largest;
  }
  return largest < static_cast<double>(FLT_MAX) ? static_cast<float>(largest) : FLT_MAX;
}

/// Returns a pair in canonical order.
SCREE_HD inline Pair pair_of(std::int32_t a, std::int32_t b) { return a < b ? Pair{a, b} : Pair{b, a}; }

}  // namespace scree
