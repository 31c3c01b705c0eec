// The kernels that sample some of the objects for the plan of the bricks, on Device.
#pragma once

#include "broadphase/aabb.hpp"
#include "broadphase/brick_plan.hpp"
#include "core/space_warp.hpp"

namespace scree {

inline constexpr int sample_threads = 1024;
inline constexpr int sample_blocks = 64;

struct Sampled {
  const Aabb* bounds;
  std::int64_t count;

  /// Calls f(box) for the objects of the sample that belong to this thread.
  template <class F>
  __device__ void for_each(const F& f) const {
    for (std::int64_t k = std::int64_t{blockIdx.x} * sample_threads + threadIdx.x;
         k < BrickSample::looked_at(count); k += sample_blocks * sample_threads) {
      const Aabb box = bounds[BrickSample::object(k, count)];
      if (is_proper(box)) f(box);
    }
  }
};

/// Raises a shared word to the largest of the values of a warp.
__device__ inline void raise(std::uint32_t& word, std::uint32_t value) {
  for (int d = 16; d > 0; d /= 2) value = max(value, __shfl_xor_sync(detail::all_lanes, value, d));
  if (threadIdx.x % 32 == 0) atomicMax(&word, value);
}

/// Finds the extremes and the sizes of the sample. The bits of the sample's lo are inverted here, so that all
/// members can begin with zero.
__global__ void __launch_bounds__(sample_threads)
    sample_sizes(const __grid_constant__ Sampled sampled, BrickSample* sample) {
  __shared__ std::uint32_t sizes[BrickSample::size_bins];
  __shared__ std::uint32_t extreme[7];
  if (threadIdx.x < 7) extreme[threadIdx.x] = 0;
  for (int b = static_cast<int>(threadIdx.x); b < BrickSample::size_bins; b += sample_threads) sizes[b] = 0;
  __syncthreads();
  std::uint32_t lo[3] = {}, hi[3] = {}, largest = 0;
  sampled.for_each([&](const Aabb& box) {
    for (int a = 0; a < 3; ++a) {
      const std::uint32_t centre = ordered_bits(static_cast<float>(centre_of(box, a)));
      lo[a] = max(lo[a], ~centre);
      hi[a] = max(hi[a], centre);
    }
    const float extent = extent_of(box);
    largest = max(largest, std::bit_cast<std::uint32_t>(extent));
    atomicAdd(&sizes[size_class(extent)], 1u);
  });
  // The extremes are first reduced in the block, because otherwise all threads would wait for the same few
  // words.
  raise(extreme[0], largest);
  for (int a = 0; a < 3; ++a) {
    raise(extreme[1 + a], lo[a]);
    raise(extreme[4 + a], hi[a]);
  }
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < BrickSample::size_bins; b += sample_threads)
    if (sizes[b] > 0) atomicAdd(&sample->sizes[b], sizes[b]);
  if (threadIdx.x == 0) atomicMax(&sample->largest, extreme[0]);
  if (threadIdx.x < 3) {
    atomicMax(&sample->lo[threadIdx.x], extreme[1 + threadIdx.x]);
    atomicMax(&sample->hi[threadIdx.x], extreme[4 + threadIdx.x]);
  }
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
  sampled.for_each([&](const Aabb& box) {
    int place = 0;
    for (int a = 0; a < 3; ++a)
      place = place * width +
              min(max(static_cast<int>((static_cast<float>(centre_of(box, a)) - lo[a]) * inverse[a]), 0),
                  width - 1);
    atomicAdd(&counts[place], 1u);
  });
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < places; b += sample_threads)
    if (counts[b] > 0) atomicAdd(&sample->places[b], counts[b]);
}

}  // namespace scree
