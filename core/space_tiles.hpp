// Work in tiles of consecutive items: the results of a tile are stored side by side at its front, and sums
// over many tiles are computed without waiting for the host. For parallel sources alone.
#pragma once

#include "core/array.hpp"
#include "core/parallel.hpp"
#include "core/space_warp.hpp"
#include "core/timing.hpp"

#include <algorithm>
#include <cstdint>

namespace scree::parallel {

/// Number of items of a tile. On Device one thread block works on one tile.
inline constexpr int tile = 256;

inline std::int64_t tiles_of(std::int64_t items) { return (items + tile - 1) / tile; }

namespace detail {

/// The work on one tile on Host.
template <class F>
struct CompactTile {
  F f;
  std::int32_t* counts;
  void operator()(std::int64_t t) const {
    std::int32_t count = 0;
    for (std::int64_t item = t * tile; item < (t + 1) * tile && !f.is_end(item); ++item) {
      typename F::Record record;
      if (f.find(item, record)) f.store(t * tile + count++, item, record);
    }
    counts[t] = count;
  }
};

template <class F>
void visit_found(Host, const char* label, std::int64_t tiles, const std::int32_t* counts, const F& f) {
  constexpr std::int64_t few_tiles = 16;
  parallel::for_each<Host>(
      label, tiles,
      [counts, f](std::int64_t t) {
        for (std::int32_t k = 0; k < counts[t]; ++k) f(t, k);
      },
      few_tiles);
}
template <class F>
void compact(Host, const char* label, std::int64_t tiles, const F& f, std::int32_t* counts) {
  constexpr std::int64_t few_tiles = 2;
  parallel::for_each<Host>(label, tiles, CompactTile<F>{f, counts}, few_tiles);
}
template <class T, class F>
void add_up(Host, const char* label, std::int64_t n, const F& f, Array<T, Host>&, T* out) {
  *out = parallel::sum<T, Host>(label, n, f);
}

#if SCREE_WITH_CUDA

/// Returns the least number of blocks that share a multiprocessor; a program may set it if it would take too
/// many registers.
template <class F>
constexpr int blocks_at_once() {
  if constexpr (requires { F::blocks_at_once; }) return F::blocks_at_once;
  return 1;
}

template <class F>
constexpr bool has_kinds() {
  if constexpr (requires { F::kinds; }) return F::kinds > 0;
  return false;
}

template <class F>
__global__ void __launch_bounds__(tile, blocks_at_once<F>())
    compact_tile(const __grid_constant__ F f, std::int32_t* counts) {
  __shared__ std::uint32_t sums[tile / 32];
  const std::int64_t first = std::int64_t{blockIdx.x} * tile;
  typename F::Record record;
  std::uint32_t total;
  const bool found = f.find(first + threadIdx.x, record);
  const std::uint32_t before = scree::detail::sum_before_in_block<tile>(found ? 1u : 0u, sums, total);
  if (found) f.store(first + before, first + threadIdx.x, record);
  if (threadIdx.x == 0) counts[blockIdx.x] = static_cast<std::int32_t>(total);
}

// Search kind by kind: the items of all tiles are listed kind after kind, so that the threads of a warp do
// the same work, and items of no kind leave no thread idle. The order within a kind depends on the order of
// the blocks. That changes nothing, since the results are stored item by item before they are compacted.

/// What is known of an item: its kind, or one of these.
enum : std::uint8_t { no_kind = 255, found_item = 254 };

/// The numbers of items of each kind, and how many of them have been listed.
template <int kinds>
struct KindCounts {
  std::uint32_t all[kinds], listed[kinds];
};

template <class F>
__global__ void __launch_bounds__(tile)
    note_kinds(const __grid_constant__ F f, std::uint8_t* kinds, KindCounts<F::kinds>* counts) {
  const std::int64_t item = std::int64_t{blockIdx.x} * tile + threadIdx.x;
  const int kind = f.kind(item);
  kinds[item] = kind < 0 ? no_kind : static_cast<std::uint8_t>(kind);
  for (int k = 0; k < F::kinds; ++k) {
    const int of_kind = __syncthreads_count(kind == k);
    if (threadIdx.x == 0 && of_kind > 0) atomicAdd(&counts->all[k], static_cast<unsigned>(of_kind));
  }
}

template <int kind_count>
__global__ void __launch_bounds__(tile)
    list_kinds(const std::uint8_t* kinds, KindCounts<kind_count>* counts, std::int32_t* list) {
  __shared__ std::uint32_t sums[kind_count][tile / 32];
  __shared__ std::uint32_t place;
  const std::int64_t item = std::int64_t{blockIdx.x} * tile + threadIdx.x;
  const int kind = kinds[item];
  std::uint32_t begin = 0;
  for (int k = 0; k < kind_count; ++k) {
    std::uint32_t total;
    const std::uint32_t before =
        scree::detail::sum_before_in_block<tile>(kind == k ? 1u : 0u, sums[k], total);
    if (threadIdx.x == 0) place = begin + atomicAdd(&counts->listed[k], total);
    __syncthreads();
    if (kind == k) list[place + before] = static_cast<std::int32_t>(item);
    __syncthreads();
    begin += counts->all[k];
  }
}

template <class F>
__global__ void __launch_bounds__(tile, blocks_at_once<F>())
    find_listed(const __grid_constant__ F f, const std::int32_t* list, const KindCounts<F::kinds>* counts,
                std::uint8_t* kinds) {
  std::uint32_t all = 0;
  for (int k = 0; k < F::kinds; ++k) all += counts->all[k];
  const std::uint32_t place = blockIdx.x * tile + threadIdx.x;
  if (place >= all) return;
  const std::int64_t item = list[place];
  typename F::Record record;
  if (!f.find(item, record)) return;
  f.keep(item, record);
  kinds[item] = found_item;
}

template <class F>
__global__ void __launch_bounds__(tile)
    compact_found(const __grid_constant__ F f, const std::uint8_t* kinds, std::int32_t* counts) {
  __shared__ std::uint32_t sums[tile / 32];
  const std::int64_t first = std::int64_t{blockIdx.x} * tile;
  const bool found = kinds[first + threadIdx.x] == found_item;
  std::uint32_t total;
  const std::uint32_t before = scree::detail::sum_before_in_block<tile>(found ? 1u : 0u, sums, total);
  if (found) f.place(first + before, first + threadIdx.x);
  if (threadIdx.x == 0) counts[blockIdx.x] = static_cast<std::int32_t>(total);
}

/// Returns the sum over the threads of a block, in its first thread: a tree of fixed shape, in which halves
/// are added to one another. `memory` has room for one T of each thread, and is free again after the next
/// barrier.
template <int threads, class T>
__device__ T sum_over_block(const T& mine, T* memory) {
  memory[threadIdx.x] = mine;
  for (unsigned half = threads / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) memory[threadIdx.x] = memory[threadIdx.x] + memory[threadIdx.x + half];
  }
  return memory[0];
}

/// Memory for one T of each thread of a block, without a call of T's constructor.
template <class T, int threads>
struct BlockRoom {
  alignas(alignof(T)) unsigned char bytes[threads * sizeof(T)];
  __device__ T* data() { return reinterpret_cast<T*>(bytes); }
};

/// Adds up tiles b, b + blocks, ... in block b; sums[b] is the sum of these.
template <class T, class F>
__global__ void __launch_bounds__(tile, blocks_at_once<F>())
    sum_strided(const __grid_constant__ F f, std::int64_t n, T* sums) {
  __shared__ BlockRoom<T, tile> room;
  T mine{};
  const std::int64_t stride = std::int64_t{gridDim.x} * tile;
  for (std::int64_t i = std::int64_t{blockIdx.x} * tile + threadIdx.x; i < n; i += stride) mine = mine + f(i);
  const T sum = sum_over_block<tile>(mine, room.data());
  if (threadIdx.x == 0) sums[blockIdx.x] = sum;
}

template <class F>
__global__ void __launch_bounds__(tile)
    visit_found_of_tile(const __grid_constant__ F f, const std::int32_t* counts) {
  const auto k = static_cast<std::int32_t>(threadIdx.x);
  if (k < counts[blockIdx.x]) f(std::int64_t{blockIdx.x}, k);
}

template <class F>
void visit_found(Device, const char* label, std::int64_t tiles, const std::int32_t* counts, const F& f) {
  const timing::Call<Device> call(label);
  visit_found_of_tile<<<static_cast<unsigned>(tiles), tile>>>(f, counts);
  scree::detail::require_launched(label);
}
template <class F>
void compact(Device, const char* label, std::int64_t tiles, const F& f, std::int32_t* counts) {
  const timing::Call<Device> call(label);
  const auto blocks = static_cast<unsigned>(tiles);
  if constexpr (has_kinds<F>()) {
    using Counts = KindCounts<F::kinds>;
    Array<std::uint8_t, Device> kinds(tiles * tile);
    Array<std::int32_t, Device> list(tiles * tile);
    Array<Counts, Device> of_kinds(1);
    cudaMemsetAsync(of_kinds.data(), 0, sizeof(Counts));
    note_kinds<<<blocks, tile>>>(f, kinds.data(), of_kinds.data());
    list_kinds<F::kinds><<<blocks, tile>>>(kinds.data(), of_kinds.data(), list.data());
    find_listed<<<blocks, tile>>>(f, list.data(), of_kinds.data(), kinds.data());
    compact_found<<<blocks, tile>>>(f, kinds.data(), counts);
  } else {
    compact_tile<<<blocks, tile>>>(f, counts);
  }
  scree::detail::require_launched(label);
}
template <class T, class F>
void add_up(Device, const char* label, std::int64_t n, const F& f, Array<T, Device>& scratch, T* out) {
  constexpr std::int64_t most_blocks = 1024;  // keeps a GPU busy, and one block adds up so many quickly
  const timing::Call<Device> call(label);
  const std::int64_t blocks = std::clamp<std::int64_t>(tiles_of(n), 1, most_blocks);
  scratch.resize(blocks);
  sum_strided<T><<<static_cast<unsigned>(blocks), tile>>>(f, n, blocks > 1 ? scratch.data() : out);
  if (blocks > 1) sum_strided<T><<<1, tile>>>(Load<T>{scratch.data()}, blocks, out);
  scree::detail::require_launched(label);
}

#endif

}  // namespace detail

