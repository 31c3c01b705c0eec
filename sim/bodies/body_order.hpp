// The order of the bodies in the arrays: bodies that are near one another in space lie side by side, so that
// the contacts of a region read a small part of the memory.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"

#include <cstdint>

namespace scree {

/// Sets the places by number (`place_of`) of bodies that are in any order. The numbers must be 0 to N - 1.
template <class Space>
void find_places(Bodies<Space>& bodies);

/// Copies the bodies in the order of their numbers.
template <class Space>
void copy_by_number(BodyTable& out, const Bodies<Space>& bodies);

template <class Space>
class BodyOrder {
 public:
  /// Prepares the order of a scene's bodies; the cells are counted from `origin` (m).
  BodyOrder(const BodyTable& bodies, const Vec3& origin);

  /// Moves the bodies to places along a Z-order curve through cells as wide as a typical free body. The
  /// bodies of one cell are in the order of their numbers, and absent bodies come last. In a periodic space
  /// the image within the period's cell counts. So the places depend on where the bodies are, and not on the
  /// places that they had.
  void sort(Bodies<Space>& bodies);
  /// Returns for each place the place that its body had before the last sort().
  ConstView<std::int32_t> place_before() const { return place_before_.view(); }

 private:
  Vec3 origin_;
  double cell_;  // width of the cells (m)
  Array<std::int32_t, Space> place_before_;
};

}  // namespace scree
