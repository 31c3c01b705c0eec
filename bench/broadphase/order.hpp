// The objects of a benchmark, and the orders in which a broad phase gets them.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/rng.hpp"

#include <bit>
#include <cstdint>

namespace scree::bench {

/// The input of a broad phase.
template <class Space>
struct Objects {
  Array<Aabb, Space> bounds;
  Array<Mobility, Space> mobility;
};

/// A permutation of 0 to n - 1 without a table, different for each seed. It is a Feistel network of six
/// rounds (Luby and Rackoff 1988) over the least power of four that is not less than n. The network is
/// applied again while its result is n or more (Black and Rogaway 2002, "Ciphers with arbitrary finite
/// domains").
class Permutation {
 public:
  Permutation(std::int64_t n, std::uint64_t seed)
      : n_(static_cast<std::uint64_t>(n)), half_bits_((static_cast<int>(std::bit_width(n_ - 1)) + 1) / 2) {
    for (int round = 0; round < rounds; ++round)
      key_[round] = philox({static_cast<std::uint32_t>(round), 0, 0, 0},
                           {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)})[0];
  }

  SCREE_HD std::int64_t operator()(std::int64_t i) const {
    auto x = static_cast<std::uint64_t>(i);
    do {
      x = once(x);
    } while (x >= n_);
    return static_cast<std::int64_t>(x);
  }

 private:
  static constexpr int rounds = 6;

  SCREE_HD std::uint64_t once(std::uint64_t x) const {
    const std::uint32_t mask = (1u << half_bits_) - 1;
    auto left = static_cast<std::uint32_t>(x >> half_bits_);
    auto right = static_cast<std::uint32_t>(x) & mask;
    for (const std::uint32_t key : key_) {
      const std::uint32_t next = left ^ (mixed(right ^ key) & mask);
      left = right;
      right = next;
    }
    return std::uint64_t{left} << half_bits_ | right;
  }
  /// Returns the hash of murmur3's finaliser (Appleby 2011).
  SCREE_HD static std::uint32_t mixed(std::uint32_t h) {
    h = (h ^ (h >> 16)) * 0x85EBCA6Bu;
    h = (h ^ (h >> 13)) * 0xC2B2AE35u;
    return h ^ (h >> 16);
  }

  std::uint64_t n_;
  int half_bits_;
  std::uint32_t key_[rounds];
};

/// Permutes the objects: object i of `to` is object permutation(i) of `from`.
template <class Space>
void permute(const Objects<Space>& from, const Permutation& permutation, Objects<Space>& to);

/// Sorts the objects by the cells that hold their centres, by z, then y, then x. The cells are as wide as the
/// mean extent of the objects. Absent objects come last.
template <class Space>
void sort_into_rows(const Objects<Space>& from, Objects<Space>& to);

}  // namespace scree::bench
