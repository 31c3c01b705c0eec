// From bounds to bricks, on Device: which objects each brick holds. The order within a brick is that of
// chance; the search puts it right.
#pragma once

#include "broadphase/brick_plan.hpp"
#include "core/bodies.hpp"
#include "core/parallel.hpp"

#include <cstdint>

namespace scree {

using detail::Word;

/// Set to zero before each call of find().
struct BrickState {
  Word first_bad;  ///< number of bodies less that of the first one whose box is not proper; 0 if all are
  std::uint32_t giants;     ///< objects wider than a brick
  std::uint32_t chunks;     ///< in use
  std::uint32_t over_full;  ///< whether a brick has more objects than there is room for
  // Of a search.
  std::uint32_t crowded;  ///< whether the objects of a brick have more entries than there is room for
  Word pairs;
  Word tests[detail::test_counters];
};

struct BrickInput {
  const Aabb* bounds;
  const Mobility* mobility;
  std::int64_t count;
};

/// What is common to all ways into the bricks.
struct BrickStore {
  BrickPlan plan;
  BrickState* state;
  std::uint32_t* giants;  ///< bodies
  std::uint32_t* counts;  ///< entries of each brick, with those that found no room
  Entry* entries;         ///< brick_objects for each brick

  /// Puts an entry where the brick has room for it.
  __device__ void add(std::uint32_t brick, const Entry& entry) const {
    const std::uint32_t place = atomicAdd(&counts[brick], 1u);
    if (place < brick_objects) {
      entries[std::size_t{brick} * brick_objects + place] = entry;
    } else {
      state->over_full = 1;
    }
  }
};

/// An object on its way: for each axis the lower number from that of its bucket on (17 bits), and the extent.
struct alignas(16) Parcel {
  std::uint32_t axis[3];
  std::uint32_t tag;

  __device__ LatticeBox box() const {  // from the bucket on
    LatticeBox box;
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = static_cast<std::int32_t>(axis[a] & 0x1ffffu);
      box.hi[a] = box.lo[a] + static_cast<std::int32_t>(axis[a] >> 17);
    }
    return box;
  }
};

struct Located {
  LatticeBox box;
  std::uint32_t tag;
  bool here;  ///< else absent, bad or a giant
};

/// Of a body; absent beyond the last one.
struct Loaded {
  float2 part[3];
  Mobility mobility;

  Loaded() = default;
  __device__ Loaded(const BrickInput& input, std::int64_t i) : mobility(Mobility::absent) {
    const bool here = i < input.count;
    const auto* from = reinterpret_cast<const float2*>(input.bounds + (here ? i : 0));
    for (int k = 0; k < 3; ++k) part[k] = from[k];
    if (here) mobility = input.mobility[i];
  }
  __device__ Aabb box() const {
    return {{part[0].x, part[0].y, part[1].x}, {part[1].y, part[2].x, part[2].y}};
  }
};

__device__ inline Located locate(const Loaded& loaded, const BrickInput& input, const BrickStore& store,
                                 std::int64_t i) {
  Located object{};
  if (i >= input.count) return object;
  const Aabb box = loaded.box();
  if (!is_proper(box)) {
    if (!is_absent(box)) atomicMax(&store.state->first_bad, static_cast<Word>(input.count - i));
    return object;
  }
  object.tag = static_cast<std::uint32_t>(i);
  if (loaded.mobility != Mobility::fixed) object.tag |= not_fixed;
  bool giant = false;
  for (int a = 0; a < 3; ++a) {
    object.box.lo[a] = store.plan.lattice.number_of(box.lo[a], a);
    object.box.hi[a] = store.plan.lattice.number_of(box.hi[a], a);
    giant |= object.box.hi[a] - object.box.lo[a] > brick_points;
  }
  if (giant) store.giants[atomicAdd(&store.state->giants, 1u)] = static_cast<std::uint32_t>(i);
  object.here = !giant;
  return object;
}

/// Calls f(x, y, z) for each brick that a box overlaps.
template <class F>
__device__ void for_each_brick(const LatticeBox& box, const F& f) {
  for (std::int32_t z = box.lo[2] >> brick_bits; z <= box.hi[2] >> brick_bits; ++z)
    for (std::int32_t y = box.lo[1] >> brick_bits; y <= box.hi[1] >> brick_bits; ++y)
      for (std::int32_t x = box.lo[0] >> brick_bits; x <= box.hi[0] >> brick_bits; ++x) f(x, y, z);
}

