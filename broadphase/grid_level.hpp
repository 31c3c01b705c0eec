// One level of the hierarchical grid: which cell a coordinate is in, and the place of a cell in the table.
//
// A table consists of bricks of cells, 4 by 4 rows along x. If a level's bricks fit, they lie side by side,
// and a row runs through the whole domain (dense table). Otherwise rows are cut after 16 cells, and a hash of
// a brick's coordinates gives its place (hashed table), so that neither distant clusters nor a single outlier
// cost memory. In a hashed table, bricks can share a slot. That costs tests, but no pair is lost or doubled:
// cells up to three apart on each axis have different places inside the brick, so in a search of up to 3x3x3
// cells each object is in at most one of the visited cells, and an object that overlaps is in the cell where
// it belongs.
#pragma once

#include "broadphase/aabb.hpp"

#include <cmath>
#include <cstdint>

namespace scree {

/// Number of a brick's cells along y and z, and along x in a hashed table.
inline constexpr std::uint32_t brick_width = 4;
inline constexpr std::uint32_t brick_row = 16;
inline constexpr std::uint32_t brick_rows = brick_width * brick_width;

/// Share by which cells are wider than the largest object, so that rounding of cell numbers (2^-52 of at most
/// farthest_cell, twice) cannot put two overlapping objects more than one cell apart.
inline constexpr double cell_slack = 0x1p-16;
inline constexpr double farthest_cell = 0x1p29;

/// Cells from lo to hi on each axis, both included; empty if lo > hi.
struct CellRange {
  std::int32_t lo[3];
  std::int32_t hi[3];
};

struct GridLevel {
  float largest;           ///< largest extent of its objects (m)
  double cell;             ///< cell width (m), over `largest` by at least cell_slack
  double inverse_cell;     ///< inverse of the cell width (1/m)
  std::int32_t first[3];   ///< absolute number of the first cell in use: cells are counted from it
  std::int32_t last[3];    ///< number of the last cell in use
  bool hashed;             ///< whether the table is hashed; else it is dense
  std::uint32_t row;       ///< cells in a brick's row
  std::uint32_t bricks_y;  ///< number of bricks side by side along y in a dense table
  std::uint32_t slots;     ///< number of bricks in the table; a power of two if it is hashed
  std::uint32_t base;      ///< first cell of the level in the table of all levels
  std::int32_t begin;      ///< its objects in the sorted order: from begin to before end
  std::int32_t end;

  /// Returns the number of the cell that holds a coordinate. It is monotone and clamped, so the numbers of
  /// coordinates that are at most a cell's width apart differ by at most one.
  SCREE_HD std::int32_t cell_of(double coordinate, int axis) const {
    // This is the floor of the clamped number. It does without floor, fmin and fmax, because they are calls
    // on the host and cost more than all the rest.
    const double number = coordinate * inverse_cell;
    const double capped = number < farthest_cell ? number : farthest_cell;
    const double clamped = capped > -farthest_cell ? capped : -farthest_cell;
    const auto towards_zero = static_cast<std::int32_t>(clamped);
    return towards_zero - (static_cast<double>(towards_zero) > clamped ? 1 : 0) - first[axis];
  }

  /// Returns the cells in use that can hold the centre of an object of this level that overlaps the box.
  SCREE_HD CellRange reach_of(const Aabb& box) const {
    CellRange range;
    for (int a = 0; a < 3; ++a) {
      const std::int32_t lo = cell_of(static_cast<double>(box.lo[a]) - 0.5 * cell, a);
      const std::int32_t hi = cell_of(static_cast<double>(box.hi[a]) + 0.5 * cell, a);
      range.lo[a] = lo > 0 ? lo : 0;
      range.hi[a] = hi < last[a] ? hi : last[a];
    }
    return range;
  }

  /// Returns whether the cell of an object of this level is in the range.
  SCREE_HD bool stands_in(const Aabb& box, const CellRange& range) const {
    for (int a = 0; a < 3; ++a) {
      const std::int32_t number = cell_of(centre_of(box, a), a);
      if (number < range.lo[a] || number > range.hi[a]) return false;
    }
    return true;
  }

  /// Returns the place in the table of cell (x, y, z), whose numbers are within 0 to last.
  SCREE_HD std::uint32_t address(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const auto ux = static_cast<std::uint32_t>(x);
    if (!hashed) return base + row * (rows_below_y(y) + rows_below_z(z)) + ux;
    const auto uy = static_cast<std::uint32_t>(y);
    const auto uz = static_cast<std::uint32_t>(z);
    const std::uint32_t slot = slot_of(ux / brick_row, uy / brick_width, uz / brick_width);
    const std::uint32_t row_in_brick = uz % brick_width * brick_width + uy % brick_width;
    return base + (slot * brick_rows + row_in_brick) * brick_row + ux % brick_row;
  }

  /// Returns the number of the last cell, at most `end_of_range`, that lies in one run with cell x of the
  /// same row.
  SCREE_HD std::int32_t run_end(std::int32_t x, std::int32_t end_of_range) const {
    const std::int32_t end_of_row = hashed ? x | static_cast<std::int32_t>(brick_row - 1) : end_of_range;
    return end_of_row < end_of_range ? end_of_row : end_of_range;
  }

  SCREE_HD std::uint32_t cells() const { return slots * brick_rows * row; }

 private:
  // In a dense table, the row of a cell is the sum of the rows below its y and of those below its z.
  SCREE_HD std::uint32_t rows_below_y(std::int32_t y) const {
    const auto u = static_cast<std::uint32_t>(y);
    return u / brick_width * brick_rows + u % brick_width;
  }
  SCREE_HD std::uint32_t rows_below_z(std::int32_t z) const {
    const auto u = static_cast<std::uint32_t>(z);
    return u / brick_width * bricks_y * brick_rows + u % brick_width * brick_width;
  }
  // This is a multiplicative hash of the three numbers, followed by murmur3's finaliser (Appleby 2011).
  SCREE_HD std::uint32_t slot_of(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    std::uint32_t h = x * 0x9E3779B1u + y * 0x85EBCA77u + z * 0xC2B2AE3Du;
    h = (h ^ (h >> 16)) * 0x85EBCA6Bu;
    h = (h ^ (h >> 13)) * 0xC2B2AE35u;
    return (h ^ (h >> 16)) & (slots - 1);
  }
};

/// Returns the level of an object: the lowest one whose cells are large enough. The last of `levels` takes
/// all objects.
SCREE_HD inline int level_of_extent(const GridLevel* levels, float extent) {
  int level = 0;
  while (extent > levels[level].largest) ++level;
  return level;
}

/// Returns the level of the k-th object in the sorted order.
SCREE_HD inline int level_of_rank(const GridLevel* levels, std::int64_t k) {
  int level = 0;
  while (k >= levels[level].end) ++level;
  return level;
}

}  // namespace scree
