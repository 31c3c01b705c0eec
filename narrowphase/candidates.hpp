// The candidate pairs for the narrow phase: pairs of the PCS, and each plane with the bodies near it.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/archive.hpp"
#include "core/array.hpp"
#include "narrowphase/near_pairs.hpp"

#include <cstdint>

namespace scree {

/// The candidate pairs of bodies in one space.
template <class Space>
class Candidates {
 public:
  /// Lists the candidates, each once: the pairs of the PCS of which at least one body is free, and each plane
  /// with each free body, as far as the spheres around them are near (NearPairs). Candidates are
  /// ordered by the smaller place of the two bodies and then by the larger, whatever the order of the PCS.
  /// The body with the smaller number is first in its pair, so that a pair remains the same wherever its
  /// bodies lie in the arrays. Pairs with planes in the PCS are left out, because boxes are too coarse for
  /// planes. The view is valid until the next call.
  ConstView<Pair> list(const NearPairs& near, ConstView<Pair> pcs);
  /// Returns the candidates of the last call of list().
  ConstView<Pair> pairs() const { return pairs_.view(); }
  void archive(Archive& archive) { archive("pairs", pairs_); }

 private:
  Array<std::int32_t, Space> planes_;
  Array<std::uint64_t, Space> keys_;  // keys of the pairs
  Array<Pair, Space> pairs_;
};

}  // namespace scree
