// The kernels that distribute the objects from their bounds to the bricks, on Device. The order within a
// brick is random at first; the search sorts it.
#pragma once

#include "broadphase/brick_plan.hpp"
#include "core/bodies.hpp"
#include "core/space_matches_device.hpp"

#include <cstdint>

namespace scree {

using detail::Word;

/// The state of one call of find(), set to zero before it.
struct BrickState {
  /// Number of bodies minus the number of the first body whose box is not proper; 0 if all boxes are proper.
  Word first_bad;
  std::uint32_t oversize_objects;  ///< objects wider than a brick
  std::uint32_t chunks;            ///< number of chunks in use
  std::uint32_t over_full;         ///< whether a brick has more objects than there is room for
  // The members below are results of a search.
  std::uint32_t crowded;  ///< whether the objects of a brick have more entries than there is room for
  Word pairs;
  Word tests[detail::test_counters];
};

struct BrickInput {
  const Aabb* bounds;
  const Mobility* mobility;
  std::int64_t count;
};

/// The bricks, and the data about them while they are filled and searched.
struct BrickStore {
  BrickPlan plan;
  BrickState* state;
  std::uint32_t* oversize_objects;  ///< bodies that are oversize objects
  std::uint32_t* counts;            ///< number of entries of each brick, including entries without room
  Entry* entries;                   ///< entries; each brick has room for brick_objects

  /// Adds an entry to a brick if there is room for it.
  __device__ void add(std::uint32_t brick, const Entry& entry) const {
    const std::uint32_t place = atomicAdd(&counts[brick], 1u);
    if (place < brick_objects) {
      entries[std::size_t{brick} * brick_objects + place] = entry;
    } else {
      state->over_full = 1;
    }
  }
};

/// An object on its way to its bricks. For each axis, a word holds the lower number relative to the bucket
/// (17 bits) and the extent.
struct alignas(16) StagedRecord {
  std::uint32_t axis[3];
  std::uint32_t tag;

