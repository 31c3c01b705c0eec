// Families of overlapping pairs of convex particles. Item n of a family is the same on every machine.
#pragma once

#include "bench/narrowphase/families.hpp"
#include "core/geometry.hpp"
#include "narrowphase/general_contacts.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace scree::oracle {

enum class ConvexFamily {
  any,         ///< overlaps of up to a fifth of the size
  touching,    ///< overlaps of 1e-7 to 1e-16 of the size
  shallow,     ///< overlaps of a tenth to a millionth of the size
  deep,        ///< overlaps of more than a fifth of the deepest overlap along the pair's direction
  parallel,    ///< axes parallel, to 1e-1 to 1e-12 rad or exactly
  crossed,     ///< axes at right angles or nearly so
  slender,     ///< proportions of 100 to 1, rods and discs
  size_ratio,  ///< sizes of 1000 to 1, half of the large bodies flat if their shape can be
  coincident,  ///< both centres at one point
  scaled,      ///< pairs scaled by 1e-6 to 1e6
  far,         ///< pairs a million sizes from the origin
  count
};
const char* name_of(ConvexFamily family);

/// The number of kinds of shapes that a pair can have. Item n of a family is of the kind n % convex_kinds.
inline constexpr std::uint64_t convex_kinds = 11;
std::string kind_name(std::uint64_t kind);

struct ConvexPair {
  ShapedSolid a, b;
  std::shared_ptr<const Hull> hull_a, hull_b;
  ShapeData data_a, data_b;  ///< data that refer to the hulls
  double length;             ///< length to which rounding is relative: the largest half extent (m)
  double smallest;           ///< length to which tolerances are relative (m)

  PairShapes shapes() const { return {&data_a, &data_b}; }
};

/// Makes a pair of bodies that overlap; in touching pairs rounding may prevent that.
ConvexPair make_pair(ConvexFamily family, std::uint64_t n);

}  // namespace scree::oracle
