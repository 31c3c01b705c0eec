// The lattice of bricks. Bricks are boxes of space that hold so few objects that one block of threads finds
// their pairs in its shared memory. Objects are copied into every brick that they overlap.
//
// Coordinates are integer numbers of a lattice with 2^14 points to a brick. One monotone function numbers
// them all, so boxes that overlap in floats also overlap in numbers; and where a number of one box is less
// than a number of another, so is the float. Only equal numbers leave the answer to the floats. Nothing is
// rounded outward, and no epsilon is needed anywhere.
//
// A pair belongs to the brick that holds the larger of both lower corners, axis by axis. That point lies in
// both boxes if they overlap, so both were copied into that brick; and the point is in one brick alone.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/space.hpp"

#include <cmath>
#include <cstdint>

namespace scree {

inline constexpr int brick_bits = 14;
inline constexpr std::int32_t brick_points = 1 << brick_bits;
/// The largest local number. The numbers local to a brick cover one brick width below the brick, so that no
/// object narrower than a brick is cut off there, and the brick itself.
inline constexpr std::int32_t last_local = 2 * brick_points - 1;

/// A box in lattice numbers.
struct LatticeBox {
  std::int32_t lo[3];
  std::int32_t hi[3];
};

struct BrickLattice {
  float origin[3];  ///< lower corner of the lattice (m)
  float points_per_m[3];
  std::int32_t bricks[3];

  /// Returns the number of a coordinate. It is monotone; a coordinate outside of the lattice gets the first
  /// or the last number.
  SCREE_HD std::int32_t number_of(float coordinate, int axis) const {
    constexpr float most = 0x1.fffffep30f;
    const float number = fminf(fmaxf((coordinate - origin[axis]) * points_per_m[axis], 0.0f), most);
    const auto whole = static_cast<std::int32_t>(number);
    const std::int32_t last = bricks[axis] * brick_points - 1;
    return whole < last ? whole : last;
  }

  SCREE_HD LatticeBox numbers_of(const Aabb& box) const {
    LatticeBox numbers;
    for (int a = 0; a < 3; ++a) {
      numbers.lo[a] = number_of(box.lo[a], a);
      numbers.hi[a] = number_of(box.hi[a], a);
    }
    return numbers;
  }

  SCREE_HD std::int64_t total() const { return std::int64_t{bricks[0]} * bricks[1] * bricks[2]; }
  SCREE_HD std::uint32_t brick(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return static_cast<std::uint32_t>((z * bricks[1] + y) * bricks[0] + x);
  }
};

/// Bits of an object's tag: its body, whether its lower corner lies in the brick on each axis, and whether it
/// is not fixed. A pair is accepted by the union of both tags.
inline constexpr int owner_bits = 28;
inline constexpr std::uint32_t body_mask = (1u << owner_bits) - 1;
inline constexpr std::uint32_t not_fixed = 8u << owner_bits;
SCREE_HD inline constexpr std::uint32_t begins_here(int axis) { return 1u << (owner_bits + axis); }

/// An object in a brick. For each axis, the lower half of a word holds the lower local number, and the upper
/// half holds last_local minus the upper local number. Both have 15 bits, so that the sum of two does not
/// overflow.
struct alignas(16) Entry {
  std::uint32_t axis[3];
  std::uint32_t tag;  ///< body; begins_here for each axis; not_fixed

  SCREE_HD std::int32_t lo(int a) const { return static_cast<std::int32_t>(axis[a] & 0xffffu); }
  SCREE_HD std::int32_t hi(int a) const { return last_local - static_cast<std::int32_t>(axis[a] >> 16); }
  SCREE_HD std::uint32_t body() const { return tag & body_mask; }
};

/// Returns the entry of an object in the brick whose first numbers are `base`.
SCREE_HD inline Entry entry_in(const LatticeBox& box, const std::int32_t base[3], std::uint32_t tag) {
  Entry entry{{}, tag};
  for (int a = 0; a < 3; ++a) {
    const std::int32_t lo = box.lo[a] - base[a] + brick_points;
    const std::int32_t hi = box.hi[a] - base[a] + brick_points;
    if (lo >= brick_points) entry.tag |= begins_here(a);
    entry.axis[a] = static_cast<std::uint32_t>(lo > 0 ? lo : 0) |
                    static_cast<std::uint32_t>(last_local - (hi < last_local ? hi : last_local)) << 16;
  }
  return entry;
}

/// Returns the entry of one object of a test with its halves exchanged, so that the numbers to be compared
/// are in the same half.
SCREE_HD inline Entry facing(const Entry& entry) {
  Entry turned{{}, entry.tag};
  for (int a = 0; a < 3; ++a) turned.axis[a] = entry.axis[a] << 16 | entry.axis[a] >> 16;
  return turned;
}

// Each half of the sum of two entries is last_local - hi + lo: its highest bit is set if lo is the larger
// one.
inline constexpr std::uint32_t apart_bits = 0x80008000u;

/// Returns whether a pair belongs to this brick and its numbers overlap. If the numbers do not, neither do
/// the boxes.
SCREE_HD inline bool may_meet(const Entry& turned, const Entry& other) {
  const std::uint32_t apart =
      (turned.axis[0] + other.axis[0]) | (turned.axis[1] + other.axis[1]) | (turned.axis[2] + other.axis[2]);
  return (apart & apart_bits) == 0 && (turned.tag | other.tag) >= 15u << owner_bits;
}
/// Returns whether no numbers of such a pair are equal, so that its boxes overlap as well.
SCREE_HD inline bool meets_clearly(const Entry& turned, const Entry& other) {
  constexpr std::uint32_t one = 0x00010001u;
  const std::uint32_t apart = (turned.axis[0] + other.axis[0] + one) |
                              (turned.axis[1] + other.axis[1] + one) | (turned.axis[2] + other.axis[2] + one);
  return (apart & apart_bits) == 0;
}

}  // namespace scree
