// Counter-based random numbers: the stream of a body depends on the scene's seed and the body's number alone,
// so neither the order of calls nor the number of threads can change a scene.
#pragma once

#include "core/space.hpp"

#include <array>
#include <cstdint>

namespace scree {

/// Computes Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011, "Parallel random numbers: as easy as 1, 2, 3",
/// sec. 3.3).
SCREE_HD inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                    std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = 0xD2511F53ull * counter[0];
    const std::uint64_t b = 0xCD9E8D57ull * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

/// The stream of random numbers of one item (a body, say) of a seeded scene.
class Random {
 public:
  SCREE_HD Random(std::uint64_t seed, std::uint64_t item)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}, item_(item) {}

  /// Returns a number uniform in [0, 1), with 53 random bits.
  SCREE_HD double uniform() {
    const std::array<std::uint32_t, 4> bits = philox(
        {static_cast<std::uint32_t>(item_), static_cast<std::uint32_t>(item_ >> 32), draw_++, 0u}, key_);
    const std::uint64_t word = (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
    return static_cast<double>(word >> 11) * 0x1p-53;
  }
  /// Returns a number uniform in [low, high).
  SCREE_HD double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::array<std::uint32_t, 2> key_;
  std::uint64_t item_;
  std::uint32_t draw_ = 0;
};

}  // namespace scree