/// Calls f.find(item, record) for each item of `tiles` tiles, which returns whether there is a result.
/// Results are stored by f.store(place, item, record), in the order of the items, from the front of their
/// tile on. Where f.is_end(item) is true, there is no result from there to the end of the tile. counts[t]
/// becomes the number of results of tile t. F has a type Record. On Device the call returns before the work
/// is done.
/// If F has a number of `kinds`, then on Device f.kind(item) returns the kind of an item, from 0 on, or -1 if
/// find() would do nothing but return false. find() is then called kind by kind, and not for kind -1.
/// f.store() is in two parts there: f.keep(item, record) stores what was found at an item, and
/// f.place(place, item) that it was.
template <class Space, class F>
void compact_tiles(const char* label, std::int64_t tiles, const F& f, std::int32_t* counts) {
  if (tiles > 0) detail::compact(Space{}, label, tiles, f, counts);
}

/// Calls f(t, k) for 0 <= k < counts[t] (at most `tile`), for each of `tiles` tiles.
template <class Space, class F>
void for_each_found(const char* label, std::int64_t tiles, const std::int32_t* counts, const F& f) {
  if (tiles > 0) detail::visit_found(Space{}, label, tiles, counts, f);
}

/// Sets *out to the sum of f(i) over 0 <= i < n, as T with an operator +; T{} for n = 0. `out` is in the
/// space, so that the host does not wait for the sum. The tree of the additions depends on n and the space
/// alone. f may write the data of its item. `scratch` keeps its storage from call to call.
template <class T, class Space, class F>
void sum_into(const char* label, std::int64_t n, const F& f, Array<T, Space>& scratch, T* out) {
  detail::add_up(Space{}, label, n, f, scratch, out);
}

/// Returns the same sum as sum_into(), on the host. On Device it is faster than sum(), and on Host it is the
/// same.
template <class T, class Space, class F>
T sum_by_tiles(const char* label, std::int64_t n, const F& f) {
  Array<T, Space> scratch, out(1);
  sum_into<T, Space>(label, n, f, scratch, out.data());
  T sum;
  copy_bytes<Host, Space>(&sum, out.data(), sizeof(sum));
  return sum;
}

}  // namespace scree::parallel
