// The distance of two convex bodies that are apart, by Gilbert, Johnson and Keerthi (1988).
#pragma once

#include "narrowphase/convex_body.hpp"

namespace scree {

struct ClosestPoints {
  bool apart = false;   ///< else nothing else is meant
  double distance = 0;  ///< of the cores (m)
  Vec3 normal;          ///< unit, from the first to the second
  Vec3 on_a, on_b;      ///< of the cores
};

/// Of the cores, the second one moved by `shift` (m). Bounded in time, and of any scale: comparisons are
/// relative to the distance. Overlaps are those nearer than `least` (m).
/// Once they are known to be farther apart than `most` (m) it gives up: then `distance` is no more than a
/// bound, and beyond that.
ClosestPoints closest_points(const ConvexBody& a, const ConvexBody& b, const Vec3& shift, double least,
                             double most = HUGE_VAL);

}  // namespace scree
