// Where centres lie, in whole numbers and whatever the outliers; and their places on the Z-order curve.
#pragma once

#include "broadphase/census.hpp"
#include "core/z_order.hpp"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>

namespace scree {

/// Numbers coordinates with 21 bits: evenly up to a unit on either side of the origin, then with half the
/// resolution in each octave. Dividing the box around all centres evenly, as hierarchies usually do, would
/// leave one number to all others where a single one lies far away.
class CentreScale {
 public:
  static constexpr int bits = z_order_bits;

  /// The unit is four times the geometric mean of the distances, so that all is even without outliers.
  explicit CentreScale(const Census& census) {
    const auto mean_class = static_cast<std::int32_t>(census.distance_classes / std::max(census.present, 1));
    per_unit_ = 1 / (4.0 * class_end(mean_class));
    double farthest = 0;
    for (int a = 0; a < 3; ++a)
      farthest = std::max({farthest, std::abs(double{census.lo[a]}), std::abs(double{census.hi[a]})});
    shift_ = std::max(0, static_cast<int>(std::bit_width(steps(farthest))) - (bits - 1));
  }

  /// From 0 to before 2^bits, and never less for a larger coordinate (m).
  SCREE_HD std::uint32_t number(double coordinate) const {
    constexpr std::uint32_t half = 1u << (bits - 1);
    const std::uint32_t distance = steps(fabs(coordinate)) >> shift_;
    const std::uint32_t clamped = distance < half ? distance : half - 1;  // the census rounds to float
    return coordinate < 0 ? half - 1 - clamped : half + clamped;
  }

 private:
  /// The bits of a float are an even scale within its octave, and go on from one octave to the next.
  SCREE_HD std::uint32_t steps(double distance) const {
    const double from_one = fmin(1 + distance * per_unit_, static_cast<double>(FLT_MAX));
    return std::bit_cast<std::uint32_t>(static_cast<float>(from_one)) - std::bit_cast<std::uint32_t>(1.0f);
  }

  double per_unit_;
  int shift_;
};

/// Place of a box's centre on the Z-order curve.
SCREE_HD inline std::uint64_t morton_code(const CentreScale& scale, const Aabb& box) {
  return z_order(scale.number(centre_of(box, 0)), scale.number(centre_of(box, 1)),
                 scale.number(centre_of(box, 2)));
}

}  // namespace scree
