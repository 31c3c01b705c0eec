// A numbering of the centres with integers, which outliers do not spoil, and their places on the Z-order
// curve.
#pragma once

#include "broadphase/census.hpp"
#include "core/z_order.hpp"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>

namespace scree {

/// A numbering of coordinates with 21 bits: even up to one unit on either side of the origin, then with half
/// the resolution in each further octave. An even division of the box around all centres, which hierarchies
/// usually use, would leave one number to all other centres if a single one lies far away.
class CentreScale {
 public:
  static constexpr int bits = z_order_bits;

  /// Sets the unit to four times the geometric mean of the distances, so that without outliers all numbers
  /// are even.
  explicit CentreScale(const Census& census) {
    const auto mean_class = static_cast<std::int32_t>(census.distance_classes / std::max(census.present, 1));
    per_unit_ = 1 / (4.0 * class_end(mean_class));
    double farthest = 0;
    for (int a = 0; a < 3; ++a)
      farthest = std::max({farthest, std::abs(double{census.lo[a]}), std::abs(double{census.hi[a]})});
    shift_ = std::max(0, static_cast<int>(std::bit_width(steps(farthest))) - (bits - 1));
  }

  /// Returns a number from 0 to below 2^bits, which is never smaller for a larger coordinate (m).
  SCREE_HD std::uint32_t number(double coordinate) const {
    constexpr std::uint32_t half = 1u << (bits - 1);
    const std::uint32_t distance = steps(fabs(coordinate)) >> shift_;
    const std::uint32_t clamped = distance < half ? distance : half - 1;  // the census rounds to float
    return coordinate < 0 ? half - 1 - clamped : half + clamped;
  }

 private:
  /// Returns a distance in float steps. The bits of a float are an even scale within its octave, and continue
  /// from one octave to the next.
  SCREE_HD std::uint32_t steps(double distance) const {
    const double from_one = fmin(1 + distance * per_unit_, static_cast<double>(FLT_MAX));
    return std::bit_cast<std::uint32_t>(static_cast<float>(from_one)) - std::bit_cast<std::uint32_t>(1.0f);
  }

  double per_unit_;
  int shift_;
};

/// Returns the place of a box's centre on the Z-order curve.
SCREE_HD inline std::uint64_t morton_code(const CentreScale& scale, const Aabb& box) {
  return z_order(scale.number(centre_of(box, 0)), scale.number(centre_of(box, 1)),
                 scale.number(centre_of(box, 2)));
}

}  // namespace scree
