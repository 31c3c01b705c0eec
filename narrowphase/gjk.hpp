// The distance of two convex bodies that are apart, by Gilbert, Johnson and Keerthi (1988).
#pragma once

#include "narrowphase/convex_body.hpp"

namespace scree {

struct ClosestPoints {
  bool apart = false;   ///< whether the cores are apart; if not, the other members have no meaning
  double distance = 0;  ///< distance of the cores (m)
  Vec3 normal;          ///< unit vector from the first core to the second
  Vec3 on_a, on_b;      ///< closest points of the cores (m)
};

/// Finds the closest points of two cores, the second one moved by `shift` (m). The search is bounded in time
/// and works at any scale, because comparisons are relative to the distance. Cores nearer than `least` (m)
/// count as overlapping. The search ends early once the cores are known to be farther apart than `most` (m):
/// then `distance` is only a lower bound, which exceeds `most`.
ClosestPoints closest_points(const ConvexBody& a, const ConvexBody& b, const Vec3& shift, double least,
                             double most = HUGE_VAL);

}  // namespace scree
