// The results of the narrow phase: contact points, grouped into manifolds, of which each belongs to one pair.
#pragma once

#include "core/array.hpp"
#include "core/math.hpp"

#include <cstdint>

namespace scree {

struct ContactPoint {
  Vec3 position;          ///< midway between the two surfaces; the same for both bodies (m)
  double gap;             ///< distance of the surfaces along the normal; negative: penetration (m)
  std::uint32_t feature;  ///< name of the two features in contact, within pair and part; it stays equal from
                          ///< step to step while they touch
};

/// A contact of one pair: up to 4 points that share a normal.
struct Manifold {
  static constexpr int max_points = 4;

  std::int32_t i;  ///< first body of the pair, i < j
  std::int32_t j;
  std::int32_t part = 0;  ///< surface of the pair that the manifold belongs to: wall or cap of a tube; else 0
  /// Whether the plane of another face may separate the two bodies as well, so that the normal is a choice.
  bool at_edge = false;
  Vec3 normal;    ///< unit vector from i to j
  int count = 0;  ///< number of points in use
  ContactPoint points[max_points];
};

/// Largest number of manifolds of a pair. It is reached by a box that just fits into a tube: its 8 corners
/// touch the wall, each with its own normal, and its ends touch the two caps.
inline constexpr int max_pair_manifolds = 10;

}  // namespace scree
