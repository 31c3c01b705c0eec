// Sums over the lanes of a warp, the warps of a block and the blocks of a launch, on Device. For parallel
// sources alone.
#pragma once

#include "core/space.hpp"

#include <cstdint>

#if SCREE_WITH_CUDA

namespace scree::detail {

using Word = unsigned long long;

inline constexpr unsigned all_lanes = 0xffffffffu;

/// Returns the sum of the values of the lanes before this one; `total` becomes the sum of all lanes.
template <class T>
__device__ T sum_before(T value, T& total) {
  const unsigned lane = threadIdx.x % 32;
  T sum = value;
  for (unsigned d = 1; d < 32; d *= 2) {
    const T other = __shfl_up_sync(all_lanes, sum, d);
    if (lane >= d) sum += other;
  }
  total = __shfl_sync(all_lanes, sum, 31);
  return sum - value;
}

/// Returns the sum of the values of the threads before this one; `total` becomes the sum of all threads. All
/// threads of a block must call it. `sums` is shared memory, one word for each warp, which must not be in use
/// any more.
template <int threads>
__device__ std::uint32_t sum_before_in_block(std::uint32_t value, std::uint32_t* sums, std::uint32_t& total) {
  std::uint32_t of_warp;
  std::uint32_t before = sum_before(value, of_warp);
  if (threadIdx.x % 32 == 0) sums[threadIdx.x / 32] = of_warp;
  __syncthreads();
  total = 0;
#pragma unroll
  for (unsigned w = 0; w < threads / 32; ++w) {
    if (w < threadIdx.x / 32) before += sums[w];
    total += sums[w];
  }
  return before;
}

// Decoupled look-back (Merrill and Garland 2016, "Single-pass Parallel Prefix Scan with Decoupled
// Look-back"): each tile of a launch publishes its own number of results as soon as it is known, and then the
// number of results of itself and all tiles before it. A tile that others wait for must have started.

inline constexpr Word tile_known = Word{1} << 62;
inline constexpr Word tile_summed = Word{2} << 62;
inline constexpr Word tile_value = tile_known - 1;

__device__ inline Word load_state(const Word* state) {
  Word value;
  asm volatile("ld.relaxed.gpu.global.u64 %0, [%1];" : "=l"(value) : "l"(state) : "memory");
  return value;
}
__device__ inline void store_state(Word* state, Word value) {
  asm volatile("st.relaxed.gpu.global.u64 [%0], %1;" ::"l"(state), "l"(value) : "memory");
}

/// Publishes the number of results that a tile has found, and returns the number of all tiles before it. One
/// warp calls it, and reads the states of 256 tiles at once.
__device__ inline Word found_before(Word* states, std::int64_t tile, Word found) {
  constexpr int at_once = 8;
  const int lane = static_cast<int>(threadIdx.x % 32);
  if (lane == 0) store_state(states + tile, (tile == 0 ? tile_summed : tile_known) | found);
  Word sum = 0;
  bool done = tile == 0;
  for (std::int64_t last = tile - 1; !done; last -= 32 * at_once) {
    Word state[at_once];
#pragma unroll
    for (int k = 0; k < at_once; ++k) {
      const std::int64_t before = last - 32 * k - lane;
      state[k] = before >= 0 ? load_state(states + before) : tile_summed;
    }
#pragma unroll
    for (int k = 0; k < at_once; ++k) {
      if (done) continue;
      while (state[k] < tile_known) state[k] = load_state(states + last - 32 * k - lane);
      const unsigned summed = __ballot_sync(all_lanes, state[k] >= tile_summed);
      const int nearest = summed ? __ffs(static_cast<int>(summed)) - 1 : 31;
      Word value = lane <= nearest ? state[k] & tile_value : 0;
      for (int d = 16; d > 0; d /= 2) value += __shfl_xor_sync(all_lanes, value, d);
      sum += value;
      done = summed != 0;
    }
  }
  if (lane == 0 && tile > 0) store_state(states + tile, tile_summed | (sum + found));
  return sum;
}

}  // namespace scree::detail

#endif
