// What the narrow phase finds: contact points, grouped by pair into manifolds.
#pragma once

#include "core/array.hpp"
#include "core/math.hpp"

#include <cstdint>

namespace scree {

struct ContactPoint {
  Vec3 position;          ///< midway between the two surfaces; the same for both bodies (m)
  double gap;             ///< distance of the surfaces along the normal; negative: penetration (m)
  std::uint32_t feature;  ///< names the features in contact, within pair and part; equal from step to step
                          ///< while they touch
};

/// A contact of one pair: up to 4 points that share a normal.
struct Manifold {
  static constexpr int max_points = 4;

  std::int32_t i;  ///< first body, i < j
  std::int32_t j;
  std::int32_t part = 0;  ///< surface of the pair that it belongs to: of a tube, wall or cap; else 0
  /// Whether the plane of another face may separate the two as well, so that the normal is a choice.
  bool at_edge = false;
  Vec3 normal;    ///< unit, from i to j
  int count = 0;  ///< points in use
  ContactPoint points[max_points];
};

/// A pair has at most this many manifolds: those of a box that just fits into a tube, whose 8 corners touch
/// the wall, each with a normal of its own, and whose ends touch the caps.
inline constexpr int max_pair_manifolds = 10;

}  // namespace scree
