#include "core/polygon.hpp"

#include "core/tolerances.hpp"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>

namespace scree {

namespace {

using Vec2 = Eigen::Vector2d;

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x();
}

/// Returns twice the polygon's area along each axis, computed relative to the first corner.
Vec3 newell(std::span<const Vec3> corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    sum += (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
  return sum;
}

/// Returns the corners in the plane across the normal, counterclockwise.
std::vector<Vec2> flattened(std::span<const Vec3> corners, const Vec3& normal) {
  const Vec3 x = tangent_of(normal), y = normal.cross(x);
  std::vector<Vec2> points;
  for (const Vec3& c : corners) points.emplace_back(x.dot(c - corners[0]), y.dot(c - corners[0]));
  return points;
}

class EarCutter {
 public:
  EarCutter(const std::vector<Vec2>& points, double least_area, std::vector<std::array<int, 3>>& out)
      : points_(points), least_(least_area), out_(out), next_(points.size()), previous_(points.size()) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      next_[k] = (k + 1) % points.size();
      previous_[(k + 1) % points.size()] = k;
    }
  }

  bool cut() {
    // Spikes are removed first: beside a spike, a corner that is no ear looks like one.
    if (!visit([this](std::size_t k) { return is_spike(k); })) return true;
    return !visit([this](std::size_t k) {
      if (is_spike(k)) return true;
      if (!is_ear(k)) return false;
      out_.push_back({static_cast<int>(previous_[k]), static_cast<int>(k), static_cast<int>(next_[k])});
      return true;
    });
  }

 private:
  /// Removes corners for which `goes` is true until it is true for none. Returns false if less than three are
  /// left.
  template <class Goes>
  bool visit(Goes&& goes) {
    // A corner that stays may be removable after a neighbour is removed.
    for (std::size_t in_vain = 0; left_ > 2 && in_vain < left_;) {
      const std::size_t before = previous_[at_], after = next_[at_];
      if (goes(at_)) {
        next_[before] = after;
        previous_[after] = before;
        --left_;
        in_vain = 0;
        at_ = before;
      } else {
        ++in_vain;
        at_ = after;
      }
    }
    return left_ > 2;
  }

  double turn_at(std::size_t k) const { return turn(points_[previous_[k]], points_[k], points_[next_[k]]); }

  /// Returns whether the corner is equal to a neighbour or turns straight back: it has no area to cut.
  bool is_spike(std::size_t k) const {
    const Vec2 in = points_[k] - points_[previous_[k]], out = points_[next_[k]] - points_[k];
    return std::abs(turn_at(k)) <= least_ &&
           (in.squaredNorm() == 0 || out.squaredNorm() == 0 || in.dot(out) < 0);
  }

  bool is_ear(std::size_t k) const {
    if (turn_at(k) <= least_) return false;
    const Vec2 &a = points_[previous_[k]], &b = points_[k], &c = points_[next_[k]];
    for (std::size_t p = next_[next_[k]]; p != previous_[k]; p = next_[p]) {
      const Vec2& point = points_[p];
      if (point == a || point == b || point == c) continue;
      if (turn(a, b, point) >= -least_ && turn(b, c, point) >= -least_ && turn(c, a, point) >= -least_)
        return false;
    }
    return true;
  }

  const std::vector<Vec2>& points_;
  double least_;
  std::vector<std::array<int, 3>>& out_;
  std::vector<std::size_t> next_, previous_;
  std::size_t left_ = points_.size(), at_ = 0;
};

void fan(std::size_t corners, std::vector<std::array<int, 3>>& out) {
  for (int k = 1; k + 1 < static_cast<int>(corners); ++k) out.push_back({0, k, k + 1});
}

}  // namespace

bool cut_polygon(std::span<const Vec3> corners, std::vector<std::array<int, 3>>& out) {
  const std::size_t before = out.size();
  const Vec3 area = newell(corners);
  const double length = area.stableNorm();
  if (corners.size() == 3 || !(length > 0) || !std::isfinite(length)) {
    fan(corners.size(), out);
    return true;
  }
  const std::vector<Vec2> points = flattened(corners, area / length);
  const double least = tolerance::flat * length;
  bool is_seen = true;
  for (std::size_t k = 1; k + 1 < points.size() && is_seen; ++k)
    is_seen = turn(points[0], points[k], points[k + 1]) > least;
  if (is_seen) {
    fan(corners.size(), out);
    return true;
  }
  if (EarCutter(points, least, out).cut()) return true;
  out.resize(before);
  fan(corners.size(), out);
  return false;
}

}  // namespace scree