  __device__ LatticeBox box() const {  // relative to the bucket
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
  bool here;  ///< whether the object goes to a bucket: it is not absent, bad or oversize
};

/// The box and mobility of a body as loaded from memory; absent beyond the last body.
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
  object.box = store.plan.lattice.numbers_of(box);
  bool oversize_object = false;
  for (int a = 0; a < 3; ++a) oversize_object |= object.box.hi[a] - object.box.lo[a] > brick_points;
  if (oversize_object)
    store.oversize_objects[atomicAdd(&store.state->oversize_objects, 1u)] = static_cast<std::uint32_t>(i);
  object.here = !oversize_object;
  return object;
}

__device__ inline Entry entry_in_brick(const LatticeBox& box, std::uint32_t tag, std::int32_t x,
                                       std::int32_t y, std::int32_t z) {
  const std::int32_t base[3] = {x << brick_bits, y << brick_bits, z << brick_bits};
  return entry_in(box, base, tag);
}

/// Calls f(x, y, z) for each brick that a box overlaps.
template <class F>
__device__ void for_each_brick(const LatticeBox& box, const F& f) {
  for (std::int32_t z = box.lo[2] >> brick_bits; z <= box.hi[2] >> brick_bits; ++z)
    for (std::int32_t y = box.lo[1] >> brick_bits; y <= box.hi[1] >> brick_bits; ++y)
      for (std::int32_t x = box.lo[0] >> brick_bits; x <= box.hi[0] >> brick_bits; ++x) f(x, y, z);
}

/// Number of blocks that distribute oversize objects.
inline constexpr unsigned oversize_blocks = 64;
/// Distributes oversize objects to their bricks. It is called by `blocks` blocks, of which this one is number
/// `block`. If there are fewer objects than blocks, several blocks share an object.
__device__ inline void scatter_oversize_objects(const BrickInput& input, const BrickStore& store,
                                                unsigned block, unsigned blocks) {
  const std::uint32_t oversize_objects = store.state->oversize_objects;
  if (oversize_objects == 0) return;
  const std::uint32_t shares = max(blocks / oversize_objects, 1u);
  for (std::uint32_t item = block; item < oversize_objects * shares; item += blocks) {
    const std::uint32_t body = store.oversize_objects[item % oversize_objects];
    const std::uint32_t share = item / oversize_objects;
    const LatticeBox box = store.plan.lattice.numbers_of(input.bounds[body]);
    const std::uint32_t tag = body | (input.mobility[body] != Mobility::fixed ? not_fixed : 0);
    std::int32_t first[3];
    std::uint32_t size[3];
    for (int a = 0; a < 3; ++a) {
      first[a] = box.lo[a] >> brick_bits;
      size[a] = static_cast<std::uint32_t>((box.hi[a] >> brick_bits) - first[a] + 1);
    }
    for (std::uint32_t k = share * blockDim.x + threadIdx.x; k < size[0] * size[1] * size[2];
         k += shares * blockDim.x) {
      const auto x = first[0] + static_cast<std::int32_t>(k % size[0]);
      const auto y = first[1] + static_cast<std::int32_t>(k / size[0] % size[1]);
      const auto z = first[2] + static_cast<std::int32_t>(k / (size[0] * size[1]));
      store.add(store.plan.lattice.brick(x, y, z), entry_in_brick(box, tag, x, y, z));
    }
  }
}

/// Number of records in a chunk. Buckets grow by chunks: the thread that gets the first place of a new chunk
/// takes it from the common store of chunks.
inline constexpr std::uint32_t chunk_records = 2048;
struct BucketStore {
  StagedRecord* records;     ///< records; each chunk has room for chunk_records
  std::uint32_t* counts;     ///< number of records of each bucket
  std::uint32_t* chunk;      ///< chunks of each bucket in order, each number plus one; 0: not taken yet
  std::uint32_t per_bucket;  ///< largest number of chunks of a bucket
  std::uint32_t* owner;      ///< for each chunk, its index in `chunk`
};

inline constexpr int scatter_threads = 256;
inline constexpr int scatter_items = 8;  // items of a thread
inline constexpr int loads_at_once = 4;  // items that a thread loads at once
inline constexpr std::uint32_t scatter_tile = scatter_threads * scatter_items;
static_assert(scatter_tile <= chunk_records);

/// Replaces counts[0..n) by the sums of the counts before each, and returns the total. The whole block calls
/// it.
template <int threads>
__device__ std::uint32_t scan_in_block(std::uint32_t* counts, int n, std::uint32_t* sums) {
  const int each = (n + threads - 1) / threads;
  const int begin = static_cast<int>(threadIdx.x) * each;
  std::uint32_t sum = 0;
  for (int k = begin; k < min(begin + each, n); ++k) sum += counts[k];
  std::uint32_t all;
  std::uint32_t before = detail::sum_before_in_block<threads>(sum, sums, all);
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

/// The records that go from one tile to one bucket.
struct BucketRun {
  std::uint32_t split;     ///< number of records that go to the first chunk; the others go to a second one
  std::uint32_t place[2];  ///< index, among all records, of the first one in each chunk
};

/// Finds, for the `begin[b]` records of the block that go to bucket b, their places in the bucket, and takes
/// the chunks whose first places are among them. All threads of the block call it.
__device__ __forceinline__ void reserve_in_buckets(const BrickStore& store, const BucketStore& buckets,
                                                   const std::uint32_t* begin, int count, BucketRun* run) {
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) {
    const std::uint32_t n = begin[b];
    if (n == 0) continue;
    const std::uint32_t first = atomicAdd(&buckets.counts[b], n);
    const std::uint32_t slot = static_cast<std::uint32_t>(b) * buckets.per_bucket + first / chunk_records;
    const std::uint32_t room = chunk_records - first % chunk_records;
    if (first % chunk_records == 0) take_chunk(store, buckets, slot);
    if (n > room) take_chunk(store, buckets, slot + 1);
    run[b].split = room;
    run[b].place[0] = first % chunk_records;
    run[b].place[1] = slot;
  }
  __syncthreads();
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) {
    const std::uint32_t n = begin[b];
    if (n == 0) continue;
    const std::uint32_t slot = run[b].place[1];
    run[b].place[0] += (load_when_set(buckets.chunk + slot) - 1) * chunk_records;
    if (n > run[b].split) run[b].place[1] = (load_when_set(buckets.chunk + slot + 1) - 1) * chunk_records;
  }
  __syncthreads();
}

