// What the narrow phase tests: the pairs of the PCS, and each plane with the bodies near it.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/archive.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"

#include <cstdint>

namespace scree {

/// Of bodies in a space.
template <class Space>
class Candidates {
 public:
  /// Of the pairs of which one is free, and of each plane with each free body, those that may have a gap of
  /// no more than the sum of their margins (m), as told from the spheres around the bodies (of a tube, from
  /// its wall and its caps): each once, ordered by the smaller place of the two and then by the larger,
  /// whatever the order of the PCS. The body with the smaller number is first, so that a pair remains the
  /// same wherever its bodies lie. Pairs with planes in the PCS are left out: boxes are too coarse for them.
  /// The view is valid until the next call.
  ConstView<Pair> list(const ConstBodyView& bodies, ConstView<Pair> pcs, ConstView<double> margin);
  /// Those last listed.
  ConstView<Pair> pairs() const { return pairs_.view(); }
  void archive(Archive& archive) { archive("pairs", pairs_); }

 private:
  Array<std::int32_t, Space> planes_;
  Array<std::uint64_t, Space> keys_;  // of the pairs
  Array<Pair, Space> pairs_;
};

}  // namespace scree
