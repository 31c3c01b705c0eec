// Points in a k-d tree (Bentley 1975), asked for those near a segment: what welding a mesh asks of its
// corners.
#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Takes O(n log n) to build whatever the points are, equal ones and lone far ones included.
class PointTree {
 public:
  explicit PointTree(std::span<const Vec3> points);

  /// Replaces `found` by the numbers of the points no farther than `reach` (m) from the segment a b, which
  /// may be a point; in an order that depends on the points alone.
  void near_segment(const Vec3& a, const Vec3& b, double reach, std::vector<std::int32_t>& found) const;

 private:
  struct Box {
    Vec3 low, high;
  };
  /// Node k has the children 2 k + 1 and 2 k + 2, each with half of its points.
  void build(std::size_t node, std::size_t first, std::size_t count);

  std::vector<std::int32_t> number_;  ///< of the points, as the leaves have them
  std::vector<Vec3> point_;           ///< in the same order
  std::vector<Box> box_;              ///< of each node
};

/// The square of the distance (m^2) of a point from the segment a b, and the share of the way from a to b at
/// which the segment is nearest.
struct SegmentDistance {
  double square, share;
};
SegmentDistance distance_from_segment(const Vec3& point, const Vec3& a, const Vec3& b);

}  // namespace scree