/// Distributes the objects of a tile to buckets. The records are sorted by bucket in shared memory, so that
/// writes are contiguous.
__global__ void __launch_bounds__(scatter_threads, 4)
    scatter_to_buckets(const __grid_constant__ BrickInput input, const __grid_constant__ BrickStore store,
                       const __grid_constant__ BucketStore buckets) {
  extern __shared__ uint4 shared[];
  __shared__ std::uint32_t sums[scatter_threads / 32];
  const int count = store.plan.total_buckets();
  auto* stage = reinterpret_cast<StagedRecord*>(shared);
  auto* run = reinterpret_cast<BucketRun*>(stage + scatter_tile);
  auto* begin = reinterpret_cast<std::uint32_t*>(run + count);
  auto* bucket_of = reinterpret_cast<std::uint16_t*>(begin + count);
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) begin[b] = 0;
  __syncthreads();
  StagedRecord record[scatter_items];
  std::uint32_t rank[scatter_items];  // rank in its bucket, plus 2^16 times the bucket
  Loaded loaded[loads_at_once];
  const std::int64_t first = std::int64_t{blockIdx.x} * scatter_tile + threadIdx.x;
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    if (k % loads_at_once == 0) {
#pragma unroll
      for (int l = 0; l < loads_at_once; ++l) loaded[l] = Loaded(input, first + (k + l) * scatter_threads);
    }
    const std::int64_t i = first + k * scatter_threads;
    rank[k] = ~0u;
    const Located object = locate(loaded[k % loads_at_once], input, store, i);
    if (!object.here) continue;
    std::int32_t at[3];
    for (int a = 0; a < 3; ++a) {
      at[a] = (object.box.lo[a] >> brick_bits) / store.plan.bucket_width;
      const std::int32_t base = at[a] * store.plan.bucket_width << brick_bits;
      record[k].axis[a] = static_cast<std::uint32_t>(object.box.lo[a] - base) |
                          static_cast<std::uint32_t>(object.box.hi[a] - object.box.lo[a]) << 17;
    }
    record[k].tag = object.tag;
    const auto bucket =
        static_cast<std::uint32_t>((at[2] * store.plan.buckets[1] + at[1]) * store.plan.buckets[0] + at[0]);
    rank[k] = atomicAdd(&begin[bucket], 1u) | bucket << 16;
  }
  __syncthreads();
  reserve_in_buckets(store, buckets, begin, count, run);
  const std::uint32_t staged = scan_in_block<scatter_threads>(begin, count, sums);
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    if (rank[k] == ~0u) continue;
    const std::uint32_t bucket = rank[k] >> 16;
    const std::uint32_t at = begin[bucket] + (rank[k] & 0xffffu);
    stage[at] = record[k];
    bucket_of[at] = static_cast<std::uint16_t>(bucket);
  }
  __syncthreads();
  for (std::uint32_t t = threadIdx.x; t < staged; t += scatter_threads) {
    const std::uint32_t bucket = bucket_of[t];
    const BucketRun& to = run[bucket];
    const std::uint32_t k = t - begin[bucket];
    buckets.records[k < to.split ? to.place[0] + k : to.place[1] + (k - to.split)] = stage[t];
  }
}

/// The entries that go from one chunk to one brick.
struct BrickRun {
  std::uint32_t end;  ///< end of the entries with room in the brick, in the order of the chunk
  std::uint32_t to;   ///< their index among all entries, minus their index in the order
};

/// The bricks that the objects of a bucket can overlap: the bricks in the bucket, and one more on each axis.
struct BucketBricks {
  std::int32_t side;
  std::int32_t corner[3];
  std::uint32_t inverse;  ///< factor for which k * inverse / 2^16 is k / side

