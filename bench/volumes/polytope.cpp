#include "bench/volumes/polytope.hpp"

#include <algorithm>

namespace scree::bench {

namespace {

using Polygon = std::vector<Vec3>;

/// The points x with normal * x <= height.
struct HalfSpace {
  Vec3 normal;  ///< outward, unit
  double height;
};

/// Returns the half spaces of the slabs relative to the point in the middle of the first three slabs, where
/// little cancels.
std::vector<HalfSpace> half_spaces_of(const std::vector<Slab>& slabs) {
  Mat3 directions;
  Vec3 middles;
  for (int k = 0; k < 3; ++k) {
    const Slab& slab = slabs[static_cast<std::size_t>(k)];
    directions.row(k) = slab.direction.transpose();
    middles[k] = 0.5 * (slab.lo + slab.hi);
  }
  const Vec3 centre = directions.inverse() * middles;
  std::vector<HalfSpace> all;
  for (const Slab& slab : slabs) {
    const double length = slab.direction.norm(), at = slab.direction.dot(centre);
    all.push_back({slab.direction / length, (slab.hi - at) / length});
    all.push_back({-slab.direction / length, (at - slab.lo) / length});
  }
  return all;
}

/// Returns the part of the polygon in the half space (Sutherland and Hodgman 1974).
Polygon clip(const Polygon& polygon, const HalfSpace& side) {
  Polygon inside;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& p = polygon[k];
    const Vec3& q = polygon[(k + 1) % polygon.size()];
    const double at_p = side.normal.dot(p) - side.height, at_q = side.normal.dot(q) - side.height;
    if (at_p <= 0) inside.push_back(p);
    if (at_p * at_q < 0) inside.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return inside;
}

double area_of(const Polygon& polygon, const Vec3& normal) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t k = 0; k < polygon.size(); ++k)
    twice += polygon[k].cross(polygon[(k + 1) % polygon.size()]);
  return 0.5 * twice.dot(normal);
}

}  // namespace

double volume_of(const std::vector<Slab>& slabs) {
  const std::vector<HalfSpace> sides = half_spaces_of(slabs);
  double reach = 0;
  for (const HalfSpace& side : sides) reach = std::max(reach, std::fabs(side.height));
  // A face is a part of a square in its plane. The square is large enough for any polytope of slabs whose
  // angles are not tiny. The pyramids over the faces fill the polytope.
  constexpr double far = 100;
  double volume = 0;
  for (const HalfSpace& face : sides) {
    const Vec3 u = far * reach * tangent_of(face.normal), v = face.normal.cross(u);
    const Vec3 at = face.height * face.normal;
    Polygon polygon = {at - u - v, at + u - v, at + u + v, at - u + v};
    for (const HalfSpace& side : sides) {
      if (&side != &face) polygon = clip(polygon, side);
    }
    volume += face.height * area_of(polygon, face.normal) / 3;
  }
  return volume;
}

}  // namespace scree::bench
