// Work in tiles of consecutive items: what a tile finds is put side by side at its front, what it sums up is
// one number, and neither waits for other tiles or for the host. For parallel libraries alone.
#pragma once

#include "core/array.hpp"
#include "core/parallel.hpp"
#include "core/space_warp.hpp"
#include "core/timing.hpp"

#include <cstdint>
#include <type_traits>

namespace scree::parallel {

/// Items of a tile. On Device a tile is a block's.
inline constexpr int tile = 256;

inline std::int64_t tiles_of(std::int64_t items) { return (items + tile - 1) / tile; }

namespace detail {

/// One tile on Host.
template <class F>
struct CompactTile {
  F f;
  std::int32_t* counts;
  void operator()(std::int64_t t) const {
    std::int32_t count = 0;
    for (std::int64_t item = t * tile; item < (t + 1) * tile; ++item) {
      typename F::Record record;
      if (f.find(item, record)) f.store(t * tile + count++, item, record);
    }
    counts[t] = count;
  }
};

template <class T, class F>
struct SumTile {
  F f;
  T* sums;
  void operator()(std::int64_t t) const {
    T sum = f(t * tile);
    for (std::int64_t item = t * tile + 1; item < (t + 1) * tile; ++item) sum = sum + f(item);
    sums[t] = sum;
  }
};

template <class F>
void compact(Host, const char* label, std::int64_t tiles, const F& f, std::int32_t* counts) {
  parallel::for_each<Host>(label, tiles, CompactTile<F>{f, counts});
}
template <class T, class F>
void sum_each(Host, const char* label, std::int64_t tiles, const F& f, T* sums) {
  parallel::for_each<Host>(label, tiles, SumTile<T, F>{f, sums});
}

/// f(i), and nothing beyond n.
template <class T, class F>
struct UpTo {
  F f;
  std::int64_t n;
  SCREE_HD T operator()(std::int64_t i) const { return i < n ? f(i) : T{}; }
};

#if SCREE_WITH_CUDA

template <class F>
__global__ void __launch_bounds__(tile) compact_tile(F f, std::int32_t* counts) {
  __shared__ std::uint32_t sums[tile / 32];
  const std::int64_t first = std::int64_t{blockIdx.x} * tile;
  typename F::Record record;
  const bool found = f.find(first + threadIdx.x, record);
  std::uint32_t total;
  const std::uint32_t before = scree::detail::sum_before_in_block<tile>(found ? 1u : 0u, sums, total);
  if (found) f.store(first + before, first + threadIdx.x, record);
  if (threadIdx.x == 0) counts[blockIdx.x] = static_cast<std::int32_t>(total);
}

/// A tree of fixed shape: halves are added to one another.
template <class T, class F>
__global__ void __launch_bounds__(tile) sum_tile(F f, T* sums) {
  __shared__ typename std::aligned_storage<sizeof(T), alignof(T)>::type memory[tile];
  T* const part = reinterpret_cast<T*>(memory);
  part[threadIdx.x] = f(std::int64_t{blockIdx.x} * tile + threadIdx.x);
  for (unsigned half = tile / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) part[threadIdx.x] = part[threadIdx.x] + part[threadIdx.x + half];
  }
  if (threadIdx.x == 0) sums[blockIdx.x] = part[0];
}

template <class F>
void compact(Device, const char* label, std::int64_t tiles, const F& f, std::int32_t* counts) {
  const timing::Call<Device> call(label);
  compact_tile<<<static_cast<unsigned>(tiles), tile>>>(f, counts);
  scree::detail::require_launched(label);
}
template <class T, class F>
void sum_each(Device, const char* label, std::int64_t tiles, const F& f, T* sums) {
  const timing::Call<Device> call(label);
  sum_tile<T><<<static_cast<unsigned>(tiles), tile>>>(f, sums);
  scree::detail::require_launched(label);
}

#endif

}  // namespace detail

/// For each item of so many tiles: f.find(item, record), which says whether there is something; what is found
/// is stored by f.store(place, item, record), in the order of the items, from the front of its tile on.
/// counts[t] becomes how much tile t has found. F has a type Record. On Device the call returns before the
/// work is done.
template <class Space, class F>
void compact_tiles(const char* label, std::int64_t tiles, const F& f, std::int32_t* counts) {
  if (tiles > 0) detail::compact(Space{}, label, tiles, f, counts);
}

/// sums[t] = sum of f(item) over the items of tile t, as T with an operator +. The tree of the additions is
/// fixed. f may write what belongs to its item. On Device the call returns before the work is done.
template <class T, class Space, class F>
void sum_tiles(const char* label, std::int64_t tiles, const F& f, T* sums) {
  if (tiles > 0) detail::sum_each(Space{}, label, tiles, f, sums);
}

/// *out = sum of f(i) over 0 <= i < n, T{} for n = 0; out is in the space, and so nobody waits for it. The
/// tree of the additions depends on n alone. `scratch` keeps its storage from call to call.
template <class T, class Space, class F>
void sum_into(const char* label, std::int64_t n, const F& f, Array<T, Space>& scratch, T* out) {
  std::int64_t items = n;
  std::int64_t room = 0;
  do {
    items = tiles_of(items);
    room += items;
  } while (items > 1);
  scratch.resize(room);
  T* from = scratch.data();
  items = tiles_of(n);
  sum_tiles<T, Space>(label, std::max<std::int64_t>(items, 1), detail::UpTo<T, F>{f, n},
                      items > 1 ? from : out);
  while (items > 1) {
    const std::int64_t sums = tiles_of(items);
    sum_tiles<T, Space>(label, sums, detail::UpTo<T, detail::Load<T>>{{from}, items},
                        sums > 1 ? from + items : out);
    from += items;
    items = sums;
  }
}

/// The same, brought to the host: on Device faster than sum(), and on Host the same to the bit.
template <class T, class Space, class F>
T sum_by_tiles(const char* label, std::int64_t n, const F& f) {
  Array<T, Space> scratch, out(1);
  sum_into<T, Space>(label, n, f, scratch, out.data());
  T sum;
  copy_bytes<Host, Space>(&sum, out.data(), sizeof(sum));
  return sum;
}

}  // namespace scree::parallel
