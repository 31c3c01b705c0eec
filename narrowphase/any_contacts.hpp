// The contacts of one pair of any shapes, general ones included. General shapes are known on Host alone.
#pragma once

#include "narrowphase/general_contacts.hpp"
#include "narrowphase/pair_contacts.hpp"

namespace scree {

/// Finds the contacts of one pair as find_pair_contacts() does, but for any two shapes. It is never inlined:
/// a GPU that runs all of this code only rarely would wait for its instructions.
[[gnu::noinline]] SCREE_HD inline int find_any_contacts(const ShapedSolid& a, const ShapedSolid& b,
                                                        const PairShapes& shapes, const ContactReach& reach,
                                                        Manifold* out) {
  SCREE_ON_HOST(
      if (is_general(a.shape) || is_general(b.shape)) return find_general_contacts(a, b, shapes, reach, out);)
  return find_pair_contacts(a.shape, a.solid, b.shape, b.solid, reach.margin, out);
}

}  // namespace scree