  __device__ BucketBricks(const BrickPlan& plan, std::uint32_t bucket)
      : side(plan.bucket_width + 1), inverse(65536u / static_cast<std::uint32_t>(side) + 1) {
    const auto number = static_cast<std::int32_t>(bucket);
    corner[0] = number % plan.buckets[0] * plan.bucket_width;
    corner[1] = number / plan.buckets[0] % plan.buckets[1] * plan.bucket_width;
    corner[2] = number / (plan.buckets[0] * plan.buckets[1]) * plan.bucket_width;
  }
  __device__ std::uint32_t local(std::int32_t x, std::int32_t y, std::int32_t z) const {
    return static_cast<std::uint32_t>((z * side + y) * side + x);
  }
  /// Finds the position of local brick k.
  __device__ void locate(std::uint32_t k, std::int32_t (&at)[3]) const {
    const auto wide = static_cast<std::uint32_t>(side);
    const std::uint32_t row = k * inverse >> 16;
    const std::uint32_t layer = row * inverse >> 16;
    at[0] = static_cast<std::int32_t>(k - row * wide);
    at[1] = static_cast<std::int32_t>(row - layer * wide);
    at[2] = static_cast<std::int32_t>(layer);
  }
  __device__ std::uint32_t brick(const BrickLattice& lattice, std::uint32_t k) const {
    std::int32_t at[3];
    locate(k, at);
    return lattice.brick(corner[0] + at[0], corner[1] + at[1], corner[2] + at[2]);
  }
};

/// Capacities: listed copies of a thread, listed copies of a block, and entries that a block puts in order.
inline constexpr int copies_of_thread = 5;
inline constexpr std::uint32_t most_listed = copies_of_thread * scatter_threads;
inline constexpr std::uint32_t most_ordered = chunk_records + most_listed;

/// Lists the copies of record t, which go to all bricks that it overlaps but that of its lower corner. What
/// the list has no room for goes to its brick at once.
__device__ __forceinline__ void list_copies(const BrickStore& store, const BucketBricks& bricks,
                                            std::uint32_t t, const StagedRecord sent, std::uint32_t* list,
                                            std::uint32_t& listed) {
  const LatticeBox box = sent.box();
  for_each_brick(box, [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    if (x == box.lo[0] >> brick_bits && y == box.lo[1] >> brick_bits && z == box.lo[2] >> brick_bits) return;
    const std::uint32_t local = bricks.local(x, y, z);
    const std::uint32_t l = atomicAdd(&listed, 1u);
    if (l < most_listed) {
      list[l] = t | local << 16;
    } else {
      store.add(bricks.brick(store.plan.lattice, local), entry_in_brick(box, sent.tag, x, y, z));
    }
  });
}

/// Finds the places of the `begin[b]` entries of the block that go to local brick b, and makes begin[b] the
/// index of the first of them in the order of the chunk. Returns the number of all entries. All threads of
/// the block call it.
__device__ __forceinline__ std::uint32_t reserve_in_bricks(const BrickStore& store,
                                                           const BucketBricks& bricks, std::uint32_t* begin,
                                                           int count, BrickRun* run, std::uint32_t* sums) {
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) {
    const std::uint32_t n = begin[b];
    if (n == 0) continue;
    const std::uint32_t brick = bricks.brick(store.plan.lattice, static_cast<std::uint32_t>(b));
    const std::uint32_t place = atomicAdd(&store.counts[brick], n);
    run[b].end = place < brick_objects ? min(n, brick_objects - place) : 0;
    if (run[b].end < n) store.state->over_full = 1;
    run[b].to = brick * brick_objects + place;
  }
  const std::uint32_t entries = scan_in_block<scatter_threads>(begin, count, sums);
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) {
    run[b].end += begin[b];
    run[b].to -= begin[b];
  }
  return entries;
}

