#include "bench/narrowphase/convex_oracle.hpp"

#include <algorithm>

namespace scree::oracle {

Convex::Convex(const ShapedSolid& body, const Hull* hull, const Vec3& origin)
    : centre(body.solid.position.cast<Real>() - origin.cast<Real>()) {
  const Mat axes = body.solid.orientation.cast<Real>().toRotationMatrix();
  const Vec size = body.solid.size.cast<Real>();
  axis = axes.col(2);
  switch (body.shape) {
    case Shape::sphere:
      radius = size.x();
      points.push_back(centre);
      return;
    case Shape::capsule:
      radius = size.x();
      for (const Real side : {-1, 1}) points.push_back(centre + side * (size.z() - size.x()) * axis);
      edges = {{0, 1}};
      return;
    case Shape::cylinder:
      cylinder = true;
      disc = size.x();
      half = size.z();
      normals = {axis, -axis};
      return;
    case Shape::box:
      for (int c = 0; c < 8; ++c) {
        Vec at = centre;
        for (int k = 0; k < 3; ++k) at += (c >> k & 1 ? size[k] : -size[k]) * axes.col(k);
        points.push_back(at);
        for (int k = 0; k < 3; ++k)
          if (!(c >> k & 1)) edges.emplace_back(c, c | 1 << k);
      }
      for (int k = 0; k < 3; ++k)
        for (const int side : {0, 1}) {
          normals.push_back((side ? 1 : -1) * axes.col(k));
          const int i = 1 << (k + 1) % 3, j = 1 << (k + 2) % 3, base = side << k;
          faces.push_back({base, base | i, base | i | j, base | j});
        }
      return;
    default:
      break;
  }
  for (const Vec3& v : hull->vertices) points.push_back(centre + axes * v.cast<Real>());
  for (const Hull::Edge& e : hull->edges) edges.emplace_back(e.from, e.to);
  for (const Hull::Face& f : hull->faces) {
    const std::span<const int> corners = hull->corners_of(f);
    faces.emplace_back(corners.begin(), corners.end());
    Vec sum = Vec::Zero();
    const Vec& first = points[static_cast<std::size_t>(corners[0])];
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      sum += (points[static_cast<std::size_t>(corners[k])] - first)
                 .cross(points[static_cast<std::size_t>(corners[k + 1])] - first);
    normals.push_back(sum.normalized());
  }
}

Real Convex::reach(const Vec& n) const {
  if (cylinder) {
    const Real along = axis.dot(n);
    return n.dot(centre) + half * std::fabs(along) + disc * (n - along * axis).norm();
  }
  Real most = -INFINITY;
  for (const Vec& p : points) most = std::max(most, p.dot(n));
  return most + radius;
}

std::vector<Vec> Convex::lines() const {
  if (cylinder) return {axis};
  std::vector<Vec> all;
  for (const auto& [from, to] : edges)
    all.push_back(
        (points[static_cast<std::size_t>(to)] - points[static_cast<std::size_t>(from)]).normalized());
  return all;
}

Real separation_along(const Convex& a, const Convex& b, const Vec& n) { return -b.reach(-n) - a.reach(n); }

namespace {

/// Returns the largest of many values of a function of one argument on a circle, or `known` if that is
/// larger. `steepest` is a bound of the function's slope per radian.
template <class Function>
Real largest_on_circle(Function f, Real known, Real steepest) {
  constexpr int samples = 128, most_refined = 4;
  constexpr Real step = 2 * 3.14159265358979323846L / samples;
  std::array<Real, samples> at;
  for (int k = 0; k < samples; ++k) at[static_cast<std::size_t>(k)] = f(k * step);
  std::vector<std::pair<Real, int>> tops;
  for (int k = 0; k < samples; ++k) {
    const Real here = at[static_cast<std::size_t>(k)];
    if (here >= at[static_cast<std::size_t>((k + 1) % samples)] &&
        here >= at[static_cast<std::size_t>((k + samples - 1) % samples)])
      tops.emplace_back(here, k);
  }
  std::sort(tops.rbegin(), tops.rend());
  Real best = known;
  for (std::size_t t = 0; t < std::min<std::size_t>(tops.size(), most_refined); ++t) {
    if (tops[t].first + steepest * step < best) break;
    Real low = (tops[t].second - 1) * step, high = (tops[t].second + 1) * step;
    constexpr Real golden = 0.618033988749894848L;
    Real left = high - golden * (high - low), right = low + golden * (high - low);
    Real at_left = f(left), at_right = f(right);
    for (int k = 0; k < 70; ++k) {
      if (at_left < at_right) {
        low = left, left = right, at_left = at_right;
        right = low + golden * (high - low), at_right = f(right);
      } else {
        high = right, right = left, at_right = at_left;
        left = high - golden * (high - low), at_left = f(left);
      }
    }
    best = std::max({best, at_left, at_right});
  }
  return best;
}

std::pair<Vec, Vec> across(const Vec& line) {
  const Vec u = line.unitOrthogonal();
  return {u, line.cross(u)};
}

/// Returns the distance of a body's farthest point from its centre.
Real extent(const Convex& body) {
  Real most = std::hypot(body.disc, body.half);
  for (const Vec& p : body.points) most = std::max(most, (p - body.centre).norm());
  return most;
}

Real largest_across(const Convex& a, const Convex& b, const Vec& line, Real known) {
  const auto [u, v] = across(line);
  return largest_on_circle(
      [&, u = u, v = v](Real t) { return separation_along(a, b, std::cos(t) * u + std::sin(t) * v); }, known,
      (b.centre - a.centre).norm() + extent(a) + extent(b));
}

/// Climbs from a direction until steps as small as rounding no longer increase the separation, and returns
/// it. On a ridge, which other searches cover, it may stop before the top.
Real climb(const Convex& a, const Convex& b, Vec n) {
  Real best = separation_along(a, b, n);
  constexpr int most_steps = 600;
  Real step = 0.1L;
  for (int m = 0; m < most_steps && step > 1e-11L; ++m) {
    const auto [u, v] = across(n);
    Vec next = n;
    for (int k = 0; k < 8; ++k) {
      const Real angle = k * 0.785398163397448309616L;
      const Vec to = (n + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
      const Real s = separation_along(a, b, to);
      if (s > best) best = s, next = to;
    }
    if (next == n) step *= 0.5L;
    n = next;
  }
  return best;
}

Real largest_of_all(const Convex& a, const Convex& b) {
  constexpr int samples = 400, most_climbed = 8;
  std::vector<std::pair<Real, Vec>> at;
  for (int k = 0; k < samples; ++k) {  // a spiral of equal areas
    const Real z = 1 - (2 * k + 1) / Real(samples), r = std::sqrt(1 - z * z), t = 2.39996322972865332L * k;
    const Vec n(r * std::cos(t), r * std::sin(t), z);
    at.emplace_back(separation_along(a, b, n), n);
  }
  std::sort(at.begin(), at.end(), [](const auto& p, const auto& q) { return p.first > q.first; });
  std::vector<Vec> starts;
  for (const auto& [s, n] : at) {
    if (starts.size() == most_climbed) break;
    if (std::all_of(starts.begin(), starts.end(), [&n = n](const Vec& m) { return m.dot(n) < 0.95L; }))
      starts.push_back(n);
  }
  Real best = -INFINITY;
  for (const Vec& n : starts) best = std::max(best, climb(a, b, n));
  return best;
}

/// Returns the distance of a point from a polygon with a unit normal. It is infinite if the foot of the point
/// is not inside the polygon, because the distances from the edges cover that case.
Real to_face(const Convex& body, std::size_t face, const Vec& p) {
  const std::vector<int>& corners = body.faces[face];
  const Vec& normal = body.normals[face];
  const auto at = [&](std::size_t k) -> const Vec& {
    return body.points[static_cast<std::size_t>(corners[k % corners.size()])];
  };
  int left = 0, right = 0;
  for (std::size_t k = 0; k < corners.size(); ++k)
    (normal.dot((at(k + 1) - at(k)).cross(p - at(k))) < 0 ? right : left) += 1;
  return left > 0 && right > 0 ? INFINITY : std::fabs(normal.dot(p - at(0)));
}

/// Returns the distance of the surfaces of two cores that consist of points, edges and faces.
Real core_distance(const Convex& a, const Convex& b) {
  Real best = INFINITY;
  for (const Vec& p : a.points)
    for (const Vec& q : b.points) best = std::min(best, (p - q).norm());
  const auto end = [](const Convex& c, int k) { return c.points[static_cast<std::size_t>(k)]; };
  for (const auto& [p0, p1] : a.edges)
    for (const auto& [q0, q1] : b.edges)
      best = std::min(best, segment_distance(end(a, p0), end(a, p1), end(b, q0), end(b, q1)));
  for (const auto& [body, other] : {std::pair{&a, &b}, std::pair{&b, &a}})
    for (const Vec& p : body->points) {
      for (std::size_t f = 0; f < other->faces.size(); ++f) best = std::min(best, to_face(*other, f, p));
      for (const auto& [from, to] : other->edges) {
        const Vec q = end(*other, from), way = end(*other, to) - q;
        best = std::min(
            best, (p - q - std::clamp(way.dot(p - q) / way.squaredNorm(), Real(0), Real(1)) * way).norm());
      }
    }
  return best;
}

/// Returns the distance of a point from a cylinder; 0 inside.
Real to_cylinder(const Convex& cylinder, const Vec& p) {
  const Vec d = p - cylinder.centre;
  const Real along = cylinder.axis.dot(d);
  return std::hypot(std::max((d - along * cylinder.axis).norm() - cylinder.disc, Real(0)),
                    std::max(std::fabs(along) - cylinder.half, Real(0)));
}

/// Returns the distance of a point or a segment from a cylinder. It is a convex function of the place on the
/// segment.
Real core_to_cylinder(const Convex& round, const Convex& cylinder) {
  if (round.points.size() == 1) return to_cylinder(cylinder, round.points[0]);
  const Vec from = round.points[0], way = round.points[1] - from;
  Real low = 0, high = 1, least = INFINITY;
  for (int k = 0; k < 120 && least > 0; ++k) {
    const Real third = (high - low) / 3;
    const Real left = to_cylinder(cylinder, from + (low + third) * way);
    const Real right = to_cylinder(cylinder, from + (high - third) * way);
    least = std::min({least, left, right});
    if (left < right) {
      high -= third;
    } else {
      low += third;
    }
  }
  return least;
}

}  // namespace

Real separation(const Convex& a, const Convex& b) {
  Real best = -INFINITY;
  const auto take = [&](const Vec& n) { best = std::max(best, separation_along(a, b, n)); };
  for (const Vec& n : a.normals) take(n);
  for (const Vec& n : b.normals) take(-n);
  const std::vector<Vec> lines_a = a.lines(), lines_b = b.lines();
  for (const Vec& u : lines_a)
    for (const Vec& v : lines_b) {
      const Vec n = u.cross(v);
      if (n.norm() < 1e-12L) continue;
      take(n.normalized());
      take(-n.normalized());
    }
  if (a.cylinder || b.cylinder) {
    for (const Vec& line : lines_a) best = largest_across(a, b, line, best);
    for (const Vec& line : lines_b) best = largest_across(a, b, line, best);
  }
  if (a.cylinder && b.cylinder) best = std::max(best, largest_of_all(a, b));
  if (a.radius > 0 || b.radius > 0) {
    // No direction separates the cores by more than the distance of their surfaces.
    const Real distance = a.cylinder   ? core_to_cylinder(b, a)
                          : b.cylinder ? core_to_cylinder(a, b)
                                       : core_distance(a, b);
    const Real radii = a.radius + b.radius;
    // Points and segments are never inside one another. If a core has faces, one of the directions above
    // separates cores that are apart.
    const bool apart = a.cylinder || b.cylinder
                           ? distance > 0
                           : (a.normals.empty() && b.normals.empty()) || best + radii >= 0;
    if (apart) best = std::max(best, distance - radii);
  }
  return best;
}

}  // namespace scree::oracle
