// How large bricks are, and how one is searched: chosen from a sample of the objects. No choice made here
// changes the PCS.
#pragma once

#include "broadphase/brick_lattice.hpp"
#include "broadphase/census.hpp"
#include "broadphase/sorted_keys.hpp"

#include <cstdint>
#include <optional>

namespace scree {

/// Of some of the objects. Sums of integers, so that no order of adding changes them.
struct BrickSample {
  static constexpr int most = 1 << 16;    ///< objects looked at
  static constexpr int size_bins = 2048;  ///< size classes, eight to an octave
  static constexpr int width = 8;         ///< cells along each axis of the counts of places

  std::uint32_t lo[3];    ///< the lowest centre on each axis, by ordered_bits
  std::uint32_t hi[3];    ///< the highest
  std::uint32_t largest;  ///< extent, as its bits
  std::uint32_t sizes[size_bins];
  std::uint32_t places[width * width * width];  ///< of centres, from lo to hi

  SCREE_HD static constexpr std::int64_t looked_at(std::int64_t count) { return count < most ? count : most; }
  /// Which of `count` objects the sample looks at, for 0 <= k < looked_at(count): the middle of each of as
  /// many stretches. Not the first, which often is a floor and like no other.
  SCREE_HD static constexpr std::int64_t object(std::int64_t k, std::int64_t count) {
    return (2 * k + 1) * count / (2 * looked_at(count));
  }
};

/// Cells within a brick, by numbers of lower corners.
struct BrickCells {
  std::int32_t first[3];    ///< local number with which cells begin; what lies before is in the first cell
  std::uint32_t factor[3];  ///< cells to 2^16 numbers
  std::int32_t count[3];

  SCREE_HD std::int32_t cell_of(std::int32_t local, int axis) const {
    const std::int32_t from = local > first[axis] ? local - first[axis] : 0;
    return static_cast<std::int32_t>((static_cast<std::uint32_t>(from) * factor[axis]) >> 16);
  }
  SCREE_HD std::int32_t key(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return (z * count[1] + y) * count[0] + x;
  }
  SCREE_HD std::int32_t total() const { return count[0] * count[1] * count[2]; }
};

/// What a brick does with its objects.
enum class BrickMethod {
  stencil,  ///< each in the cell of its lower corner, against half of the cells around it
  rows,     ///< each in all rows along x that it overlaps, against those that begin in it
};

struct BrickPlan {
  BrickLattice lattice;
  BrickMethod method;
  BrickCells cells;
  /// Numbers. Of a stencil: what is wider is tested against all in its bricks.
  std::int32_t reach[3];
  // Bricks are filled in two steps: first buckets of bricks, which are cubes.
  std::int32_t bucket_width;  ///< bricks along each of its edges
  std::int32_t buckets[3];

  SCREE_HD std::int32_t total_buckets() const { return buckets[0] * buckets[1] * buckets[2]; }
};

inline constexpr std::int32_t widest_bucket = 8;
inline constexpr std::int32_t most_buckets = 2048;
/// So many that 32 bits number all entries; and along an axis, that they number all points.
inline constexpr std::int64_t most_bricks = 1 << 21;
inline constexpr std::int64_t most_bricks_along = 1 << 14;
/// What the memory of a block of threads holds: objects, entries (an object has one in each row, or one
/// alone) and cells.
inline constexpr std::uint32_t brick_objects = 1280;
constexpr std::uint32_t most_entries(BrickMethod method) {
  return method == BrickMethod::stencil ? brick_objects : 1792;
}
constexpr std::int32_t most_cells(BrickMethod method) { return method == BrickMethod::stencil ? 3200 : 1024; }

/// Nothing where bricks do not suit: where there would be too many, where most objects would stand in
/// several, or where objects are crowded in few places. `objects`: all, of which the sample shows some.
std::optional<BrickPlan> plan_bricks(const BrickSample& sample, std::int64_t objects);

}  // namespace scree
