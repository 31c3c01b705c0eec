// The census of the boxes that a broad phase takes before it starts: whether they are valid, where they lie
// and how large they are.
#pragma once

#include "broadphase/aabb.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cstdint>

namespace scree {

/// Returns the class of a size or distance. There are eight classes to an octave, given by the upper bits of
/// the float.
SCREE_HD inline std::int32_t size_class(float x) {
  return static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(x) >> 20);
}
/// Returns the largest float of a class.
inline float class_end(std::int32_t size_class) {
  return std::bit_cast<float>((static_cast<std::uint32_t>(size_class + 1) << 20) - 1);
}
inline constexpr int classes_per_octave = 8;

/// The properties of all boxes that are not absent. The sums are of integers, so that the order of adding
/// does not change them.
struct Census {
  float lo[3] = {FLT_MAX, FLT_MAX, FLT_MAX};  ///< lowest centre, to float rounding (m)
  float hi[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
  float largest = 0;                  ///< largest extent (m)
  std::int32_t present = 0;           ///< number of boxes that are not absent
  std::int32_t extended = 0;          ///< number of these that are not points
  std::int32_t first_bad = no_body;   ///< lowest body whose box is not proper
  std::int64_t size_classes = 0;      ///< sum over the extended boxes, for their geometric mean size
  std::int64_t distance_classes = 0;  ///< sum of the classes of the centres' largest coordinates

  static constexpr std::int32_t no_body = 0x7fffffff;
};

/// A histogram of the extents, centred on their geometric mean. It has 16 octaves on each side; extents
/// beyond them are counted in the outermost bins.
struct SizeHistogram {
  static constexpr int bins = 256;
  std::int32_t first_class = 0;
  std::array<std::uint32_t, bins> count{};

  SCREE_HD static int bin_of(float extent, std::int32_t first_class) {
    const std::int32_t bin = size_class(extent) - first_class;
    return bin < 0 ? 0 : bin >= bins ? bins - 1 : bin;
  }
};

/// Takes the census in one pass over the boxes. Throws RunError naming the first body whose box is NaN,
/// infinite or inverted.
template <class Space>
Census take_census(ConstView<Aabb> bounds);

/// Counts the sizes in a second pass, for the broad phases that need them.
template <class Space>
SizeHistogram count_sizes(ConstView<Aabb> bounds, const Census& census);

}  // namespace scree
