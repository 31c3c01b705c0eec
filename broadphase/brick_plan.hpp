// The plan of the bricks: how large they are and how each is searched, chosen from a sample of the objects.
// No choice made here changes the PCS.
#pragma once

#include "broadphase/brick_lattice.hpp"
#include "broadphase/census.hpp"
#include "broadphase/sorted_keys.hpp"

#include <cstdint>
#include <optional>

namespace scree {

/// The properties of a sample of the objects. The sums are of integers, so that the order of adding does not
/// change them.
struct BrickSample {
  static constexpr int most = 1 << 16;    ///< largest number of objects looked at
  static constexpr int size_bins = 2048;  ///< size classes, eight to an octave
  static constexpr int width = 8;         ///< cells along each axis in which centres are counted

  std::uint32_t lo[3];    ///< lowest centre on each axis, as ordered_bits
  std::uint32_t hi[3];    ///< highest centre on each axis, as ordered_bits
  std::uint32_t largest;  ///< largest extent, as the bits of the float
  std::uint32_t sizes[size_bins];
  std::uint32_t places[width * width * width];  ///< number of centres in each cell, from lo to hi

  SCREE_HD static constexpr std::int64_t looked_at(std::int64_t count) { return count < most ? count : most; }
  /// Returns which of `count` objects is sample k, for 0 <= k < looked_at(count). The objects are divided
  /// into looked_at(count) stretches, and the middle of stretch k is taken: the first object often is a floor
  /// and unlike all others.
  SCREE_HD static constexpr std::int64_t object(std::int64_t k, std::int64_t count) {
    return (2 * k + 1) * count / (2 * looked_at(count));
  }
};

/// The cells within a brick. The lower corner of an object decides its cell.
struct BrickCells {
  std::int32_t first[3];    ///< local number with which the cells begin; lower numbers are in the first cell
  std::uint32_t factor[3];  ///< number of cells per 2^16 numbers
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

/// How the pairs in a brick are found.
enum class BrickMethod {
  stencil,  ///< each object is in the cell of its lower corner, and is tested against half of the cells
            ///< around it
  rows,  ///< each object is in all rows along x that it overlaps, and is tested against objects that begin in
         ///< them
};

struct BrickPlan {
  BrickLattice lattice;
  BrickMethod method;
  BrickCells cells;
  /// Longest object of a stencil, in lattice numbers. With method stencil, wider objects are tested against
  /// all objects in their bricks.
  std::int32_t reach[3];
  // Bricks are filled in two steps: objects first go to buckets, which are cubes of bricks.
  std::int32_t bucket_width;  ///< number of bricks along each edge of a bucket
  std::int32_t buckets[3];

  SCREE_HD std::int32_t total_buckets() const { return buckets[0] * buckets[1] * buckets[2]; }
};

inline constexpr std::int32_t widest_bucket = 8;
inline constexpr std::int32_t most_buckets = 2048;
/// Largest numbers of bricks, in all and along an axis: 32 bits must number all entries, and all lattice
/// points along an axis.
inline constexpr std::int64_t most_bricks = 1 << 21;
inline constexpr std::int64_t most_bricks_along = 1 << 14;
/// Capacities of the shared memory of a block of threads: objects, entries (an object has one in each of its
/// rows, or a single one) and cells.
inline constexpr std::uint32_t brick_objects = 1280;
constexpr std::uint32_t most_entries(BrickMethod method) {
  return method == BrickMethod::stencil ? brick_objects : 1792;
}
constexpr std::int32_t most_cells(BrickMethod method) { return method == BrickMethod::stencil ? 3200 : 1024; }

/// Returns the plan; nothing if bricks do not suit: if there would be too many, if most objects would be in
/// several, or if objects are crowded in few places. `objects` is the number of all objects, of which the
/// sample contains some.
std::optional<BrickPlan> plan_bricks(const BrickSample& sample, std::int64_t objects);

}  // namespace scree