__device__ inline Entry entry_in_brick(const LatticeBox& box, std::uint32_t tag, std::int32_t x,
                                       std::int32_t y, std::int32_t z) {
  const std::int32_t base[3] = {x << brick_bits, y << brick_bits, z << brick_bits};
  return entry_in(box, base, tag);
}

/// Objects straight to their bricks: where these are so few that most writes meet in the cache.
inline constexpr int direct_threads = 256;
__global__ void __launch_bounds__(direct_threads)
    scatter_directly(const __grid_constant__ BrickInput input, const __grid_constant__ BrickStore store) {
  const std::int64_t i = std::int64_t{blockIdx.x} * direct_threads + threadIdx.x;
  const Located object = locate(Loaded(input, i), input, store, i);
  if (!object.here) return;
  for_each_brick(object.box, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    const std::uint32_t brick = store.plan.lattice.brick(x, y, z);
    store.add(brick, entry_in_brick(object.box, object.tag, x, y, z));
  });
}

/// Giants: a block for each, its threads over the bricks.
__global__ void __launch_bounds__(128)
    scatter_giants(const __grid_constant__ BrickInput input, const __grid_constant__ BrickStore store) {
  const std::uint32_t giants = store.state->giants;
  for (std::uint32_t g = blockIdx.x; g < giants; g += gridDim.x) {
    const std::uint32_t body = store.giants[g];
    const Aabb bounds = input.bounds[body];
    LatticeBox box;
    std::int32_t begin[3];
    std::int64_t size[3];
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = store.plan.lattice.number_of(bounds.lo[a], a);
      box.hi[a] = store.plan.lattice.number_of(bounds.hi[a], a);
      begin[a] = box.lo[a] >> brick_bits;
      size[a] = (box.hi[a] >> brick_bits) - begin[a] + 1;
    }
    const std::uint32_t tag = body | (input.mobility[body] != Mobility::fixed ? not_fixed : 0);
    for (std::int64_t k = threadIdx.x; k < size[0] * size[1] * size[2]; k += blockDim.x) {
      const auto x = begin[0] + static_cast<std::int32_t>(k % size[0]);
      const auto y = begin[1] + static_cast<std::int32_t>(k / size[0] % size[1]);
      const auto z = begin[2] + static_cast<std::int32_t>(k / (size[0] * size[1]));
      const std::uint32_t brick = store.plan.lattice.brick(x, y, z);
      store.add(brick, entry_in_brick(box, tag, x, y, z));
    }
  }
}

// --- in two steps

/// Buckets grow by chunks, which whoever needs the first place of one takes from all that there are.
inline constexpr std::uint32_t chunk_parcels = 2048;
struct BucketStore {
  Parcel* parcels;           ///< chunk_parcels in each chunk
  std::uint32_t* counts;     ///< parcels of each bucket
  std::uint32_t* chunk;      ///< of each bucket its chunks in order, each plus one; 0: not taken yet
  std::uint32_t per_bucket;  ///< chunks that it can have
  std::uint32_t* owner;      ///< of each chunk: its place in `chunk`
};

inline constexpr int scatter_threads = 256;
inline constexpr int scatter_items = 8;  // of a thread
inline constexpr std::uint32_t scatter_tile = scatter_threads * scatter_items;
static_assert(scatter_tile <= chunk_parcels);

/// counts[0..n) become the sums of what stands before them; entered by the block.
template <int threads>
__device__ std::uint32_t scan_in_block(std::uint32_t* counts, int n, std::uint32_t* sums) {
  const int each = (n + threads - 1) / threads;
  const int begin = static_cast<int>(threadIdx.x) * each;
  std::uint32_t sum = 0;
  for (int k = begin; k < min(begin + each, n); ++k) sum += counts[k];
  std::uint32_t in_warp;
  std::uint32_t before = detail::sum_before(sum, in_warp);
  if (threadIdx.x % 32 == 0) sums[threadIdx.x / 32] = in_warp;
  __syncthreads();
  std::uint32_t all = 0;
  for (int w = 0; w < threads / 32; ++w) {
    if (w < static_cast<int>(threadIdx.x / 32)) before += sums[w];
    all += sums[w];
  }
  for (int k = begin; k < min(begin + each, n); ++k) {
    const std::uint32_t count = counts[k];
    counts[k] = before;
    before += count;
  }
  __syncthreads();
  return all;
}

