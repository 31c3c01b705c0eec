// What a broad phase knows about its input before it starts: that it is sound, where it lies and how large.
#pragma once

#include "broadphase/aabb.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cstdint>

namespace scree {

/// Sizes and distances are counted in classes, eight to an octave: the upper bits of the float.
SCREE_HD inline std::int32_t size_class(float x) {
  return static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(x) >> 20);
}
/// The largest float of a class.
inline float class_end(std::int32_t size_class) {
  return std::bit_cast<float>((static_cast<std::uint32_t>(size_class + 1) << 20) - 1);
}
inline constexpr int classes_per_octave = 8;

/// Of all boxes that are not absent. The sums are of integers, so that no order of adding changes them.
struct Census {
  float lo[3] = {FLT_MAX, FLT_MAX, FLT_MAX};  ///< of the centres, to float rounding (m)
  float hi[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
  float largest = 0;                  ///< extent (m)
  std::int32_t present = 0;           ///< boxes that are not absent
  std::int32_t extended = 0;          ///< of these, boxes that are no points
  std::int32_t first_bad = no_body;   ///< lowest body whose box is not proper
  std::int64_t size_classes = 0;      ///< sum over the extended boxes: their geometric mean size
  std::int64_t distance_classes = 0;  ///< sum of the classes of the centres' largest coordinates

  static constexpr std::int32_t no_body = 0x7fffffff;
};

/// Histogram of the extents, centred on their geometric mean: 16 octaves on each side, what lies beyond
/// counted in the outermost bins.
struct SizeHistogram {
  static constexpr int bins = 256;
  std::int32_t first_class = 0;
  std::array<std::uint32_t, bins> count{};

  SCREE_HD static int bin_of(float extent, std::int32_t first_class) {
    const std::int32_t bin = size_class(extent) - first_class;
    return bin < 0 ? 0 : bin >= bins ? bins - 1 : bin;
  }
};

/// One pass over the boxes. Throws RunError naming the first body whose box is NaN, infinite or inverted.
template <class Space>
Census take_census(ConstView<Aabb> bounds);

/// A second pass, for those who need the sizes.
template <class Space>
SizeHistogram count_sizes(ConstView<Aabb> bounds, const Census& census);

}  // namespace scree
