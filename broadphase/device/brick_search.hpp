// The search for the pairs of each brick, on Device: a block of threads sorts the brick's entries in shared
// memory, distributes the tests over all lanes, and writes the pairs behind those of the bricks before it.
#pragma once

#include "broadphase/device/brick_sort.hpp"

namespace scree {

struct SearchOutput {
  const Aabb* bounds;
  Pair* pairs;
  Word room;
  Word* tiles;
};

/// Removes from the hits the pairs whose numbers leave the answer open (`ask`) and whose boxes do not
/// overlap. The whole warp calls it.
template <int n>
__device__ void ask_bounds(const SearchOutput& out, const bool (&ask)[n], const Entry (&a)[n],
                           const Entry (&b)[n], unsigned (&hits)[n]) {
  bool any = false;
  for (int h = 0; h < n; ++h) any |= ask[h];
  if (!__any_sync(detail::all_lanes, any)) return;
#pragma unroll
  for (int h = 0; h < n; ++h) {
    const bool apart = ask[h] && !overlap(out.bounds[a[h].body()], out.bounds[b[h].body()]);
    hits[h] &= ~__ballot_sync(detail::all_lanes, apart);
  }
}

inline constexpr std::uint32_t window = 32 * 32;  ///< tests that are marked at once

/// Sets the bits of the tests with which the runs of a lane start, within a window of tests; `from`: the
/// first test of the lane, from the start of the window on (negative: before the window). The last lane also
/// marks the end, so that the remaining tests of the last words belong to no entry.
template <int runs>
__device__ __forceinline__ void mark_starts(const SlotRun (&run)[runs], const std::uint32_t (&used)[runs],
                                            std::int32_t from, unsigned lane, SearchStage<runs>& stage) {
  const std::int32_t first = from;
  const std::int32_t word = from >> 5;
  std::uint32_t bits[2] = {};  // bits of this word and the next one; runs hardly ever start further on
  bool far = false;
#pragma unroll
  for (int r = 0; r <= runs; ++r) {
    const std::uint32_t starts = r < runs ? used[r] : lane == 31 ? 1u : 0u;
    const auto bit = static_cast<std::uint32_t>(from - 32 * word);
    bits[0] |= __funnelshift_lc(0, starts, bit);
    bits[1] |= __funnelshift_lc(0, starts, bit - 32);
    far |= starts && bit >= 64;
    if (r < runs) from += static_cast<std::int32_t>(run[r].length);
  }
  if (bits[0] && word >= 0 && word < 32) atomicOr(&stage.starts[word], bits[0]);
  if (bits[1] && word >= -1 && word < 31) atomicOr(&stage.starts[word + 1], bits[1]);
  if (!far) return;
  from = first;
  for (int r = 0; r <= runs; ++r) {
    const bool starts = r < runs ? used[r] > 0 : lane == 31;
    if (starts && from - 32 * word >= 64 && from >= 0 && from < static_cast<std::int32_t>(window))
      atomicOr(&stage.starts[from / 32], 1u << (from % 32));
    if (r < runs) from += static_cast<std::int32_t>(run[r].length);
  }
}

/// Makes the tests of 32 entries, without those from `end` on. The tests are distributed over the lanes of a
/// warp in the order of entries, runs and candidates. Calls sink(hits, pair) with the whole warp: `hits` has
/// a bit for each lane, and `pair` holds the slots of the lane's pair in bytes of entries. Returns the number
/// of tests.
template <BrickMethod method, class Sink>
__device__ std::uint32_t search_entries(const BrickSearch<method>& search, const SearchOutput& out,
                                        SearchMemory<method>& memory, std::uint32_t first, std::uint32_t end,
                                        Sink& sink) {
  constexpr int runs = BrickSearch<method>::runs;
  const unsigned lane = threadIdx.x % 32;
  SearchStage<runs>& stage = memory.stage[threadIdx.x / 32];
  const std::uint32_t slot = first + lane;
  stage.starts[lane] = 0;
  SlotRun run[runs] = {};
  if (slot < end) {
    const Entry entry = memory.entry[slot];
    stage.turned[lane] = facing(entry);
    search.find_runs(entry, slot, memory, run);
  }
  // Two sums are made in one word: there are at most 160 runs, and 32 times most_entries tests.
  std::uint32_t used[runs];
  std::uint32_t length = 0;
#pragma unroll
  for (int r = 0; r < runs; ++r) {
    used[r] = min(run[r].length, 1u);
    length += run[r].length << 8 | used[r];
  }
  std::uint32_t totals;
  const std::uint32_t sums = detail::sum_before(length, totals);
  const std::uint32_t tests = totals >> 8;
  const std::uint32_t first_test = sums >> 8;
  __syncwarp();
  std::uint32_t number = sums & 0xffu;
  std::uint32_t at = first_test;
#pragma unroll
  for (int r = 0; r < runs; ++r) {
    if (used[r]) stage.run[number] = ((run[r].begin - at) * 16 & 0xffffu) | slot << 20;
    number += used[r];
    at += run[r].length;
  }
  if (lane == 31) stage.run[number] = ((0u - tests * 16) & 0xffffu) | (first + 32) << 20;
  mark_starts(run, used, static_cast<std::int32_t>(first_test), lane, stage);
  const std::uint32_t up_to_lane = held((2u << lane) - 1);
  const std::uint32_t turned_from = held(shared_address(stage.turned) - first * 16);
  const std::uint32_t entries_from = held(shared_address(memory.entry));
  std::uint32_t started = 0;  // number of runs that start before the word
  for (std::uint32_t done = 0; done < tests; done += window) {
    if (done > 0) {
      stage.starts[lane] = 0;
      __syncwarp();
      mark_starts(run, used, static_cast<std::int32_t>(first_test - done), lane, stage);
    }
    __syncwarp();
    const std::uint32_t words = held((min(tests - done, window) + 31) / 32);
    std::uint32_t test = (done + lane) * 16;  // its number, in bytes of entries
    for (std::uint32_t word = 0; word < words; word += 2) {
      const uint2 starts = *reinterpret_cast<const uint2*>(stage.starts + word);
      const std::uint32_t in_first = started + static_cast<std::uint32_t>(__popc(starts.x));
      const std::uint32_t of[2] = {
          stage.run[started + static_cast<std::uint32_t>(__popc(starts.x & up_to_lane)) - 1],
          stage.run[in_first + static_cast<std::uint32_t>(__popc(starts.y & up_to_lane)) - 1]};
      started = in_first + static_cast<std::uint32_t>(__popc(starts.y));
      std::uint32_t pair[2];
      unsigned hits[2];
      bool ask[2];
      Entry a[2], b[2];
#pragma unroll
      for (int h = 0; h < 2; ++h) {
        const std::uint32_t candidate = (test + of[h]) & 0xffffu;
        test += 32 * 16;
        pair[h] = __byte_perm(candidate, of[h], 0x1076);
        a[h] = *shared_at<Entry>(turned_from + (of[h] >> 16));
        b[h] = *shared_at<Entry>(entries_from + candidate);
      }
      __syncwarp();  // puts all loads under way before the first result is needed
#pragma unroll
      for (int h = 0; h < 2; ++h) {
        const bool near = may_meet(a[h], b[h]);
        ask[h] = near && !meets_clearly(a[h], b[h]);
        hits[h] = __ballot_sync(detail::all_lanes, near);
      }
      ask_bounds(out, ask, a, b, hits);
      sink(hits[0], pair[0]);
      sink(hits[1], pair[1]);
    }
    __syncwarp();
  }
  return tests;
}

/// Tests 32 entries against the wide entries after them, one entry in each lane. It calls sink() and returns
/// the number of tests as search_entries() does.
template <BrickMethod method, class Sink>
__device__ std::uint32_t search_wide(const SearchOutput& out, const SearchMemory<method>& memory,
                                     std::uint32_t first, std::uint32_t first_wide, std::uint32_t entries,
                                     Sink& sink) {
  const std::uint32_t slot = first + threadIdx.x % 32;
  const Entry own[1] = {memory.entry[min(slot, entries - 1)]};
  std::uint32_t tests = 0;
  for (std::uint32_t w = max(first_wide, first + 1); w < entries; ++w) {
    const Entry wide[1] = {facing(memory.entry[w])};
    const bool near = slot < w && may_meet(wide[0], own[0]);
    const bool ask[1] = {near && !meets_clearly(wide[0], own[0])};
    unsigned hits[1] = {__ballot_sync(detail::all_lanes, near)};
    ask_bounds(out, ask, wide, own, hits);
    sink(hits[0], w * 16 << 16 | slot * 16);
    tests += min(w - first, 32u);
  }
  return tests;
}

/// Makes all tests of a batch of 32 entries.
template <BrickMethod method, class Sink>
__device__ std::uint32_t search_batch(const BrickSearch<method>& search, const SearchOutput& out,
                                      SearchMemory<method>& memory, std::uint32_t batch,
                                      std::uint32_t entries, Sink& sink) {
  const std::uint32_t first_wide = search.first_wide(memory, entries);
  std::uint32_t tests = 0;
  if (32 * batch < first_wide) tests = search_entries(search, out, memory, 32 * batch, first_wide, sink);
  if (first_wide < entries) tests += search_wide(out, memory, 32 * batch, first_wide, entries, sink);
  return tests;
}

/// A sink that keeps the slots of pairs in shared memory, as long as there is room.
template <std::uint32_t room>
struct KeepPairs {
  std::uint32_t kept;  ///< address in shared memory
  unsigned lane_bit;
  std::uint32_t count = 0;

