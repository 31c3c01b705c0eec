// The Z-order curve (Morton 1966, "A computer oriented geodetic data base; and a new technique in file
// sequencing"), on which cells near each other in space are mostly near each other in the order.
#pragma once

#include "core/space.hpp"

#include <cstdint>

namespace scree {

/// Bits of each of the three coordinates of a cell on the curve.
inline constexpr int z_order_bits = 21;

/// Moves each of 21 bits to three times its position.
SCREE_HD inline std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffull;
  x = (x | x << 16) & 0x001f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  x = (x | x << 2) & 0x1249249249249249ull;
  return x;
}

/// Returns the place of a cell on the curve, by its coordinates of z_order_bits bits each.
SCREE_HD inline std::uint64_t z_order(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread_bits(x) << 2 | spread_bits(y) << 1 | spread_bits(z);
}
/// A place on the curve beyond all cells.
inline constexpr std::uint64_t beyond_z_order = std::uint64_t{1} << (3 * z_order_bits);

}  // namespace scree
