// What the plan of the bricks has to know, from some of the objects, on Device.
#pragma once

#include "broadphase/device/brick_scatter.hpp"

namespace scree {

inline constexpr int sample_threads = 256;
inline constexpr int sample_blocks = 64;

struct Sampled {
  const Aabb* bounds;
  std::int64_t count;
  std::int64_t looked_at;

  __device__ Aabb operator()(std::int64_t k) const { return bounds[k * count / looked_at]; }
};

__device__ inline std::uint32_t max_of_warp(std::uint32_t value) {
  for (int d = 16; d > 0; d /= 2) value = max(value, __shfl_xor_sync(detail::all_lanes, value, d));
  return value;
}

/// Extremes and sizes. The sample's lo stands inverted meanwhile, so that all begins with zero.
__global__ void __launch_bounds__(sample_threads)
    sample_sizes(const __grid_constant__ Sampled sampled, BrickSample* sample) {
  __shared__ std::uint32_t sizes[BrickSample::size_bins];
  for (int b = static_cast<int>(threadIdx.x); b < BrickSample::size_bins; b += sample_threads) sizes[b] = 0;
  __syncthreads();
  std::uint32_t lo[3] = {}, hi[3] = {}, largest = 0;
  for (std::int64_t k = std::int64_t{blockIdx.x} * sample_threads + threadIdx.x; k < sampled.looked_at;
       k += sample_blocks * sample_threads) {
    const Aabb box = sampled(k);
    if (!is_proper(box)) continue;
    for (int a = 0; a < 3; ++a) {
      const std::uint32_t centre = ordered_bits(static_cast<float>(centre_of(box, a)));
      lo[a] = max(lo[a], ~centre);
      hi[a] = max(hi[a], centre);
    }
    const float extent = extent_of(box);
    largest = max(largest, std::bit_cast<std::uint32_t>(extent));
    atomicAdd(&sizes[size_class(extent)], 1u);
  }
  largest = max_of_warp(largest);
  if (threadIdx.x % 32 == 0) atomicMax(&sample->largest, largest);
  for (int a = 0; a < 3; ++a) {
    lo[a] = max_of_warp(lo[a]);
    hi[a] = max_of_warp(hi[a]);
    if (threadIdx.x % 32 == 0) {
      atomicMax(&sample->lo[a], lo[a]);
      atomicMax(&sample->hi[a], hi[a]);
    }
  }
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < BrickSample::size_bins; b += sample_threads)
    if (sizes[b] > 0) atomicAdd(&sample->sizes[b], sizes[b]);
}

__global__ void __launch_bounds__(sample_threads)
    sample_places(const __grid_constant__ Sampled sampled, BrickSample* sample) {
  constexpr int width = BrickSample::width;
  constexpr int places = width * width * width;
  __shared__ std::uint32_t counts[places];
  for (int b = static_cast<int>(threadIdx.x); b < places; b += sample_threads) counts[b] = 0;
  __syncthreads();
  float lo[3], inverse[3];
  for (int a = 0; a < 3; ++a) {
    lo[a] = from_ordered_bits(~sample->lo[a]);
    const float length = from_ordered_bits(sample->hi[a]) - lo[a];
    inverse[a] = length > 0 ? width / length : 0;
  }
  for (std::int64_t k = std::int64_t{blockIdx.x} * sample_threads + threadIdx.x; k < sampled.looked_at;
       k += sample_blocks * sample_threads) {
    const Aabb box = sampled(k);
    if (!is_proper(box)) continue;
    int place = 0;
    for (int a = 0; a < 3; ++a)
      place = place * width +
              min(max(static_cast<int>((static_cast<float>(centre_of(box, a)) - lo[a]) * inverse[a]), 0),
                  width - 1);
    atomicAdd(&counts[place], 1u);
  }
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < places; b += sample_threads)
    if (counts[b] > 0) atomicAdd(&sample->places[b], counts[b]);
}

}  // namespace scree
