// The contacts of one pair, of general shapes too. Those are known on Host alone.
#pragma once

#include "narrowphase/general_contacts.hpp"
#include "narrowphase/pair_contacts.hpp"

namespace scree {

/// As find_pair_contacts(), of any two shapes. It is called and not copied to where it is used: a GPU that
/// does all of it once in a while waits for its instructions.
[[gnu::noinline]] SCREE_HD inline int find_any_contacts(const ShapedSolid& a, const ShapedSolid& b,
                                                        const PairShapes& shapes, const ContactReach& reach,
                                                        Manifold* out) {
  SCREE_ON_HOST(
      if (is_general(a.shape) || is_general(b.shape)) return find_general_contacts(a, b, shapes, reach, out);)
  return find_pair_contacts(a.shape, a.solid, b.shape, b.solid, reach.margin, out);
}

}  // namespace scree
