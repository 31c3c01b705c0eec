// The distance of two convex bodies by GJK. The point of the simplex nearest to the origin is found by
// regions (Ericson 2005, sections 5.1.5 and 5.1.6).
#include "narrowphase/gjk.hpp"

#include "core/tolerances.hpp"

#include <array>

namespace scree {

namespace {

/// The difference of a point of the second body and a point of the first.
struct Difference {
  Vec3 at, on_a, on_b;
};

/// The points of a simplex, and the weights with which they give its point nearest to the origin.
struct Simplex {
  int count = 0;
  std::array<Difference, 4> point;
  std::array<double, 4> weight{};

  Vec3 nearest() const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < count; ++k)
      sum += weight[static_cast<std::size_t>(k)] * point[static_cast<std::size_t>(k)].at;
    return sum;
  }
};

struct Part {
  int count;
  std::array<int, 3> of;
  std::array<double, 3> weight;
};

Part nearest_of_segment(const Vec3& a, const Vec3& b, int i, int j) {
  const Vec3 way = b - a;
  const double length = way.squaredNorm();
  const double t = length > 0 ? -a.dot(way) / length : 0.0;
  if (t <= 0) return {1, {i}, {1}};
  if (t >= 1) return {1, {j}, {1}};
  return {2, {i, j}, {1 - t, t}};
}

Part nearest_of_triangle(const Vec3& a, const Vec3& b, const Vec3& c, int i, int j, int k) {
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 normal = ab.cross(ac);
  // These volumes of small vectors show on which side of each edge the origin is, and keep their digits.
  const double wa = normal.dot(b.cross(c)), wb = normal.dot(c.cross(a)), wc = normal.dot(a.cross(b));
  const double sum = wa + wb + wc;
  if (sum > 0 && wa > 0 && wb > 0 && wc > 0) return {3, {i, j, k}, {wa / sum, wb / sum, wc / sum}};
  Part best{};
  double least = HUGE_VAL;
  const auto consider = [&](const Part& part, const Vec3& p, const Vec3& q) {
    const Vec3 at = part.count == 2 ? Vec3(part.weight[0] * p + part.weight[1] * q) : Vec3::Zero();
    const double square = at.squaredNorm();
    if (square >= least) return;
    least = square;
    best = part;
  };
  const auto edge = [&](const Vec3& p, const Vec3& q, int m, int n) {
    const Part part = nearest_of_segment(p, q, m, n);
    if (part.count == 2) return consider(part, p, q);
    const Vec3& at = part.of[0] == m ? p : q;
    if (at.squaredNorm() >= least) return;
    least = at.squaredNorm();
    best = part;
  };
  edge(a, b, i, j);
  edge(b, c, j, k);
  edge(c, a, k, i);
  return best;
}

Vec3 point_of(const Simplex& s, const Part& part) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < part.count; ++k)
    sum += part.weight[static_cast<std::size_t>(k)] *
           s.point[static_cast<std::size_t>(part.of[static_cast<std::size_t>(k)])].at;
  return sum;
}

void keep(Simplex& s, const Part& part) {
  Simplex kept;
  for (int k = 0; k < part.count; ++k) {
    kept.point[static_cast<std::size_t>(k)] =
        s.point[static_cast<std::size_t>(part.of[static_cast<std::size_t>(k)])];
    kept.weight[static_cast<std::size_t>(k)] = part.weight[static_cast<std::size_t>(k)];
  }
  kept.count = part.count;
  s = kept;
}

/// Reduces a tetrahedron to the part that is nearest to the origin. Returns false if the origin is inside,
/// which is impossible for bodies that are known to be apart.
bool reduce_tetrahedron(Simplex& s, bool apart) {
  const auto at = [&](int k) -> const Vec3& { return s.point[static_cast<std::size_t>(k)].at; };
  constexpr std::array<std::array<int, 4>, 4> faces = {
      {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}};
  bool outside = false;
  Part best{};
  double least = HUGE_VAL;
  for (const auto& f : faces) {
    const Vec3 normal = (at(f[1]) - at(f[0])).cross(at(f[2]) - at(f[0]));
    const double origin = -normal.dot(at(f[0])), other = normal.dot(at(f[3]) - at(f[0]));
    // Skips a face that has the origin on its inner side; a flat tetrahedron has no inner side.
    const double rounding = tolerance::flat * normal.norm() * (at(f[3]) - at(f[0])).norm();
    if (!apart && std::abs(other) > rounding && origin * other > 0) continue;
    outside = true;
    const Part part = nearest_of_triangle(at(f[0]), at(f[1]), at(f[2]), f[0], f[1], f[2]);
    const double square = point_of(s, part).squaredNorm();
    if (square < least) {
      least = square;
      best = part;
    }
  }
  if (outside) keep(s, best);
  return outside;
}

bool reduce(Simplex& s, bool apart) {
  const auto at = [&](int k) -> const Vec3& { return s.point[static_cast<std::size_t>(k)].at; };
  if (s.count == 1) {
    s.weight[0] = 1;
  } else if (s.count == 2) {
    keep(s, nearest_of_segment(at(0), at(1), 0, 1));
  } else if (s.count == 3) {
    keep(s, nearest_of_triangle(at(0), at(1), at(2), 0, 1, 2));
  } else {
    return reduce_tetrahedron(s, apart);
  }
  return true;
}

}  // namespace

ClosestPoints closest_points(const ConvexBody& a, const ConvexBody& b, const Vec3& shift, double least,
                             double most) {
  constexpr int most_iterations = 200;
  Simplex s;
  Vec3 v = b.centre() + shift - a.centre();
  if (v.isZero(0)) v = Vec3::UnitX();
  double square = HUGE_VAL;
  bool separated = false;  // whether a plane between the bodies has been found
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Vec3 on_a = a.support(v);
    const Vec3 on_b = b.support(-v) + shift;
    const Difference next{on_b - on_a, on_a, on_b};
    // No point of the difference is nearer to the origin than the plane through `next` at right angles to v.
    if (const double length = v.norm(); v.dot(next.at) > most * length)
      return {.apart = true,
              .distance = v.dot(next.at) / length,
              .normal = v / length,
              .on_a = on_a,
              .on_b = on_b};
    if (s.count > 0 && square - v.dot(next.at) <= tolerance::distance_change * square) break;
    bool known = false;
    for (int k = 0; k < s.count; ++k) known = known || s.point[static_cast<std::size_t>(k)].at == next.at;
    if (known) break;
    const Simplex before = s;
    s.point[static_cast<std::size_t>(s.count++)] = next;
    separated = separated || (s.count > 1 && v.dot(next.at) > least * v.norm());
    if (!reduce(s, separated)) return {};
    const Vec3 nearest = s.nearest();
    const double now = nearest.squaredNorm();
    if (now <= least * least) return {};
    if (iteration > 0 && !(now < square)) {  // the distance no longer falls: rounding
      s = before;
      break;
    }
    v = nearest;
    square = now;
  }
  ClosestPoints out{.apart = true,
                    .distance = std::sqrt(square),
                    .normal = v / std::sqrt(square),
                    .on_a = Vec3::Zero(),
                    .on_b = Vec3::Zero()};
  for (int k = 0; k < s.count; ++k) {
    out.on_a += s.weight[static_cast<std::size_t>(k)] * s.point[static_cast<std::size_t>(k)].on_a;
    out.on_b += s.weight[static_cast<std::size_t>(k)] * (s.point[static_cast<std::size_t>(k)].on_b - shift);
  }
  return out;
}

}  // namespace scree
