// How Thrust is asked to run in each space, and the primitives that Thrust cannot say. With parallel.hpp one
// of the two headers that reach Thrust and CUB: include parallel.hpp instead, in parallel libraries alone.
#pragma once

#include "core/space.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <thrust/sort.h>
#include <thrust/system/tbb/execution_policy.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#if SCREE_WITH_CUDA
#include <cub/device/device_histogram.cuh>
#include <cub/device/device_radix_sort.cuh>
#include <thrust/system/cuda/execution_policy.h>
#endif

namespace scree::detail {

inline auto policy(Host) { return thrust::tbb::par; }

/// Stable sort of n pairs by the lowest `bits` bits of their unsigned keys. The sorted pairs are left in
/// keys and values; the spare arrays are overwritten.
template <class Key, class Value>
void sort_pairs(Host, Key*& keys, Value*& values, Key*&, Value*&, std::int64_t n, int) {
  thrust::stable_sort_by_key(policy(Host{}), keys, keys + n, values);
}

/// counts[b] = how often b occurs among n samples, for 0 <= b < bins.
template <class Samples>
void histogram(Host, Samples samples, std::int64_t n, int bins, std::uint32_t* counts) {
  using Counts = std::vector<std::uint32_t>;
  const Counts total = tbb::parallel_reduce(
      tbb::blocked_range<std::int64_t>(0, n, 4096), Counts(static_cast<std::size_t>(bins)),
      [samples](const tbb::blocked_range<std::int64_t>& range, Counts sum) {
        for (std::int64_t i = range.begin(); i < range.end(); ++i) {
          const auto bin = static_cast<std::size_t>(samples[i]);  // a negative one becomes too large
          if (bin < sum.size()) ++sum[bin];
        }
        return sum;
      },
      [](Counts a, const Counts& b) {
        for (std::size_t k = 0; k < a.size(); ++k) a[k] += b[k];
        return a;
      });
  std::copy(total.begin(), total.end(), counts);
}

#if SCREE_WITH_CUDA

/// Scratch memory of Thrust's algorithms, from the same stream-ordered pool as the arrays.
struct PoolAllocator {
  using value_type = char;
  char* allocate(std::ptrdiff_t bytes) {
    return static_cast<char*>(Device::allocate(static_cast<std::size_t>(bytes)));
  }
  void deallocate(char* memory, std::size_t) { Device::deallocate(memory); }
};

inline auto policy(Device) {
  static PoolAllocator pool;
  return thrust::cuda::par_nosync(pool);
}

template <class Key, class Value>
void sort_pairs(Device, Key*& keys, Value*& values, Key*& spare_keys, Value*& spare_values, std::int64_t n,
                int bits) {
  cub::DoubleBuffer<Key> key_buffer(keys, spare_keys);
  cub::DoubleBuffer<Value> value_buffer(values, spare_values);
  std::size_t bytes = 0;
  cub::DeviceRadixSort::SortPairs(nullptr, bytes, key_buffer, value_buffer, n, 0, bits);
  void* scratch = Device::allocate(bytes);
  cub::DeviceRadixSort::SortPairs(scratch, bytes, key_buffer, value_buffer, n, 0, bits);
  Device::deallocate(scratch);
  keys = key_buffer.Current();
  values = value_buffer.Current();
  spare_keys = key_buffer.Alternate();
  spare_values = value_buffer.Alternate();
}

template <class Samples>
void histogram(Device, Samples samples, std::int64_t n, int bins, std::uint32_t* counts) {
  std::size_t bytes = 0;
  cub::DeviceHistogram::HistogramEven(nullptr, bytes, samples, counts, bins + 1, 0, bins, n);
  void* scratch = Device::allocate(bytes);
  cub::DeviceHistogram::HistogramEven(scratch, bytes, samples, counts, bins + 1, 0, bins, n);
  Device::deallocate(scratch);
}

#endif

}  // namespace scree::detail
