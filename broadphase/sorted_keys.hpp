// Keys to sort floats by, and a search in sorted keys, for either space: those of the standard library are
// silently wrong on Device.
#pragma once

#include "core/space.hpp"

#include <bit>
#include <cstdint>

namespace scree {

/// Unsigned numbers in the order of the floats that they stand for; 0 and -0 are one.
SCREE_HD inline std::uint32_t ordered_bits(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0f);  // -0 becomes 0
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}
SCREE_HD inline float from_ordered_bits(std::uint32_t bits) {
  return std::bit_cast<float>(bits >> 31 ? bits & 0x7fffffffu : ~bits);
}

/// The first of the keys from `begin` to before `end` that is not under `value`; `end` if all are.
template <class Key>
SCREE_HD std::int64_t first_not_under(const Key* keys, std::int64_t begin, std::int64_t end, Key value) {
  while (begin < end) {
    const std::int64_t middle = begin + (end - begin) / 2;
    if (keys[middle] < value) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin;
}

}  // namespace scree
