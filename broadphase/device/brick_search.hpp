// The pairs of each brick, on Device: a block of threads sorts the brick's entries by cell and body in its
// own memory, deals the tests to all lanes and writes what it finds where the bricks before it end.
#pragma once

#include "broadphase/device/brick_scatter.hpp"

namespace scree {

inline constexpr int search_threads = 256;
inline constexpr int search_warps = search_threads / 32;

/// What a warp needs while it searches.
template <int runs>
struct SearchStage {
  Entry turned[33];  ///< the last one meets nothing
  /// Candidates less tests, modulo 2^16, and 2^16 times the slot of the object, both in bytes of entries.
  std::uint32_t run[32 * runs + 1];
  alignas(8) std::uint32_t starts[32];  ///< a bit for each test: a run starts
};

/// Candidates from `begin` on.
struct SlotRun {
  std::uint32_t begin = 0;
  std::uint32_t length = 0;
};

struct SearchOutput {
  const Aabb* bounds;
  Pair* pairs;
  Word room;
  Word* tiles;
};

template <BrickMethod method>
struct BrickSearch;

template <BrickMethod method>
struct SearchMemory {
  static constexpr std::uint32_t entries = most_entries(method);
  static constexpr std::uint32_t kept_pairs = method == BrickMethod::stencil ? 576 : 288;  // of a warp

  Entry entry[entries];
  std::uint16_t
      key[method == BrickMethod::rows ? entries : 2];  ///< cell of each, where it does not show that
  std::uint16_t
      begin[(most_cells(method) + 3) / 2 * 2];  ///< first slot of each cell, and of what follows the last
  SearchStage<BrickSearch<method>::runs> stage[search_warps];
  std::uint32_t kept[search_warps]
                    [kept_pairs];  ///< slots of pairs in bytes of entries, until their place is known
  std::uint32_t sums[search_warps];
  std::uint32_t found[search_warps];
  Word place;
};

/// Keeps a value in a register, where the compiler would rather work it out again at each use.
__device__ inline std::uint32_t held(std::uint32_t value) {
  asm volatile("" : "+r"(value));
  return value;
}
__device__ inline std::uint32_t shared_address(const void* at) {
  return static_cast<std::uint32_t>(__cvta_generic_to_shared(at));
}
template <class T>
__device__ T* shared_at(std::uint32_t address) {
  return static_cast<T*>(__cvta_shared_to_generic(address));
}

/// The memory that the block was started with.
__device__ inline void* shared_memory() {
  extern __shared__ uint4 shared[];
  return shared_at<void>(held(shared_address(shared)));
}

/// Adds one to a half of a word; returns what it was.
__device__ inline std::uint32_t count_up(std::uint16_t* counts, std::uint32_t k) {
  const std::uint32_t shift = k % 2 * 16;
  return atomicAdd(reinterpret_cast<std::uint32_t*>(counts) + k / 2, 1u << shift) >> shift & 0xffffu;
}

/// counts[0..n) become the sums of what stands before them; entered by the block. n is rounded up to even.
__device__ inline std::uint32_t scan_halves(std::uint16_t* counts, int n, std::uint32_t* sums) {
  auto* words = reinterpret_cast<std::uint32_t*>(counts);
  const int total = (n + 1) / 2;
  const int each = (total + search_threads - 1) / search_threads;
  const int first = static_cast<int>(threadIdx.x) * each;
  const int last = min(first + each, total);
  std::uint32_t sum = 0;
  for (int k = first; k < last; ++k) sum += words[k];
  sum = (sum & 0xffffu) + (sum >> 16);
  std::uint32_t in_warp;
  std::uint32_t before = detail::sum_before(sum, in_warp);
  if (threadIdx.x % 32 == 0) sums[threadIdx.x / 32] = in_warp;
  __syncthreads();
  std::uint32_t all = 0;
#pragma unroll
  for (unsigned w = 0; w < search_warps; ++w) {
    if (w < threadIdx.x / 32) before += sums[w];
    all += sums[w];
  }
  for (int k = first; k < last; ++k) {
    const std::uint32_t word = words[k];
    const std::uint32_t next = before + (word & 0xffffu);
    words[k] = before | next << 16;
    before = next + (word >> 16);
  }
  __syncthreads();
  return all;
}

/// Each object in the cell of its lower corner, against half of the cells around. Wide ones stand in a cell
/// of their own after all others, and look at all before them.
template <>
struct BrickSearch<BrickMethod::stencil> {
  static constexpr int runs = 5;
  using Memory = SearchMemory<BrickMethod::stencil>;

  const BrickPlan& plan;