__device__ inline std::uint32_t load_when_set(const std::uint32_t* word) {
  std::uint32_t value;
  do asm volatile("ld.relaxed.gpu.global.u32 %0, [%1];" : "=r"(value) : "l"(word) : "memory");
  while (value == 0);
  return value;
}

__device__ inline void take_chunk(const BrickStore& store, const BucketStore& buckets, std::uint32_t slot) {
  const std::uint32_t chunk = atomicAdd(&store.state->chunks, 1u);
  buckets.owner[chunk] = slot;
  asm volatile("st.relaxed.gpu.global.u32 [%0], %1;" ::"l"(buckets.chunk + slot), "r"(chunk + 1) : "memory");
}

struct BucketRun {
  std::uint32_t begin;     ///< of a bucket's parcels in the stage
  std::uint32_t split;     ///< from here on they go to a second chunk
  std::uint32_t place[2];  ///< in all chunks, less the place in the stage
};

/// Tiles of objects, to buckets: sorted by bucket in shared memory, so that what is written lies together.
__global__ void __launch_bounds__(scatter_threads, 4)
    scatter_to_buckets(const __grid_constant__ BrickInput input, const __grid_constant__ BrickStore store,
                       const __grid_constant__ BucketStore buckets) {
  extern __shared__ uint4 shared[];
  __shared__ std::uint32_t sums[scatter_threads / 32];
  const int count = store.plan.total_buckets();
  auto* stage = reinterpret_cast<Parcel*>(shared);
  auto* run = reinterpret_cast<BucketRun*>(stage + scatter_tile);
  auto* begin = reinterpret_cast<std::uint32_t*>(run + count);
  auto* bucket_of = reinterpret_cast<std::uint16_t*>(begin + count);
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) begin[b] = 0;
  __syncthreads();
  Parcel parcel[scatter_items];
  std::uint32_t rank[scatter_items];  // in its bucket, and 2^16 times the bucket
  constexpr int loads = 4;            // under way at once
  Loaded loaded[loads];
  const std::int64_t first = std::int64_t{blockIdx.x} * scatter_tile + threadIdx.x;
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    if (k % loads == 0) {
#pragma unroll
      for (int l = 0; l < loads; ++l) loaded[l] = Loaded(input, first + (k + l) * scatter_threads);
    }
    const std::int64_t i = first + k * scatter_threads;
    rank[k] = ~0u;
    const Located object = locate(loaded[k % loads], input, store, i);
    if (!object.here) continue;
    std::int32_t at[3];
    for (int a = 0; a < 3; ++a) {
      at[a] = (object.box.lo[a] >> brick_bits) / store.plan.bucket_width;
      const std::int32_t base = at[a] * store.plan.bucket_width << brick_bits;
      parcel[k].axis[a] = static_cast<std::uint32_t>(object.box.lo[a] - base) |
                          static_cast<std::uint32_t>(object.box.hi[a] - object.box.lo[a]) << 17;
    }
    parcel[k].tag = object.tag;
    const auto bucket =
        static_cast<std::uint32_t>((at[2] * store.plan.buckets[1] + at[1]) * store.plan.buckets[0] + at[0]);
    rank[k] = atomicAdd(&begin[bucket], 1u) | bucket << 16;
  }
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) {
    const std::uint32_t n = begin[b];
    if (n == 0) continue;
    // The places in the bucket, and the chunks that these are in.
    const std::uint32_t first = atomicAdd(&buckets.counts[b], n);
    const std::uint32_t slot = static_cast<std::uint32_t>(b) * buckets.per_bucket + first / chunk_parcels;
    const std::uint32_t room = chunk_parcels - first % chunk_parcels;
    if (first % chunk_parcels == 0) take_chunk(store, buckets, slot);
    if (n > room) take_chunk(store, buckets, slot + 1);
    run[b].split = room;
    run[b].place[0] = first % chunk_parcels;
    run[b].place[1] = slot;
  }
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) {
    const std::uint32_t n = begin[b];
    if (n == 0) continue;
    const std::uint32_t slot = run[b].place[1];
    run[b].place[0] += (load_when_set(buckets.chunk + slot) - 1) * chunk_parcels;
    if (n > run[b].split) run[b].place[1] = (load_when_set(buckets.chunk + slot + 1) - 1) * chunk_parcels;
  }
  __syncthreads();
  const std::uint32_t staged = scan_in_block<scatter_threads>(begin, count, sums);
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    if (rank[k] == ~0u) continue;
    const std::uint32_t bucket = rank[k] >> 16;
    const std::uint32_t at = begin[bucket] + (rank[k] & 0xffffu);
    stage[at] = parcel[k];
    bucket_of[at] = static_cast<std::uint16_t>(bucket);
  }
  __syncthreads();
  for (std::uint32_t t = threadIdx.x; t < staged; t += scatter_threads) {
    const std::uint32_t bucket = bucket_of[t];
    const BucketRun& to = run[bucket];
    const std::uint32_t k = t - begin[bucket];
    buckets.parcels[k < to.split ? to.place[0] + k : to.place[1] + (k - to.split)] = stage[t];
  }
}

