// Images of boxes, for broad phases that do not know of periods: a box at the lower end of the cell is
// repeated one period above, where it can meet boxes that reach through the upper end, and pairs of boxes
// become pairs of bodies.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/period.hpp"

#include <cstdint>

namespace scree {

template <class Space>
class PeriodicImages {
 public:
  /// Takes the boxes of bodies in the cell of a period. No two of them may have extents that sum to more than
  /// the period. A body gets an image, moved up by the period, if the image still reaches down to the highest
  /// upper end of a box; along several axes it gets one image for each combination of them.
  void take(ConstView<Aabb> bounds, ConstView<Mobility> mobility, const Period& period);

  /// Returns the boxes of the bodies, followed by those of their images.
  const Array<Aabb, Space>& bounds() const { return bounds_; }
  const Array<Mobility, Space>& mobility() const { return mobility_; }

  /// Returns the pairs of bodies that correspond to pairs of these boxes: i < j, each once, in the order in
  /// which they were found. Two boxes and their images moved in the same way are one pair; the one that
  /// counts is that in which, along each axis, at least one of the two boxes is not moved. The view is valid
  /// until the next call.
  ConstView<Pair> pairs_of(ConstView<Pair> found);

 private:
  Array<Aabb, Space> bounds_;
  Array<Mobility, Space> mobility_;
  Array<std::int32_t, Space> owner_;
  Array<std::uint8_t, Space> shift_;  // one bit for each axis along which a box is moved up
  Array<std::uint8_t, Space> reach_;  // one bit for each axis along which a body has images
  Array<std::int32_t, Space> count_;  // number of images of each body
  Array<std::int64_t, Space> first_;
  Array<std::uint64_t, Space> keys_;
  Array<Pair, Space> pairs_;
};

}  // namespace scree
