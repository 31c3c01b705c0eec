// Periods, for broad phases that know of none: boxes that reach through the upper end of the cell are there
// once more below its lower end's next image, and pairs of boxes become pairs of bodies.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/period.hpp"

#include <cstdint>

namespace scree {

template <class Space>
class PeriodicImages {
 public:
  /// Takes the boxes of bodies in the cell of a period, no two of which have extents that sum to more than
  /// it. A body whose box, moved up by the period, still meets the highest end of a box gets an image there;
  /// along several axes, one for each combination.
  void take(ConstView<Aabb> bounds, ConstView<Mobility> mobility, const Period& period);

  /// Those of the bodies, then those of their images.
  const Array<Aabb, Space>& bounds() const { return bounds_; }
  const Array<Mobility, Space>& mobility() const { return mobility_; }

  /// The pairs of bodies that pairs of these boxes are: i < j, each once, in the order in which they were
  /// found. Two boxes and their images moved alike are one pair, and it is the one of which, along each axis,
  /// one is not moved. Valid until the next call.
  ConstView<Pair> pairs_of(ConstView<Pair> found);

 private:
  Array<Aabb, Space> bounds_;
  Array<Mobility, Space> mobility_;
  Array<std::int32_t, Space> owner_;
  Array<std::uint8_t, Space> shift_;  // a bit for each axis along which it is moved up
  Array<std::uint8_t, Space> reach_;  // of each body, along which it has images; likewise
  Array<std::int32_t, Space> count_;  // of its images
  Array<std::int64_t, Space> first_;
  Array<std::uint64_t, Space> keys_;
  Array<Pair, Space> pairs_;
};

}  // namespace scree