/// What goes to one brick from a tile.
struct BrickRun {
  std::uint32_t begin;  ///< of its entries in the stage
  std::uint32_t end;    ///< of those that find room in the brick
  std::uint32_t to;     ///< where they go in all entries, less their place in the stage
};

/// The objects of a chunk to the bricks that they overlap, likewise: each to the brick of its lower corner,
/// and its copies to the others from a list, so that no lanes wait for those that have some.
inline constexpr std::uint32_t most_staged = 3072;
inline constexpr int copies_of_thread = 5;
inline constexpr std::uint32_t most_listed = copies_of_thread * scatter_threads;
__global__ void __launch_bounds__(scatter_threads, 3)
    scatter_to_bricks(const __grid_constant__ BrickStore store, const __grid_constant__ BucketStore buckets) {
  extern __shared__ uint4 shared[];
  __shared__ std::uint32_t sums[scatter_threads / 32];
  __shared__ std::uint32_t wide;
  __shared__ std::uint32_t listed;
  __shared__ std::uint16_t wider[chunk_parcels];  // parcels that overlap more than one brick
  __shared__ std::uint32_t list[most_listed];     // parcel in 16 bits, brick along x, y and z in 4 each
  if (blockIdx.x >= store.state->chunks) return;
  const std::int32_t width = store.plan.bucket_width;
  const std::int32_t side = width + 1;  // of the bricks that its objects can overlap
  const int count = side * side * side;
  auto* stage = reinterpret_cast<Entry*>(shared);
  auto* run = reinterpret_cast<BrickRun*>(stage + most_staged);
  auto* begin = reinterpret_cast<std::uint32_t*>(run + count);
  auto* brick_of = reinterpret_cast<std::uint16_t*>(begin + count);
  const std::uint32_t slot = buckets.owner[blockIdx.x];
  const std::uint32_t bucket = slot / buckets.per_bucket;
  const std::uint32_t before = slot % buckets.per_bucket * chunk_parcels;
  const std::uint32_t parcels = min(buckets.counts[bucket] - before, chunk_parcels);
  const Parcel* from = buckets.parcels + std::size_t{blockIdx.x} * chunk_parcels;
  std::int32_t corner[3];  // the bucket's first brick
  corner[0] = static_cast<std::int32_t>(bucket) % store.plan.buckets[0] * width;
  corner[1] = static_cast<std::int32_t>(bucket) / store.plan.buckets[0] % store.plan.buckets[1] * width;
  corner[2] = static_cast<std::int32_t>(bucket) / (store.plan.buckets[0] * store.plan.buckets[1]) * width;
  const auto number_of = [&](std::int32_t k) {
    return store.plan.lattice.brick(corner[0] + k % side, corner[1] + k / side % side,
                                    corner[2] + k / (side * side));
  };
  Parcel parcel[scatter_items];
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    const std::uint32_t t = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (t < parcels) parcel[k] = from[t];
  }
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) begin[b] = 0;
  if (threadIdx.x == 0) wide = listed = 0;
  __syncthreads();
  std::uint32_t rank[scatter_items];  // in its brick, and 2^16 times the brick
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    const std::uint32_t t = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (t >= parcels) continue;
    const LatticeBox box = parcel[k].box();
    std::int32_t at[3];
    std::int32_t further[3];
    for (int a = 0; a < 3; ++a) {
      at[a] = box.lo[a] >> brick_bits;
      further[a] = (box.hi[a] >> brick_bits) - at[a];
    }
    const std::int32_t own = (at[2] * side + at[1]) * side + at[0];
    rank[k] = atomicAdd(&begin[own], 1u) | static_cast<std::uint32_t>(own) << 16;
    if ((further[0] | further[1] | further[2]) != 0)
      wider[atomicAdd(&wide, 1u)] = static_cast<std::uint16_t>(t);
  }
  __syncthreads();
  for (std::uint32_t w = threadIdx.x; w < wide; w += scatter_threads) {
    const std::uint32_t t = wider[w];
    const Parcel sent = from[t];
    const LatticeBox box = sent.box();
    for_each_brick(box, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
      if (x == box.lo[0] >> brick_bits && y == box.lo[1] >> brick_bits && z == box.lo[2] >> brick_bits)
        return;
      const std::uint32_t l = atomicAdd(&listed, 1u);
      if (l < most_listed) {
        list[l] = t | static_cast<std::uint32_t>(x << 16 | y << 20 | z << 24);
      } else {
        store.add(number_of((z * side + y) * side + x), entry_in_brick(box, sent.tag, x, y, z));
      }
    });
  }
  __syncthreads();
  const std::uint32_t in_list = min(listed, most_listed);
  const auto along = [](std::uint32_t item, int a) {
    return static_cast<std::int32_t>(item >> (16 + 4 * a) & 15u);
  };
  const auto listed_brick = [&](std::uint32_t item) {
    return (along(item, 2) * side + along(item, 1)) * side + along(item, 0);
  };
  std::uint32_t copy_rank[copies_of_thread];
