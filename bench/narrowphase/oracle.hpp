// The reference for the narrow phase: distances of shapes in long double, computed from their definitions and
// not by the narrow phase's formulas.
#pragma once

#include "narrowphase/box_pair.hpp"
#include "narrowphase/tube.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace scree::oracle {

using Real = long double;
using Vec = Eigen::Matrix<Real, 3, 1>;
using Mat = Eigen::Matrix<Real, 3, 3>;

struct Box {
  Vec centre;
  Mat axes;
  Vec half;
  std::array<Vec, 8> vertices;

  explicit Box(const Solid& s)
      : centre(s.position.cast<Real>()),
        axes(s.orientation.cast<Real>().toRotationMatrix()),
        half(s.size.cast<Real>()) {
    for (int c = 0; c < 8; ++c) {
      vertices[c] = centre;
      for (int k = 0; k < 3; ++k) vertices[c] += (c >> k & 1 ? half[k] : -half[k]) * axes.col(k);
    }
  }

  /// Calls action(p, q) for the ends of each of the 12 edges.
  template <class Action>
  void for_each_edge(Action action) const {
    for (int c = 0; c < 8; ++c) {
      for (int k = 0; k < 3; ++k) {
        if (!(c >> k & 1)) action(vertices[c], vertices[c | 1 << k]);
      }
    }
  }
  Vec nearest(const Vec& p) const {
    Vec at = axes.transpose() * (p - centre);
    return centre + axes * at.cwiseMax(-half).cwiseMin(half);
  }
};

/// Returns the distance of the boxes' vertex sets along a direction; it is negative if they overlap.
inline Real separation_along(const Box& a, const Box& b, const Vec& n) {
  const auto shadow = [&](const Box& box) {
    std::pair<Real, Real> range(INFINITY, -INFINITY);
    for (const Vec& v : box.vertices) {
      const Real at = n.dot(v - a.centre);
      range = {std::min(range.first, at), std::max(range.second, at)};
    }
    return range;
  };
  const auto on_a = shadow(a), on_b = shadow(b);
  return std::max(on_b.first - on_a.second, on_a.first - on_b.second);
}

/// Returns the largest separation over the 15 axes. If it is negative, it is minus the penetration depth.
inline Real separation(const Solid& sa, const Solid& sb) {
  const Box a(sa), b(sb);
  Real best = -std::numeric_limits<Real>::infinity();
  for (int i = 0; i < 3; ++i) {
    best = std::max({best, separation_along(a, b, a.axes.col(i)), separation_along(a, b, b.axes.col(i))});
    for (int j = 0; j < 3; ++j) {
      const Vec n = a.axes.col(i).cross(b.axes.col(j));
      if (n.norm() > 1e-9L) best = std::max(best, separation_along(a, b, n.normalized()));
    }
  }
  return best;
}

inline Real segment_distance(const Vec& p0, const Vec& p1, const Vec& q0, const Vec& q1) {
  // The squared distance is convex in the two coordinates. Its minimum is either inside, where the gradient
  // is 0, or on one of the four borders, each of which is a point against a segment.
  const auto to_segment = [](const Vec& p, const Vec& a, const Vec& b) {
    const Real t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), Real(0), Real(1));
    return (p - a - t * (b - a)).norm();
  };
  Real best = std::min(
      {to_segment(p0, q0, q1), to_segment(p1, q0, q1), to_segment(q0, p0, p1), to_segment(q1, p0, p1)});
  const Vec u = p1 - p0, v = q1 - q0, w = q0 - p0;
  const Real det = u.squaredNorm() * v.squaredNorm() - u.dot(v) * u.dot(v);
  if (det > 1e-14L * u.squaredNorm() * v.squaredNorm()) {
    const Real s = (u.dot(w) * v.squaredNorm() - u.dot(v) * v.dot(w)) / det;
    const Real t = (u.dot(v) * u.dot(w) - u.squaredNorm() * v.dot(w)) / det;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, (w + t * v - s * u).norm());
  }
  return best;
}

/// Returns the distance of two boxes that do not overlap: the least of vertices to the other box, and of
/// edges to edges.
inline Real distance(const Solid& sa, const Solid& sb) {
  const Box a(sa), b(sb);
  Real best = INFINITY;
  for (const Vec& v : a.vertices) best = std::min(best, (v - b.nearest(v)).norm());
  for (const Vec& v : b.vertices) best = std::min(best, (v - a.nearest(v)).norm());
  a.for_each_edge([&](const Vec& p0, const Vec& p1) {
    b.for_each_edge(
        [&](const Vec& q0, const Vec& q1) { best = std::min(best, segment_distance(p0, p1, q0, q1)); });
  });
  return best;
}

/// Returns by how much a preferred axis may overlap more than the best one, which separates the boxes by
/// `separation`. The preference is a share of the preferred overlap, not of the best.
inline double most_given_away(double separation, double smallest) {
  return preference(separation, smallest) / (1 - tolerance::axis_preference);
}

/// Returns the signed distance of a point from a box's surface, and sets the nearest point of it. Each of the
/// 6 faces is tried as a rectangle.
inline Real to_surface(const Box& box, const Vec& p, Vec& nearest) {
  const Vec local = box.axes.transpose() * (p - box.centre);
  Real best = INFINITY;
  for (int k = 0; k < 3; ++k) {
    for (const Real side : {-1, 1}) {
      Vec on = local.cwiseMax(-box.half).cwiseMin(box.half);
      on[k] = side * box.half[k];
      if ((local - on).norm() >= best) continue;
      best = (local - on).norm();
      nearest = box.centre + box.axes * on;
    }
  }
  const bool inside = (local.cwiseAbs() - box.half).maxCoeff() < 0;
  return inside ? -best : best;
}

/// Returns the height of a point over a plane.
inline Real height(const Solid& plane, const Vec& p) {
  return (plane.orientation.cast<Real>() * Vec::UnitZ()).dot(p - plane.position.cast<Real>());
}

/// The surfaces of a tube by their definitions.
struct Tube {
  Vec centre, axis;
  Real radius, half;

  explicit Tube(const Solid& s)
      : centre(s.position.cast<Real>()),
        axis(s.orientation.cast<Real>().toRotationMatrix().col(2)),
        radius(s.size.x()),
        half(s.size.z()) {}

  /// Returns the distance of a point inside from the surface; it is negative beyond the surface.
  Real distance(int part, const Vec& p) const {
    const Vec offset = p - centre;
    if (part == tube_wall) return radius - offset.cross(axis).norm();
    return half + (part == tube_cap_below ? 1 : -1) * axis.dot(offset);
  }
  /// Returns the direction in which the surface is nearest.
  Vec outward(int part, const Vec& p) const {
    if (part == tube_wall) return (p - centre - axis * axis.dot(p - centre)).normalized();
    return part == tube_cap_below ? Vec(-axis) : axis;
  }
  /// Returns the depth of a point in the tube grown by the margin. It is at least 0 if the tube holds a body
  /// with this centre.
  Real depth(const Vec& p, double margin) const {
    return margin +
           std::min({distance(tube_wall, p), distance(tube_cap_below, p), distance(tube_cap_above, p)});
  }
};

}  // namespace scree::oracle