  __device__ void operator()(unsigned hits, std::uint32_t pair) {
    const std::uint32_t at = count + static_cast<std::uint32_t>(__popc(hits & (lane_bit - 1)));
    if ((hits & lane_bit) != 0 && at < room) *shared_at<std::uint32_t>(kept + 4 * at) = pair;
    count += static_cast<std::uint32_t>(__popc(hits));
  }
};

__device__ inline std::int32_t body_at(const Entry* entry, std::uint32_t byte) {
  return static_cast<std::int32_t>(
      reinterpret_cast<const Entry*>(reinterpret_cast<const char*>(entry) + byte)->body());
}
__device__ inline Pair pair_at(const Entry* entry, std::uint32_t pair) {
  return pair_of(body_at(entry, pair & 0xffffu), body_at(entry, pair >> 16));
}

/// A sink that writes the pairs, as long as there is room.
struct WritePairs {
  const Entry* entry;
  Pair* to;
  Word room;
  Word count = 0;

  __device__ void operator()(unsigned hits, std::uint32_t pair) {
    const unsigned lane_bit = 1u << threadIdx.x % 32;
    const Word at = count + static_cast<Word>(__popc(hits & (lane_bit - 1)));
    if ((hits & lane_bit) != 0 && at < room) to[at] = pair_at(entry, pair);
    count += static_cast<Word>(__popc(hits));
  }
};

template <BrickMethod method>
__global__ void __launch_bounds__(search_threads, 4)
    search_bricks(const __grid_constant__ BrickStore store, const __grid_constant__ SearchOutput out) {
  auto& memory = *static_cast<SearchMemory<method>*>(shared_memory());
  const BrickSearch<method> search{store.plan};
  const unsigned warp = threadIdx.x / 32;
  const unsigned lane = threadIdx.x % 32;
  // Blocks start in the order of their numbers, so that the blocks that this one waits for have started.
  const std::uint32_t brick = blockIdx.x;
  if (store.state->over_full) return;
  const std::uint32_t objects = store.counts[brick];
  std::uint32_t entries = 0;
  // Tests are made two words at a time. The tests left over in the last two words are made between the first
  // entries, which exist however few objects there are, and turned[32], which no entry with numbers of 15
  // bits meets.
  constexpr std::uint32_t in_two_words = 64;
  static_assert(memory.entries >= in_two_words && search_threads >= in_two_words);
  if (threadIdx.x < in_two_words) memory.entry[threadIdx.x] = {};
  if (objects > 0) entries = search.sort(store.entries + std::size_t{brick} * brick_objects, objects, memory);
  if (entries > memory.entries) {
    store.state->crowded = 1;
    entries = 0;
  }
  if (lane == 0) memory.stage[warp].turned[32].axis[0] = apart_bits;
  // Each warp has the same number of batches of 32 entries, give or take one, in order.
  const std::uint32_t batches = (entries + 31) / 32;
  const std::uint32_t begin = batches * warp / search_warps;
  const std::uint32_t end = batches * (warp + 1) / search_warps;
  KeepPairs<memory.kept_pairs> keep{held(shared_address(memory.kept[warp])), 1u << lane};
  std::uint32_t tests = 0;
  for (std::uint32_t batch = begin; batch < end; ++batch)
    tests += search_batch(search, out, memory, batch, entries, keep);
  if (lane == 0) {
    memory.found[warp] = keep.count;
    if (tests > 0) atomicAdd(&store.state->tests[brick % detail::test_counters], static_cast<Word>(tests));
  }
  __syncthreads();
  if (warp == 0) {
    Word in_brick = 0;
    for (int w = 0; w < search_warps; ++w) in_brick += memory.found[w];
    const Word before = detail::found_before(out.tiles, brick, in_brick);
    if (lane == 0) {
      memory.place = before;
      if (brick + 1 == gridDim.x) store.state->pairs = before + in_brick;
    }
  }
  __syncthreads();
  Word at = memory.place;
  for (unsigned w = 0; w < warp; ++w) at += memory.found[w];
  const Word room = out.room > at ? out.room - at : 0;
  if (keep.count <= memory.kept_pairs) {
    for (std::uint32_t k = lane; k < keep.count && k < room; k += 32)
      out.pairs[at + k] = pair_at(memory.entry, memory.kept[warp][k]);
  } else if (room > 0) {
    WritePairs write{memory.entry, out.pairs + at, room};
    for (std::uint32_t batch = begin; batch < end; ++batch)
      search_batch(search, out, memory, batch, entries, write);
  }
}

}  // namespace scree
