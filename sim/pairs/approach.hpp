// How fast bodies come nearer to their neighbours.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"

#include <bit>
#include <cstdint>

namespace scree {

/// Returns how fast the surface of a body moves by its spin (m/s). A ball's surface stays where it is.
SCREE_HD inline double turning_speed(const ConstBodyView& bodies, std::int64_t k) {
  const Shape shape = bodies.shape[k];
  return shape == Shape::sphere ? 0.0 : bounding_radius(shape, bodies.size[k]) * bodies.spin[k].norm();
}

/// Approach speeds of free bodies: the largest speed of a body relative to one with which it is paired,
/// whether the two come nearer or not.
struct ApproachSpeeds {
  ConstView<std::uint32_t> bits = {};  ///< (m/s): the bits of floats, which have their order

  SCREE_HD bool exist() const { return bits.size() > 0; }
  SCREE_HD double of(std::int64_t k) const { return static_cast<double>(std::bit_cast<float>(bits[k])); }
};

template <class Space>
class ApproachFinder {
 public:
  /// The view is valid until the next call.
  ApproachSpeeds find(const Bodies<Space>& bodies, ConstView<Pair> pairs);

 private:
  Array<std::uint32_t, Space> bits_;
};

}  // namespace scree
