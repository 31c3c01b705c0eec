// What the narrow phase is held against: boxes in long double, by definitions and not by its formulas; and
// the families of random and degenerate pairs.
#pragma once

#include "core/rng.hpp"
#include "narrowphase/box_pair.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace scree::oracle {

using Real = long double;
using Vec = Eigen::Matrix<Real, 3, 1>;
using Mat = Eigen::Matrix<Real, 3, 3>;

struct Box {
  Vec centre;
  Mat axes;
  Vec half;

  explicit Box(const Solid& s)
      : centre(s.position.cast<Real>()),
        axes(s.orientation.cast<Real>().toRotationMatrix()),
        half(s.size.cast<Real>()) {}

  std::array<Vec, 8> vertices() const {
    std::array<Vec, 8> all;
    for (int c = 0; c < 8; ++c) {
      all[c] = centre;
      for (int k = 0; k < 3; ++k) all[c] += (c >> k & 1 ? half[k] : -half[k]) * axes.col(k);
    }
    return all;
  }
  /// The 12 edges as pairs of vertex numbers.
  static std::vector<std::array<int, 2>> edges() {
    std::vector<std::array<int, 2>> all;
    for (int c = 0; c < 8; ++c) {
      for (int k = 0; k < 3; ++k) {
        if (!(c >> k & 1)) all.push_back({c, c | 1 << k});
      }
    }
    return all;
  }
  Vec nearest(const Vec& p) const {
    Vec at = axes.transpose() * (p - centre);
    return centre + axes * at.cwiseMax(-half).cwiseMin(half);
  }
};

/// Distance of the boxes' vertex sets along a direction, negative if they overlap.
inline Real separation_along(const Box& a, const Box& b, const Vec& n) {
  Real lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY};
  const Box* boxes[2] = {&a, &b};
  for (int k = 0; k < 2; ++k) {
    for (const Vec& v : boxes[k]->vertices()) {
      const Real at = n.dot(v - a.centre);
      lo[k] = std::min(lo[k], at);
      hi[k] = std::max(hi[k], at);
    }
  }
  return std::max(lo[1] - hi[0], lo[0] - hi[1]);
}

