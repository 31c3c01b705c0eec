// The conversion of a body's state in double to the float box that the broad phase uses.
#pragma once

#include "broadphase/aabb.hpp"
#include "broadphase/body_paths.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/math.hpp"

#include <bit>
#include <cstdint>

namespace scree {

/// Returns the next float below x, which is finite or +infinity.
SCREE_HD inline float next_below(float x) {
  if (x == 0) return -std::numeric_limits<float>::denorm_min();
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return std::bit_cast<float>(x > 0 ? bits - 1 : bits + 1);
}
SCREE_HD inline float next_above(float x) { return -next_below(-x); }

/// Returns the largest float that is not above x (round_down) or the smallest that is not below it
/// (round_up); NaN stays NaN. There are no branches, because it cannot be predicted whether the nearest float
/// is above x.
SCREE_HD inline float round_down(double x) {
  const auto nearest = static_cast<float>(x);
  const auto bits = std::bit_cast<std::uint32_t>(nearest);
  const std::uint32_t over = static_cast<double>(nearest) > x ? 1 : 0;
  const std::uint32_t sign = over << 31;  // the float below +0 is the one below -0
  return std::bit_cast<float>(nearest > 0 ? bits - over : (bits | sign) + over);
}
SCREE_HD inline float round_up(double x) { return -round_down(-x); }

/// The data of a body from which its box is computed.
struct BodyGeometry {
  Shape shape;
  Vec3 position;
  Quat orientation;
  Vec3 size;
};

/// Returns half the extents of a body's box, along the world's axes (m).
SCREE_HD inline Vec3 half_extent_of(const BodyGeometry& body) {
  if (body.shape == Shape::sphere) return Vec3::Constant(body.size.x());
  const Mat3 axes = body.orientation.toRotationMatrix();
  switch (body.shape) {
    case Shape::box:
    case Shape::polyhedron:
      return axes.cwiseAbs() * body.size;
    case Shape::triangle:
      // Two corners are opposite corners of the rectangle around the triangle, and the rectangle's corners
      // bound it.
      return axes.col(0).cwiseAbs() * body.size.x() + axes.col(1).cwiseAbs() * body.size.z();
    case Shape::capsule:
      return (axes.col(2).cwiseAbs() * (body.size.z() - body.size.x())).array() + body.size.x();
    default:
      break;
  }
  // The box of a tube or a cylinder is that of a segment along its z axis plus that of a disc along the other
  // two axes. The formula sqrt(1 - z^2) for the disc's extent would cancel where the axes are aligned.
  Vec3 half_extent;
  for (int a = 0; a < 3; ++a)
    half_extent[a] = fabs(axes(a, 2)) * body.size.z() + hypot(axes(a, 0), axes(a, 1)) * body.size.x();
  return half_extent;
}

/// Returns the box of a body, enlarged by `margin` along each of the world's axes, to either side, relative
/// to `origin` (m). It encloses the box of exact arithmetic: the rounding of the double formula is added
/// before the result is rounded outward to float. Planes are absent: Candidates lists them with the bodies
/// near them.
SCREE_HD inline Aabb bounds_of(const BodyGeometry& body, const Vec3& margin, const Vec3& origin) {
  if (body.shape == Shape::plane) return absent_bounds();
  const Vec3 half_extent = half_extent_of(body);
  // There are about ten roundings, each of 2^-53 of the size or of the distance, and twice the rounding of
  // the quaternion's norm.
  constexpr double rounding = 0x1p-48;
  const double reach = bounding_radius(body.shape, body.size) + margin.maxCoeff();
  Aabb box;
  for (int a = 0; a < 3; ++a) {
    const double centre = body.position[a] - origin[a];
    const double outward = half_extent[a] + margin[a] + rounding * (fabs(centre) + reach);
    box.lo[a] = round_down(centre - outward);
    box.hi[a] = round_up(centre + outward);
  }
  return box;
}

SCREE_HD inline Aabb bounds_of(const BodyGeometry& body, double margin, const Vec3& origin) {
  return bounds_of(body, Vec3(Vec3::Constant(margin)), origin);
}

/// Sets bounds[i] to the box of the whole path of body i, enlarged by margin[i]; in a periodic space it takes
/// the body's image in the cell. Absent bodies have absent bounds. The function makes no check: find()
/// refuses bounds that are not finite and names the body.
template <class Space>
void compute_bounds(const ConstBodyView& bodies, ConstView<double> margin, const BodyPaths& paths,
                    const Vec3& origin, View<Aabb> bounds);

}  // namespace scree