  __device__ bool is_wide(const Entry& e) const {
    return e.hi(0) - e.lo(0) > plan.reach[0] || e.hi(1) - e.lo(1) > plan.reach[1] ||
           e.hi(2) - e.lo(2) > plan.reach[2];
  }

  /// Puts the entries of a brick in order: by cell, and in a cell by body. Returns how many there are.
  __device__ std::uint32_t sort(const Entry* from, std::uint32_t objects, Memory& memory) const {
    constexpr int each = brick_objects / search_threads;
    const BrickCells& cells = plan.cells;
    Entry entry[each];
#pragma unroll
    for (int k = 0; k < each; ++k) {
      const std::uint32_t t = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      if (t < objects) entry[k] = from[t];
    }
    const int counts = cells.total() + 2;
    for (int w = static_cast<int>(threadIdx.x); 2 * w < counts; w += search_threads)
      reinterpret_cast<std::uint32_t*>(memory.begin)[w] = 0;
    __syncthreads();
    std::uint32_t place[each];  // in the cell, as chance has it, and 2^16 times the cell
#pragma unroll
    for (int k = 0; k < each; ++k) {
      const std::uint32_t t = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      if (t >= objects) continue;
      const Entry& e = entry[k];
      const std::int32_t cell = is_wide(e) ? cells.total()
                                           : cells.key(cells.cell_of(e.lo(0), 0), cells.cell_of(e.lo(1), 1),
                                                       cells.cell_of(e.lo(2), 2));
      const auto c = static_cast<std::uint32_t>(cell);
      place[k] = count_up(memory.begin, c) | c << 16;
    }
    __syncthreads();
    scan_halves(memory.begin, counts, memory.sums);
    auto* body = reinterpret_cast<std::uint32_t*>(memory.stage);
#pragma unroll
    for (int k = 0; k < each; ++k) {
      const std::uint32_t t = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      if (t < objects) body[memory.begin[place[k] >> 16] + (place[k] & 0xffffu)] = entry[k].body();
    }
    __syncthreads();
#pragma unroll
    for (int k = 0; k < each; ++k) {
      const std::uint32_t t = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      if (t >= objects) continue;
      const std::uint32_t begin = memory.begin[place[k] >> 16];
      const std::uint32_t end = memory.begin[(place[k] >> 16) + 1];
      std::uint32_t slot = begin;
      if (end - begin > 1) {
#pragma unroll 1
        for (std::uint32_t other = begin; other < end; ++other) slot += body[other] < entry[k].body();
      }
      memory.entry[slot] = entry[k];
    }
    __syncthreads();
    return objects;
  }

  __device__ void find_runs(const Entry& e, std::uint32_t slot, const Memory& memory,
                            SlotRun (&run)[runs]) const {
    const BrickCells& cells = plan.cells;
    if (is_wide(e)) {
      run[0] = {0, slot};
      return;
    }
    const std::int32_t y = cells.cell_of(e.lo(1), 1);
    const std::int32_t z = cells.cell_of(e.lo(2), 2);
    const std::int32_t from = cells.cell_of(e.lo(0) - plan.reach[0], 0);
    const std::int32_t to = cells.cell_of(e.hi(0), 0) + 1;
    const std::int32_t own = (z * cells.count[1] + y) * cells.count[0];
    run[0] = {slot + 1, memory.begin[own + to] - slot - 1};
#pragma unroll
    for (int r = 1; r < runs; ++r) {
      const std::int32_t dy = r < 2 ? 1 : r - 3;
      const std::int32_t dz = r < 2 ? 0 : 1;
      const bool there =
          (dy < 1 || y + 1 < cells.count[1]) && (dy > -1 || y > 0) && (dz < 1 || z + 1 < cells.count[2]);
      const std::int32_t row = own + (dz * cells.count[1] + dy) * cells.count[0];
      if (there) {
        const std::uint32_t begin = memory.begin[row + from];
        run[r] = {begin, memory.begin[row + to] - begin};
      }
    }
  }
};

/// An object stands in each row along x that it overlaps and looks at those after it in that row. The pair is
/// found in the row that holds the larger of both lower corners.
template <>
struct BrickSearch<BrickMethod::rows> {
  static constexpr int runs = 1;
  using Memory = SearchMemory<BrickMethod::rows>;

  const BrickPlan& plan;

