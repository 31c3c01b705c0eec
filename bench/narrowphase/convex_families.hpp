// Families of overlapping pairs of convex particles: item n of a family is the same everywhere.
#pragma once

#include "bench/narrowphase/families.hpp"
#include "core/geometry.hpp"
#include "narrowphase/general_contacts.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace scree::oracle {

enum class ConvexFamily {
  any,         ///< within a fifth of the size of touching
  touching,    ///< overlaps of 1e-7 to 1e-16 of the size
  shallow,     ///< of a tenth to a millionth
  deep,        ///< more than a fifth of what the deepest overlap along their direction would be
  parallel,    ///< axes, to 1e-1 to 1e-12 rad or exactly
  crossed,     ///< axes, at right angles or nearly
  slender,     ///< 100 to 1, rods and discs
  size_ratio,  ///< 1000 to 1, half of the large ones flat where they can be
  coincident,  ///< centres
  scaled,      ///< by 1e-6 to 1e6
  far,         ///< a million sizes from the origin
  count
};
const char* name_of(ConvexFamily family);

/// Which shapes a pair has: item n of a family is of the kind n % convex_kinds.
inline constexpr std::uint64_t convex_kinds = 11;
std::string kind_name(std::uint64_t kind);

struct ConvexPair {
  ShapedSolid a, b;
  std::shared_ptr<const Hull> hull_a, hull_b;
  ShapeData data_a, data_b;  ///< of the hulls
  double length;             ///< what rounding is relative to: the largest half extent (m)
  double smallest;           ///< what tolerances are relative to (m)

  PairShapes shapes() const { return {&data_a, &data_b}; }
};

/// They overlap, but for rounding where they touch.
ConvexPair make_pair(ConvexFamily family, std::uint64_t n);

}  // namespace scree::oracle
