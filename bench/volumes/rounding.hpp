// What volumes in float must be larger by, so that their tests miss no bodies that touch.
#pragma once

#include "broadphase/aabb.hpp"
#include "broadphase/bounds.hpp"
#include "core/math.hpp"

namespace scree::bench {

/// Sixteen roundings of 2^-24, relative to a volume's size: more than any test here makes.
inline constexpr double float_rounding = 0x1p-20;

/// A vector in float, and how far that is from it at most (m).
struct RoundedVector {
  Vec3f at;
  double off;
  explicit RoundedVector(const Vec3& exact)
      : at(exact.cast<float>()), off((at.cast<double>() - exact).lpNorm<1>()) {}
};

/// A length, larger by what places are off and by the rounding of tests; up to float.
inline float grown(double length, double off) { return round_up((1 + float_rounding) * (length + off)); }

/// Box of half extents `half` (m) about a centre.
inline Aabb box_around(const Vec3f& centre, const Vec3& half) {
  Aabb box;
  for (int a = 0; a < 3; ++a) {
    box.lo[a] = round_down(static_cast<double>(centre[a]) - (1 + float_rounding) * half[a]);
    box.hi[a] = round_up(static_cast<double>(centre[a]) + (1 + float_rounding) * half[a]);
  }
  return box;
}

}  // namespace scree::bench