  /// The cells of an entry: the first, and the rows along y and z, in one word.
  __device__ std::uint32_t cells_of(const Entry& e) const {
    const BrickCells& cells = plan.cells;
    const std::int32_t y = cells.cell_of(e.lo(1), 1);
    const std::int32_t z = cells.cell_of(e.lo(2), 2);
    const std::int32_t rows_y = cells.cell_of(e.hi(1), 1) - y;
    const std::int32_t rows_z = cells.cell_of(e.hi(2), 2) - z;
    return static_cast<std::uint32_t>(cells.key(cells.cell_of(e.lo(0), 0), y, z) | rows_y << 16 |
                                      rows_z << 24);
  }
  /// Calls f(cell, tag) for each of them, with the tag that the entry has there.
  template <class F>
  __device__ void for_each_cell(std::uint32_t cells, std::uint32_t tag, const F& f) const {
    const auto row = static_cast<std::uint32_t>(plan.cells.count[0]);
    const std::uint32_t layer = row * static_cast<std::uint32_t>(plan.cells.count[1]);
    for (std::uint32_t z = 0; z <= cells >> 24; ++z)
      for (std::uint32_t y = 0; y <= (cells >> 16 & 0xffu); ++y) {
        const std::uint32_t here = (y > 0 ? ~begins_here(1) : ~0u) & (z > 0 ? ~begins_here(2) : ~0u);
        f((cells & 0xffffu) + z * layer + y * row, tag & here);
      }
  }

  /// As above. Where there are more entries than the memory holds, they are not put in order.
  __device__ std::uint32_t sort(const Entry* from, std::uint32_t objects, Memory& memory) const {
    constexpr int each = brick_objects / search_threads;
    constexpr int slots_each = Memory::entries / search_threads;
    Entry entry[slots_each];
#pragma unroll
    for (int k = 0; k < each; ++k) {
      const std::uint32_t t = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      if (t < objects) entry[k] = from[t];
    }
    const int counts = plan.cells.total() + 2;
    for (int w = static_cast<int>(threadIdx.x); 2 * w < counts; w += search_threads)
      reinterpret_cast<std::uint32_t*>(memory.begin)[w] = 0;
    __syncthreads();
    std::uint32_t cells[each];
    // Counted one cell further on, so that begin[c + 1] is where the cell c has its next place, and in the
    // end where it ends.
#pragma unroll
    for (int k = 0; k < each; ++k) {
      const std::uint32_t t = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      if (t >= objects) continue;
      cells[k] = cells_of(entry[k]);
      for_each_cell(cells[k], 0,
                    [&](std::uint32_t cell, std::uint32_t) { count_up(memory.begin, cell + 1); });
    }
    __syncthreads();
    const std::uint32_t entries = scan_halves(memory.begin, counts, memory.sums);
    if (entries > Memory::entries) return entries;
#pragma unroll
    for (int k = 0; k < each; ++k) {
      const std::uint32_t t = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      if (t < objects)
        for_each_cell(cells[k], entry[k].tag, [&](std::uint32_t cell, std::uint32_t tag) {
          const std::uint32_t slot = count_up(memory.begin, cell + 1);
          memory.entry[slot] = {{entry[k].axis[0], entry[k].axis[1], entry[k].axis[2]}, tag};
          memory.key[slot] = static_cast<std::uint16_t>(cell);
        });
    }
    __syncthreads();
    // Chance gave the places within a cell: the bodies' numbers give the last ones.
    std::uint32_t place[slots_each];
#pragma unroll
    for (int k = 0; k < slots_each; ++k) {
      const std::uint32_t slot = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      place[k] = slot;
      if (slot >= entries) continue;
      const std::uint32_t begin = memory.begin[memory.key[slot]];
      const std::uint32_t end = memory.begin[memory.key[slot] + 1];
      if (end - begin == 1) continue;
      entry[k] = memory.entry[slot];
      place[k] = begin;
#pragma unroll 1
      for (std::uint32_t other = begin; other < end; ++other)
        place[k] += memory.entry[other].body() < entry[k].body();
    }
    __syncthreads();
#pragma unroll
    for (int k = 0; k < slots_each; ++k) {
      const std::uint32_t slot = static_cast<unsigned>(k) * search_threads + threadIdx.x;
      if (place[k] != slot) memory.entry[place[k]] = entry[k];
    }
    __syncthreads();
    return entries;
  }

