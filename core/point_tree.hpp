// A k-d tree of points (Bentley 1975) that finds those near a segment. The welding of meshes uses it for
// their corners.
#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// A tree that takes O(n log n) to build for any points, including equal ones and single ones far away.
class PointTree {
 public:
  explicit PointTree(std::span<const Vec3> points);

  /// Replaces `found` by the numbers of the points no farther than `reach` (m) from the segment a b, which
  /// may be a point. Their order depends on the points alone.
  void near_segment(const Vec3& a, const Vec3& b, double reach, std::vector<std::int32_t>& found) const;

 private:
  struct Box {
    Vec3 low, high;
  };
  /// Builds node k, with the children 2 k + 1 and 2 k + 2, each with half of its points.
  void build(std::size_t node, std::size_t first, std::size_t count);

  std::vector<std::int32_t> number_;  ///< numbers of the points, in the order of the leaves
  std::vector<Vec3> point_;           ///< points in the same order
  std::vector<Box> box_;              ///< bounding box of each node
};

/// The square of the distance (m^2) of a point from the segment a b, and the nearest point of the segment as
/// a share of the way from a to b.
struct SegmentDistance {
  double square, share;
};
SegmentDistance distance_from_segment(const Vec3& point, const Vec3& a, const Vec3& b);

}  // namespace scree
