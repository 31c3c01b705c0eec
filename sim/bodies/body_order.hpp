// In which order the bodies lie in the arrays: those that are near one another in space side by side, so that
// contacts of a region read a small part of the memory.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"

#include <cstdint>

namespace scree {

/// Sets the places of bodies that lie in whatever order, by their numbers, which must be 0 to N - 1.
template <class Space>
void find_places(Bodies<Space>& bodies);

/// The bodies in the order of their numbers.
template <class Space>
void copy_by_number(BodyTable& out, const Bodies<Space>& bodies);

template <class Space>
class BodyOrder {
 public:
  /// For a scene's bodies; cells are counted from `origin` (m).
  BodyOrder(const BodyTable& bodies, const Vec3& origin);

  /// Moves the bodies to places along a Z-order curve through cells as wide as a typical free body: those of
  /// a cell by their numbers, and those that are absent last. In a periodic space the image in the period's
  /// cell counts. So the places follow from where the bodies are, and not from the places that they had.
  void sort(Bodies<Space>& bodies);
  /// Which place each body, by its place, had before the last sort().
  ConstView<std::int32_t> place_before() const { return place_before_.view(); }

 private:
  Vec3 origin_;
  double cell_;  // m
  Array<std::int32_t, Space> place_before_;
};

}  // namespace scree