  __device__ void find_runs(const Entry& e, std::uint32_t slot, const Memory& memory,
                            SlotRun (&run)[runs]) const {
    const BrickCells& cells = plan.cells;
    const std::int32_t row = memory.key[slot] / cells.count[0] * cells.count[0];
    run[0] = {slot + 1, memory.begin[row + cells.cell_of(e.hi(0), 0) + 1] - slot - 1};
  }
};

/// The tests of 32 entries, dealt to the lanes of a warp in the order of entries, runs and candidates. Calls
/// sink(hits, pair), which the whole warp enters: a bit for each lane, and the slots of its pair in bytes of
/// entries. Returns the number of tests.
template <BrickMethod method, class Sink>
__device__ std::uint32_t search_entries(const BrickSearch<method>& search, const SearchOutput& out,
                                        SearchMemory<method>& memory, std::uint32_t first,
                                        std::uint32_t entries, Sink& sink) {
  constexpr int runs = BrickSearch<method>::runs;
  constexpr std::uint32_t window = 32 * 32;
  const unsigned lane = threadIdx.x % 32;
  SearchStage<runs>& stage = memory.stage[threadIdx.x / 32];
  const std::uint32_t slot = first + lane;
  stage.starts[lane] = 0;
  SlotRun run[runs] = {};
  if (slot < entries) {
    const Entry entry = memory.entry[slot];
    stage.turned[lane] = facing(entry);
    search.find_runs(entry, slot, memory, run);
  }
  // Two sums in one: there are at most 160 runs, and 32 times most_entries tests.
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
  // Marks the tests with which runs start, of a window of tests. The last lane marks the end, so that what is
  // left of the last words goes to nobody.
  const auto mark = [&](std::uint32_t done) {
    auto from = static_cast<std::int32_t>(first_test - done);  // negative: before the window
    const std::int32_t word = from >> 5;
    std::uint32_t bits[2] = {};  // of this word and the next one: further on there is hardly ever anything
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
    if (far) {
      from = static_cast<std::int32_t>(first_test - done);
      for (int r = 0; r <= runs; ++r) {
        const bool starts = r < runs ? used[r] > 0 : lane == 31;
        if (starts && from - 32 * word >= 64 && from >= 0 && from < static_cast<std::int32_t>(window))
          atomicOr(&stage.starts[from / 32], 1u << (from % 32));
        if (r < runs) from += static_cast<std::int32_t>(run[r].length);
      }
    }
  };
  mark(0);
  const std::uint32_t up_to_lane = held((2u << lane) - 1);
  const std::uint32_t turned_from = held(shared_address(stage.turned) - first * 16);
  const std::uint32_t entries_from = held(shared_address(memory.entry));
  std::uint32_t started = 0;  // runs, before the word
  for (std::uint32_t done = 0; done < tests; done += window) {
    if (done > 0) {
      stage.starts[lane] = 0;
      __syncwarp();
      mark(done);
    }
    __syncwarp();
    const std::uint32_t words = held((min(tests - done, window) + 31) / 32);
    std::uint32_t test = (done + lane) * 16;  // in bytes of entries
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
      __syncwarp();  // so that all loads are under way before the first is needed
#pragma unroll
      for (int h = 0; h < 2; ++h) {
        const bool near = may_meet(a[h], b[h]);
        ask[h] = near && !meets_clearly(a[h], b[h]);
        hits[h] = __ballot_sync(detail::all_lanes, near);
      }
      if (__any_sync(detail::all_lanes, ask[0] || ask[1])) {
#pragma unroll
        for (int h = 0; h < 2; ++h) {
          const bool apart = ask[h] && !overlap(out.bounds[a[h].body()], out.bounds[b[h].body()]);
          hits[h] &= ~__ballot_sync(detail::all_lanes, apart);
        }
      }
      sink(hits[0], pair[0]);
      sink(hits[1], pair[1]);
    }
    __syncwarp();
  }
  return tests;
}

/// Keeps the slots of pairs in shared memory, as long as there is room.
template <std::uint32_t room>
struct KeepPairs {
  std::uint32_t kept;  ///< shared address
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

/// Writes the pairs, as long as there is room.
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
  // Blocks start in the order of their numbers, so that what a block waits for has started.
  const std::uint32_t brick = blockIdx.x;
  if (store.state->over_full) return;
  const std::uint32_t objects = store.counts[brick];
  std::uint32_t entries = 0;
  if (objects > 0) entries = search.sort(store.entries + std::size_t{brick} * brick_objects, objects, memory);
  if (entries > memory.entries) {
    store.state->crowded = 1;
    entries = 0;
  }
  if (lane == 0) memory.stage[warp].turned[32].axis[0] = apart_bits;
  // Each warp has as many batches of 32 entries, one more or less, in order.
  const std::uint32_t batches = (entries + 31) / 32;
  const std::uint32_t begin = batches * warp / search_warps;
  const std::uint32_t end = batches * (warp + 1) / search_warps;
  KeepPairs<memory.kept_pairs> keep{held(shared_address(memory.kept[warp])), 1u << lane};
  std::uint32_t tests = 0;
  for (std::uint32_t batch = begin; batch < end; ++batch)
    tests += search_entries(search, out, memory, 32 * batch, entries, keep);
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
      search_entries(search, out, memory, 32 * batch, entries, write);
  }
}

}  // namespace scree
