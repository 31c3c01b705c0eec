// A search in sorted keys, for either space: those of the standard library are silently wrong on Device.
#pragma once

#include "core/space.hpp"

#include <cstdint>

namespace scree {

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