/// Largest separation over the 15 axes: minus the penetration depth, if negative.
inline Real separation(const Solid& sa, const Solid& sb) {
  const Box a(sa), b(sb);
  Real best = -INFINITY;
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
  // The squared distance is convex in the two coordinates: its minimum is in the inside, where the gradient
  // is 0, or on one of the four borders, each a point against a segment.
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

/// Distance of two boxes that do not overlap: of vertices to the other box, and of edges.
inline Real distance(const Solid& sa, const Solid& sb) {
  const Box a(sa), b(sb);
  const auto va = a.vertices(), vb = b.vertices();
  Real best = INFINITY;
  for (const Vec& v : va) best = std::min(best, (v - b.nearest(v)).norm());
  for (const Vec& v : vb) best = std::min(best, (v - a.nearest(v)).norm());
  for (const auto& e : Box::edges()) {
    for (const auto& f : Box::edges()) {
      best = std::min(best, segment_distance(va[e[0]], va[e[1]], vb[f[0]], vb[f[1]]));
    }
  }
  return best;
}

// ---- Families of pairs ----

struct PairOfBoxes {
  Solid a, b;
  double length;  ///< largest half extent: what rounding is relative to
};

inline Vec3 random_unit(Random& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(0, 2 * pi), r = std::sqrt(1 - z * z);
  return Vec3(r * std::cos(angle), r * std::sin(angle), z);
}

inline Quat random_turn(Random& random) { return rotation_of(random.uniform(0, pi) * random_unit(random)); }

enum class Family {
  any,
  aligned,
  yaw,
  tilted,
  crossed_edges,
  vertex,
  size_ratio,
  coincident,
  tiny,
  huge,
  count
};

inline const char* name_of(Family family) {
  constexpr const char* names[] = {"any",    "aligned",    "yaw",        "tilted", "crossed edges",
                                   "vertex", "size ratio", "coincident", "tiny",   "huge"};
  return names[static_cast<int>(family)];
}

/// Item `n` of a family; the boxes are within a fifth of their size of touching, on either side.
inline PairOfBoxes make_pair(Family family, std::uint64_t n) {
  Random random(static_cast<std::uint64_t>(family) + 100, n);
  const auto extents = [&random] {
    const auto one = [&random] { return std::exp2(random.uniform(-2, 0)); };
    const double x = one(), y = one(), z = one();
    return Vec3(x, y, z);
  };
  Solid a{Vec3::Zero(), random_turn(random), extents()};
  Solid b{Vec3::Zero(), random_turn(random), extents()};
  Vec3 direction = random_unit(random);
  const Vec3 axis = random_unit(random);
  switch (family) {
    case Family::aligned:
      a.orientation = b.orientation = Quat::Identity();
      if (n % 2) a.size = b.size = Vec3::Constant(0.5);
      if (n % 3) direction = Vec3::Unit(static_cast<int>(n % 3));
      break;
    case Family::yaw:
      a.orientation = Quat::Identity();
      b.orientation = rotation_of(random.uniform(0, pi) * Vec3::UnitZ());
      if (n % 2) direction = Vec3::UnitZ();
      break;
    case Family::tilted: {
      const double tilt = std::pow(10.0, -1.0 - static_cast<double>(n % 12));
      a.orientation = Quat::Identity();
      b.orientation = rotation_of(tilt * axis);
      if (n % 2) direction = (Vec3::UnitZ() + tilt * direction).normalized();
      if (n % 5 == 0) b.size = a.size;
      break;
    }
    case Family::crossed_edges: {  // edge over edge, at any angle down to parallel
      const double angle = n % 2 ? random.uniform(0, pi / 2) : std::pow(10.0, -random.uniform(1, 12));
      a.orientation = rotation_of(pi / 4 * Vec3::UnitX());
      b.orientation = rotation_of(angle * Vec3::UnitZ()) * rotation_of(pi / 4 * Vec3::UnitX());
      direction = Vec3::UnitZ();
      break;
    }
    case Family::vertex:
      a.orientation = Quat::FromTwoVectors(a.size, Vec3::UnitZ());
      b.orientation = Quat::FromTwoVectors(b.size, n % 2 ? Vec3::UnitZ() : axis);
      direction = Vec3::UnitZ();
      break;
    case Family::size_ratio:
      a.size *= 1000;
      a.size.z() *= n % 2 ? 1e-3 : 1;
      if (n % 3 == 0) a.orientation = Quat::Identity(), direction = Vec3::UnitZ();
      break;
    case Family::coincident:
      direction.setZero();
      break;
    case Family::tiny:
      a.size *= 1e-6;
      b.size *= 1e-6;
      break;
    case Family::huge:
      a.size *= 1e6;
      b.size *= 1e6;
      break;
    case Family::any:
    case Family::count:
      break;
  }
  // Bisect for the offset at which they touch, then go a little to either side of it, or stay. The axes
  // tested here only place the boxes: what they must be is asked of the oracle.
  const double smaller = std::min(a.size.maxCoeff(), b.size.maxCoeff());
  double near = 0, far = 2 * (a.size.norm() + b.size.norm());
  for (int k = 0; k < 25; ++k) {
    const double middle = 0.5 * (near + far);
    b.position = middle * direction;
    (separating_axes(BoxPair(a, b), HUGE_VAL).separation < 0 ? near : far) = middle;
  }
  const double steps[] = {0, 1e-9, 1e-6, 1e-4, 1e-2, 0.2};
  b.position = (near + random.uniform(-1, 1) * smaller * steps[n % 6]) * direction;
  const Vec3 away = smaller * random.uniform(-100, 100) * axis;
  a.position += away;
  b.position += away;
  return {a, b, std::max(a.size.maxCoeff(), b.size.maxCoeff())};
}

/// By how much a preferred axis may overlap more than the best one, which separates the boxes by
/// `separation`: the preference is a share of the preferred overlap, not of the best.
inline double most_given_away(double separation, double smallest) {
  return preference(separation, smallest) / (1 - tolerance::axis_preference);
}

}  // namespace scree::oracle
