#include "bench/volumes/swept_sphere.hpp"

#include <array>

namespace scree::bench {

namespace {

struct Least {
  double at, value;
};

/// Finds the minimum between 0 and `most` of a function with a single one, by golden sections to 1e-5 of the
/// range. For a smooth function this gives its value to rounding.
template <class Function>
Least minimum_of(double most, Function function) {
  constexpr double section = 0.61803398874989485;
  double lo = 0, hi = most;
  Least left{hi - section * (hi - lo), 0}, right{lo + section * (hi - lo), 0};
  left.value = function(left.at), right.value = function(right.at);
  for (int k = 0; k < 24; ++k) {
    if (left.value < right.value) {
      hi = right.at, right = left;
      left.at = hi - section * (hi - lo);
      left.value = function(left.at);
    } else {
      lo = left.at, left = right;
      right.at = lo + section * (hi - lo);
      right.value = function(right.at);
    }
  }
  return left.value < right.value ? left : right;
}

struct Rectangle {
  Vec3 centre, along, across;
  explicit Rectangle(const SweptRectangle& volume)
      : centre(volume.centre.cast<double>()),
        along(volume.along.cast<double>()),
        across(volume.across.cast<double>()) {}

  /// Calls test(p, u) for the edges p + s u, s in [-1, 1], until one passes.
  template <class Test>
  bool any_edge(Test test) const {
    return test(centre + across, along) || test(centre - across, along) || test(centre + along, across) ||
           test(centre - along, across);
  }
};

/// Returns whether all points of the other rectangle are farther than the reach from the plane of a face.
bool is_beyond(const Rectangle& face, const Rectangle& other, double squared_reach) {
  const Vec3 normal = face.along.cross(face.across);
  const double distance = std::fabs(normal.dot(other.centre - face.centre)) -
                          std::fabs(normal.dot(other.along)) - std::fabs(normal.dot(other.across));
  return distance > 0 && distance * distance > squared_reach * normal.squaredNorm();
}

/// Returns whether an edge p + s u, s in [-1, 1], comes within the reach of the inside of a face. Only one
/// point of the edge is tested: the point where it crosses the plane, or the end that is nearest to the
/// plane. If other points of the edge are over the face but this one is not, the edge is nearer to the face's
/// edges.
bool meets_inside(const Rectangle& face, const Vec3& p, const Vec3& u, double squared_reach) {
  const Vec3 normal = face.along.cross(face.across);
  const double height = normal.dot(p - face.centre), rise = normal.dot(u);
  const double s = rise != 0 ? std::clamp(-height / rise, -1.0, 1.0) : 1.0;
  const Vec3 at = p + s * u - face.centre;
  const double distance = height + s * rise;
  return normal.squaredNorm() > 0 && distance * distance <= squared_reach * normal.squaredNorm() &&
         std::fabs(at.dot(face.along)) <= face.along.squaredNorm() &&
         std::fabs(at.dot(face.across)) <= face.across.squaredNorm();
}

}  // namespace

SweptFit fit_swept_sphere(const Vec3& half, bool over_rectangle) {
  std::array<int, 3> axis = {0, 1, 2};
  std::ranges::sort(axis, [&](int a, int b) { return half[a] > half[b]; });
  const double a = half[axis[0]], b = half[axis[1]], c = half[axis[2]];
  const auto radius = [c](double x, double y) { return std::sqrt(x * x + y * y + c * c); };
  const auto best_x = [&](double y) {
    return minimum_of(a, [&](double x) { return swept_volume(a - x, b - y, radius(x, y)); });
  };
  const double y = over_rectangle ? minimum_of(b, [&](double of) { return best_x(of).value; }).at : b;
  const double x = best_x(y).at;
  return {(a - x) * Vec3::Unit(axis[0]), (b - y) * Vec3::Unit(axis[1]), radius(x, y)};
}

bool overlap(const SweptRectangle& volume_a, const SweptRectangle& volume_b) {
  const Rectangle a(volume_a), b(volume_b);
  const double reach = squared_reach(volume_a.radius, volume_b.radius);
  if (is_beyond(a, b, reach) || is_beyond(b, a, reach)) return false;
  // The closest points are on two edges, or one of them is in the inside of a face.
  const auto near_edge = [&](const Vec3& p, const Vec3& u) {
    return b.any_edge([&](const Vec3& q, const Vec3& v) { return squared_distance(p - q, u, v) <= reach; });
  };
  const auto near_a = [&](const Vec3& p, const Vec3& u) { return meets_inside(a, p, u, reach); };
  const auto near_b = [&](const Vec3& p, const Vec3& u) { return meets_inside(b, p, u, reach); };
  return a.any_edge(near_edge) || a.any_edge(near_b) || b.any_edge(near_a);
}

}  // namespace scree::bench
