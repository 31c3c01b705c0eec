#include "core/point_tree.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace scree {

namespace {

constexpr std::size_t leaf = 8;  ///< number of points that are tested one by one

/// Returns whether part of the segment is in the box; may return true for a segment that is just outside.
bool may_cross(const Vec3& a, const Vec3& way, const Vec3& low, const Vec3& high) {
  double enter = 0, leave = 1;
  for (int k = 0; k < 3; ++k) {
    if (way[k] == 0) {
      if (a[k] < low[k] || a[k] > high[k]) return false;
      continue;
    }
    const double first = (low[k] - a[k]) / way[k], second = (high[k] - a[k]) / way[k];
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  return enter <= leave;
}

}  // namespace

SegmentDistance distance_from_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a, to = point - a;
  const double square = way.squaredNorm();
  const double share = square > 0 ? std::clamp(way.dot(to) / square, 0.0, 1.0) : 0.0;
  return {(to - share * way).squaredNorm(), share};
}

PointTree::PointTree(std::span<const Vec3> points)
    : number_(points.size()), point_(points.begin(), points.end()) {
  if (points.empty()) return;
  std::iota(number_.begin(), number_.end(), 0);
  std::size_t nodes = 1;
  for (std::size_t most = points.size(); most > leaf; most = (most + 1) / 2) nodes = 2 * nodes + 1;
  box_.resize(nodes);
  build(0, 0, points.size());
  for (std::size_t k = 0; k < number_.size(); ++k) point_[k] = points[static_cast<std::size_t>(number_[k])];
}

void PointTree::build(std::size_t node, std::size_t first, std::size_t count) {
  const auto at = [this](std::int32_t k) -> const Vec3& { return point_[static_cast<std::size_t>(k)]; };
  Box& box = box_[node];
  box.low = box.high = at(number_[first]);
  for (std::size_t k = first; k < first + count; ++k) {
    box.low = box.low.cwiseMin(at(number_[k]));
    box.high = box.high.cwiseMax(at(number_[k]));
  }
  if (count <= leaf) return;
  int axis = 0;
  (box.high - box.low).maxCoeff(&axis);
  const auto begin = number_.begin() + static_cast<std::ptrdiff_t>(first);
  const std::size_t half = count / 2;
  // Equal places are ordered by their numbers, so that the halves are the same on every machine.
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(half),
                   begin + static_cast<std::ptrdiff_t>(count), [&](std::int32_t p, std::int32_t q) {
                     return at(p)[axis] != at(q)[axis] ? at(p)[axis] < at(q)[axis] : p < q;
                   });
  build(2 * node + 1, first, half);
  build(2 * node + 2, first + half, count - half);
}

void PointTree::near_segment(const Vec3& a, const Vec3& b, double reach,
                             std::vector<std::int32_t>& found) const {
  found.clear();
  if (point_.empty()) return;
  struct Range {
    std::size_t node, first, count;
  };
  std::array<Range, 64> open;  // one branch for each halving at most
  std::size_t depth = 0;
  open[depth++] = {0, 0, point_.size()};
  const Vec3 way = b - a;
  const double square = reach * reach;
  while (depth > 0) {
    const Range range = open[--depth];
    const Box& box = box_[range.node];
    if (!may_cross(a, way, box.low.array() - reach, box.high.array() + reach)) continue;
    if (range.count <= leaf) {
      for (std::size_t k = range.first; k < range.first + range.count; ++k)
        if (distance_from_segment(point_[k], a, b).square <= square) found.push_back(number_[k]);
      continue;
    }
    const std::size_t half = range.count / 2;
    open[depth++] = {2 * range.node + 2, range.first + half, range.count - half};
    open[depth++] = {2 * range.node + 1, range.first, half};
  }
}

}  // namespace scree
