// Keys by which floats are sorted, and a search in sorted keys, for either space: the functions of the
// standard library are silently wrong on Device.
#pragma once

#include "core/space.hpp"

#include <bit>
#include <cstdint>

namespace scree {

/// Returns an unsigned number; these numbers have the order of the floats. 0 and -0 have the same number.
SCREE_HD inline std::uint32_t ordered_bits(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0f);  // -0 becomes 0
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}
SCREE_HD inline float from_ordered_bits(std::uint32_t bits) {
  return std::bit_cast<float>(bits >> 31 ? bits & 0x7fffffffu : ~bits);
}

/// Returns the index of the first key from `begin` to before `end` that is not less than `value`; `end` if
/// all are less.
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