/// Distributes the objects of a chunk to the bricks that they overlap. Each object goes to the brick of its
/// lower corner; its copies go to the other bricks by way of a list, so that no lanes wait for those whose
/// objects have copies. The entries are put in order before they are written, so that writes to a brick are
/// contiguous. Blocks beyond the chunks distribute the oversize objects.
__global__ void __launch_bounds__(scatter_threads, 5)
    scatter_to_bricks(const __grid_constant__ BrickInput input, const __grid_constant__ BrickStore store,
                      const __grid_constant__ BucketStore buckets) {
  extern __shared__ uint4 shared[];
  __shared__ std::uint32_t sums[scatter_threads / 32];
  __shared__ std::uint32_t wide;
  __shared__ std::uint32_t listed;
  __shared__ std::uint16_t wider[chunk_records];  // records that overlap more than one brick
  __shared__ std::uint32_t list[most_listed];     // record, plus 2^16 times the local brick
  __shared__ std::uint32_t order[most_ordered];   // entries in order, encoded as in `list`
  const std::uint32_t chunks = store.state->chunks;
  if (blockIdx.x >= chunks) {
    scatter_oversize_objects(input, store, blockIdx.x - chunks, gridDim.x - chunks);
    return;
  }
  const std::uint32_t slot = buckets.owner[blockIdx.x];
  const std::uint32_t bucket = slot / buckets.per_bucket;
  const std::uint32_t before = slot % buckets.per_bucket * chunk_records;
  const std::uint32_t records = min(buckets.counts[bucket] - before, chunk_records);
  const StagedRecord* from = buckets.records + std::size_t{blockIdx.x} * chunk_records;
  const BucketBricks bricks(store.plan, bucket);
  const int count = bricks.side * bricks.side * bricks.side;
  auto* run = reinterpret_cast<BrickRun*>(shared);
  auto* begin = reinterpret_cast<std::uint32_t*>(run + count);
  for (int b = static_cast<int>(threadIdx.x); b < count; b += scatter_threads) begin[b] = 0;
  if (threadIdx.x == 0) wide = listed = 0;
  __syncthreads();
  std::uint32_t rank[scatter_items];  // rank in its brick, plus 2^16 times the brick
  StagedRecord loaded[loads_at_once];
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    const std::uint32_t t = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (k % loads_at_once == 0) {
#pragma unroll
      for (std::uint32_t l = 0; l < loads_at_once; ++l)
        loaded[l] = from[min(t + l * scatter_threads, records - 1)];
    }
    if (t >= records) continue;
    const LatticeBox box = loaded[k % loads_at_once].box();
    std::int32_t at[3];
    std::int32_t further[3];
    for (int a = 0; a < 3; ++a) {
      at[a] = box.lo[a] >> brick_bits;
      further[a] = (box.hi[a] >> brick_bits) - at[a];
    }
    const std::uint32_t own = bricks.local(at[0], at[1], at[2]);
    rank[k] = atomicAdd(&begin[own], 1u) | own << 16;
    if ((further[0] | further[1] | further[2]) != 0)
      wider[atomicAdd(&wide, 1u)] = static_cast<std::uint16_t>(t);
  }
  __syncthreads();
  for (std::uint32_t w = threadIdx.x; w < wide; w += scatter_threads) {
    const std::uint32_t t = wider[w];
    list_copies(store, bricks, t, from[t], list, listed);
  }
  __syncthreads();
  const std::uint32_t in_list = min(listed, most_listed);
  std::uint32_t copy_rank[copies_of_thread];
#pragma unroll
  for (int k = 0; k < copies_of_thread; ++k) {
    const std::uint32_t l = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (l < in_list) copy_rank[k] = atomicAdd(&begin[list[l] >> 16], 1u);
  }
  __syncthreads();
  const std::uint32_t entries = reserve_in_bricks(store, bricks, begin, count, run, sums);
#pragma unroll
  for (int k = 0; k < scatter_items; ++k) {
    const std::uint32_t t = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (t < records) order[begin[rank[k] >> 16] + (rank[k] & 0xffffu)] = t | (rank[k] & 0xffff0000u);
  }
#pragma unroll
  for (int k = 0; k < copies_of_thread; ++k) {
    const std::uint32_t l = static_cast<unsigned>(k) * scatter_threads + threadIdx.x;
    if (l < in_list) order[begin[list[l] >> 16] + copy_rank[k]] = list[l];
  }
  __syncthreads();
  for (std::uint32_t k = threadIdx.x; k < entries; k += scatter_threads) {
    const std::uint32_t local = order[k] >> 16;
    if (k >= run[local].end) continue;
    const StagedRecord sent = from[order[k] & 0xffffu];
    std::int32_t at[3];
    bricks.locate(local, at);
    store.entries[run[local].to + k] = entry_in_brick(sent.box(), sent.tag, at[0], at[1], at[2]);
  }
}

}  // namespace scree