#pragma unroll
  for (int k = 0; k < copies_of_thread; ++k) {
    const std::uint32_t l = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (l < in_list) copy_rank[k] = atomicAdd(&begin[listed_brick(list[l])], 1u);
  }
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) {
    const std::uint32_t n = begin[b];
    if (n == 0) continue;
    const std::uint32_t brick = number_of(b);
    const std::uint32_t place = atomicAdd(&store.counts[brick], n);
    run[b].end = place < brick_objects ? min(n, brick_objects - place) : 0;
    if (run[b].end < n) store.state->over_full = 1;
    run[b].to = brick * brick_objects + place;
  }
  const std::uint32_t staged = scan_in_block<scatter_threads>(begin, count, sums);
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) {
    run[b].begin = begin[b];
    run[b].end += begin[b];
    run[b].to -= begin[b];
  }
  __syncthreads();
  const auto send = [&](const Entry& entry, std::uint32_t b, std::uint32_t t) {
    if (t < run[b].end) store.entries[run[b].to + t] = entry;
  };
  const auto put = [&](const Entry& entry, std::uint32_t b, std::uint32_t of_brick) {
    const std::uint32_t t = run[b].begin + of_brick;
    if (t < most_staged) {
      stage[t] = entry;
      brick_of[t] = static_cast<std::uint16_t>(b);
    } else {
      send(entry, b, t);
    }
  };
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    const std::uint32_t t = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (t >= parcels) continue;
    const LatticeBox box = parcel[k].box();
    put(entry_in_brick(box, parcel[k].tag, box.lo[0] >> brick_bits, box.lo[1] >> brick_bits,
                       box.lo[2] >> brick_bits),
        rank[k] >> 16, rank[k] & 0xffffu);
  }
#pragma unroll
  for (int k = 0; k < copies_of_thread; ++k) {
    const std::uint32_t l = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (l >= in_list) continue;
    const std::uint32_t item = list[l];
    const Parcel sent = from[item & 0xffffu];
    put(entry_in_brick(sent.box(), sent.tag, along(item, 0), along(item, 1), along(item, 2)),
        static_cast<std::uint32_t>(listed_brick(item)), copy_rank[k]);
  }
  __syncthreads();
  for (std::uint32_t t = threadIdx.x; t < min(staged, most_staged); t += scatter_threads)
    send(stage[t], brick_of[t], t);
}

}  // namespace scree
