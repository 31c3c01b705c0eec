// The enlargement of volumes in float, by which their tests miss no bodies that touch.
#pragma once

#include "broadphase/aabb.hpp"
#include "broadphase/bounds.hpp"
#include "core/math.hpp"

namespace scree::bench {

/// Sixteen roundings of 2^-24, relative to a volume's size. No test here makes more.
inline constexpr double float_rounding = 0x1p-20;

/// A vector in float, and its largest distance from the exact vector (m).
struct RoundedVector {
  Vec3f at;
  double off;
  explicit RoundedVector(const Vec3& exact)
      : at(exact.cast<float>()), off((at.cast<double>() - exact).lpNorm<1>()) {}
};

/// Returns a length in float, enlarged by the error of places and by the rounding of tests, and rounded up.
inline float grown(double length, double off) { return round_up((1 + float_rounding) * (length + off)); }

/// Returns the box of half extents `half` (m) about a centre.
inline Aabb box_around(const Vec3f& centre, const Vec3& half) {
  Aabb box;
  for (int a = 0; a < 3; ++a) {
    box.lo[a] = round_down(static_cast<double>(centre[a]) - (1 + float_rounding) * half[a]);
    box.hi[a] = round_up(static_cast<double>(centre[a]) + (1 + float_rounding) * half[a]);
  }
  return box;
}

}  // namespace scree::bench
