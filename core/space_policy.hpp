// Thrust's execution policy in each space, and the primitives that Thrust does not have. For parallel sources
// alone: include parallel.hpp instead.
#pragma once

#include "core/error.hpp"
#include "core/space.hpp"
#include "core/thread_pool.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <thrust/system/tbb/execution_policy.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#if SCREE_WITH_CUDA
#include <cub/device/device_radix_sort.cuh>
#include <thrust/for_each.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/system/cuda/execution_policy.h>
#include <thrust/transform_reduce.h>

#include <cuda_runtime_api.h>
#endif

namespace scree::detail {

inline auto policy(Host) {
  ThreadPool::get().release_workers();
  return thrust::tbb::par;
}

/// Sorts n unsigned keys stably by their lowest `bits` bits, from the lowest digit: each block of keys counts
/// its digits, and thus knows where its keys go. The stable order is unique, so the number of blocks does not
/// matter. `along.move(from, to)` moves the data of a key, and `along.swap()` is called after each pass.
template <class Key, class Along>
void sort_by_digits(Key*& keys, Key*& spare_keys, std::int64_t n, int bits, const Along& along) {
  const int most_bits = n < 16384 ? 8 : 11;  // more buckets than keys, or than a cache has lines, are slower
  const int passes = std::max(1, (bits + most_bits - 1) / most_bits);
  const int digit_bits = (bits + passes - 1) / passes;
  const std::int64_t buckets = std::int64_t{1} << digit_bits;
  const std::int64_t blocks = std::clamp<std::int64_t>(n / 16384, 1, 4 * ThreadPool::most_threads());
  std::vector<std::int64_t> places(static_cast<std::size_t>(blocks * buckets));
  for (int shift = 0; shift < passes * digit_bits; shift += digit_bits) {
    const auto digit = [=](Key key) { return static_cast<std::int64_t>(key >> shift) & (buckets - 1); };
    std::ranges::fill(places, 0);
    for_each_block(n, blocks, [&](std::int64_t b, std::int64_t begin, std::int64_t end) {
      std::int64_t* count = places.data() + b * buckets;
      for (std::int64_t i = begin; i < end; ++i) ++count[digit(keys[i])];
    });
    std::int64_t place = 0;
    for (std::int64_t d = 0; d < buckets; ++d)
      for (std::int64_t b = 0; b < blocks; ++b)
        place += std::exchange(places[static_cast<std::size_t>(b * buckets + d)], place);
    for_each_block(n, blocks, [&](std::int64_t b, std::int64_t begin, std::int64_t end) {
      std::int64_t* next = places.data() + b * buckets;
      for (std::int64_t i = begin; i < end; ++i) {
        const std::int64_t to = next[digit(keys[i])]++;
        spare_keys[to] = keys[i];
        along.move(i, to);
      }
    });
    std::swap(keys, spare_keys);
    along.swap();
  }
}

template <class Value>
struct WithValues {
  Value*& values;
  Value*& spare;
  void move(std::int64_t from, std::int64_t to) const { spare[to] = values[from]; }
  void swap() const { std::swap(values, spare); }
};

struct KeysAlone {
  void move(std::int64_t, std::int64_t) const {}
  void swap() const {}
};

/// Sorts n pairs stably by the lowest `bits` bits of their unsigned keys. The sorted pairs are left in keys
/// and values; the spare arrays are overwritten.
template <class Key, class Value>
void sort_pairs(Host, Key*& keys, Value*& values, Key*& spare_keys, Value*& spare_values, std::int64_t n,
                int bits) {
  sort_by_digits(keys, spare_keys, n, bits, WithValues<Value>{values, spare_values});
}

/// Sorts n unsigned keys by their lowest `bits` bits. The sorted keys are left in keys; the spare array is
/// overwritten.
template <class Key>
void sort_keys(Host, Key*& keys, Key*& spare_keys, std::int64_t n, int bits) {
  sort_by_digits(keys, spare_keys, n, bits, KeysAlone{});
}

/// Sets counts[b] to the number of times that b occurs among n samples, for 0 <= b < bins.
template <class Samples>
void histogram(Host, Samples samples, std::int64_t n, int bins, std::uint32_t* counts) {
  using Counts = std::vector<std::uint32_t>;
  ThreadPool::get().release_workers();
  const Counts total = tbb::parallel_reduce(
      tbb::blocked_range<std::int64_t>(0, n, 4096), Counts(static_cast<std::size_t>(bins)),
      [samples](const tbb::blocked_range<std::int64_t>& range, Counts sum) {
        for (std::int64_t i = range.begin(); i < range.end(); ++i) {
          const auto bin = static_cast<std::size_t>(samples[i]);  // a negative sample becomes too large
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

/// Sets memory of Device to zero, in the order of the work launched.
inline void clear_bytes(void* memory, std::size_t bytes) {
  if (cudaMemsetAsync(memory, 0, bytes) != cudaSuccess) throw RunError("CUDA: could not clear memory");
}

/// Throws if the last kernel could not be started, which would otherwise look like a kernel that found
/// nothing.
inline void require_launched(const char* kernel) {
  if (const cudaError_t error = cudaGetLastError(); error != cudaSuccess)
    throw RunError(std::string("CUDA: ") + kernel + " could not be started: " + cudaGetErrorString(error));
}

/// An allocator for the scratch memory of Thrust's algorithms, from the same stream-ordered pool as the
/// arrays.
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

}  // namespace scree::detail

namespace scree {

namespace detail {

inline constexpr int threads_of_loop = 256;

template <class F>
__global__ void __launch_bounds__(threads_of_loop, F::blocks_at_once)
    call_for_each(const __grid_constant__ F f, std::int64_t n) {
  const std::int64_t i = std::int64_t{blockIdx.x} * threads_of_loop + threadIdx.x;
  if (i < n) f(i);
}

}  // namespace detail

/// Runs a loop on Device. core/parallel_loops.hpp finds this function and launch_reduce() by
/// argument-dependent lookup. F::blocks_at_once is the least number of blocks that share a multiprocessor,
/// for work that would take too many registers.
template <class F>
void launch_for_each(Device, std::int64_t n, const F& f) {
  if constexpr (requires { F::blocks_at_once; }) {
    if (n <= 0) return;
    const auto blocks = static_cast<unsigned>((n + detail::threads_of_loop - 1) / detail::threads_of_loop);
    detail::call_for_each<<<blocks, detail::threads_of_loop>>>(f, n);
    detail::require_launched("a loop");
  } else {
    thrust::for_each_n(detail::policy(Device{}), thrust::counting_iterator<std::int64_t>(0), n, f);
  }
}
template <class T, class F, class Join>
T launch_reduce(Device, std::int64_t n, const F& f, const T& neutral, const Join& join) {
  const thrust::counting_iterator<std::int64_t> first(0);
  return thrust::transform_reduce(detail::policy(Device{}), first, first + n, f, neutral, join);
}

}  // namespace scree

namespace scree::detail {

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

template <class Key>
void sort_keys(Device, Key*& keys, Key*& spare_keys, std::int64_t n, int bits) {
  cub::DoubleBuffer<Key> buffer(keys, spare_keys);
  std::size_t bytes = 0;
  cub::DeviceRadixSort::SortKeys(nullptr, bytes, buffer, n, 0, bits);
  void* scratch = Device::allocate(bytes);
  cub::DeviceRadixSort::SortKeys(scratch, bytes, buffer, n, 0, bits);
  Device::deallocate(scratch);
  keys = buffer.Current();
  spare_keys = buffer.Alternate();
}

/// Counts samples in shared memory of each block; lanes with the same sample add once, since often all
/// samples are alike.
template <class Samples>
__global__ void __launch_bounds__(256)
    count_samples(Samples samples, std::int64_t n, int bins, std::uint32_t* counts) {
  extern __shared__ std::uint32_t in_block[];
  for (int b = static_cast<int>(threadIdx.x); b < bins; b += 256) in_block[b] = 0;
  __syncthreads();
  const unsigned lane = threadIdx.x % 32;
  const std::int64_t stride = std::int64_t{gridDim.x} * 256;
  for (std::int64_t warp = std::int64_t{blockIdx.x} * 256 + threadIdx.x - lane; warp < n; warp += stride) {
    const std::int64_t i = warp + lane;
    const int bin = i < n ? static_cast<int>(samples[i]) : -1;
    const unsigned alike = __match_any_sync(0xffffffffu, bin);
    const bool first = (alike & ((1u << lane) - 1)) == 0;
    if (first && bin >= 0 && bin < bins) atomicAdd(&in_block[bin], static_cast<unsigned>(__popc(alike)));
  }
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < bins; b += 256)
    if (in_block[b] > 0) atomicAdd(&counts[b], in_block[b]);
}

template <class Samples>
void histogram(Device, Samples samples, std::int64_t n, int bins, std::uint32_t* counts) {
  constexpr std::int64_t most_blocks = 2048;  // more would add to the same counters more often
  const std::size_t bytes = static_cast<std::size_t>(bins) * sizeof(std::uint32_t);
  clear_bytes(counts, bytes);
  const std::int64_t blocks = std::min((n + 255) / 256, most_blocks);
  if (blocks == 0) return;
  count_samples<<<static_cast<unsigned>(blocks), 256, bytes>>>(samples, n, bins, counts);
  require_launched("the histogram");
}

#endif

}  // namespace scree::detail
