// What the narrow phase finds: contact points, grouped by pair into manifolds.
#pragma once

#include "core/math.hpp"

#include <cstdint>

namespace scree {

struct ContactPoint {
  Vec3 position;          ///< midway between the two surfaces; the same for both bodies (m)
  double gap;             ///< distance of the surfaces along the normal; negative: penetration (m)
  std::uint32_t feature;  ///< names the features in contact; equal from step to step while they touch
};

/// The contact of one pair: up to 4 points that share a normal.
struct Manifold {
  static constexpr int max_points = 4;

  std::int32_t i;  ///< first body, i < j
  std::int32_t j;
  Vec3 normal;    ///< unit, from i to j
  int count = 0;  ///< points in use
  ContactPoint points[max_points];
};

}  // namespace scree
