// The sorting of a brick's entries by cell and body, on Device, in the shared memory of the block that
// searches them.
#pragma once

#include "broadphase/device/brick_scatter.hpp"

namespace scree {

inline constexpr int search_threads = 256;
inline constexpr int search_warps = search_threads / 32;

/// The memory that a warp needs while it searches.
template <int runs>
struct SearchStage {
  Entry turned[33];  ///< entries with halves exchanged; the last one meets nothing
  /// For each run, its candidates minus its tests, modulo 2^16, plus 2^16 times the slot of the object; both
  /// are in bytes of entries.
  std::uint32_t run[32 * runs + 1];
  alignas(8) std::uint32_t starts[32];  ///< one bit for each test, set if a run starts there
};

/// A run of candidates: the slots from `begin` on.
struct SlotRun {
  std::uint32_t begin = 0;
  std::uint32_t length = 0;
};

template <BrickMethod method>
struct BrickSearch;

template <BrickMethod method>
struct SearchMemory {
  static constexpr std::uint32_t entries = most_entries(method);
  static constexpr std::uint32_t kept_pairs = method == BrickMethod::stencil ? 576 : 448;  // per warp

  Entry entry[entries];
  /// Cell of each entry, for method rows alone, whose entries do not show it.
  std::uint16_t key[method == BrickMethod::rows ? entries : 2];
  /// First slot of each cell, and of the entries after the last cell.
  std::uint16_t begin[(most_cells(method) + 3) / 2 * 2];
  SearchStage<BrickSearch<method>::runs> stage[search_warps];
  /// Pairs as two slots in bytes of entries, kept until their place in the output is known.
  std::uint32_t kept[search_warps][kept_pairs];
  std::uint32_t sums[search_warps];
  std::uint32_t found[search_warps];
  Word place;
};

/// Keeps a value in a register, because the compiler would rather compute it again at each use.
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

/// Returns the dynamic shared memory of the block.
__device__ inline void* shared_memory() {
  extern __shared__ uint4 shared[];
  return shared_at<void>(held(shared_address(shared)));
}

/// Adds one to half-word k of an array, and returns the value before.
__device__ inline std::uint32_t count_up(std::uint16_t* counts, std::uint32_t k) {
  const std::uint32_t shift = k % 2 * 16;
  return atomicAdd(reinterpret_cast<std::uint32_t*>(counts) + k / 2, 1u << shift) >> shift & 0xffffu;
}

/// Replaces counts[0..n) by the sums of the counts before each, and returns the total. The whole block calls
/// it. n is rounded up to even.
__device__ inline std::uint32_t scan_halves(std::uint16_t* counts, int n, std::uint32_t* sums) {
  auto* words = reinterpret_cast<std::uint32_t*>(counts);
  const int total = (n + 1) / 2;
  const int each = (total + search_threads - 1) / search_threads;
  const int first = static_cast<int>(threadIdx.x) * each;
  const int last = min(first + each, total);
  std::uint32_t sum = 0;
  for (int k = first; k < last; ++k) sum += words[k];
  sum = (sum & 0xffffu) + (sum >> 16);
  std::uint32_t all;
  std::uint32_t before = detail::sum_before_in_block<search_threads>(sum, sums, all);
  for (int k = first; k < last; ++k) {
    const std::uint32_t word = words[k];
    const std::uint32_t next = before + (word & 0xffffu);
    words[k] = before | next << 16;
    before = next + (word >> 16);
  }
  __syncthreads();
  return all;
}

/// The search by method stencil. Each object is in the cell of its lower corner, and is tested against half
/// of the cells around it. Objects too wide for the stencil are in a cell of their own after all others, and
/// all objects before them are tested against them.
template <>
struct BrickSearch<BrickMethod::stencil> {
  static constexpr int runs = 5;
  using Memory = SearchMemory<BrickMethod::stencil>;

  const BrickPlan& plan;

  __device__ bool is_wide(const Entry& e) const {
    return e.hi(0) - e.lo(0) > plan.reach[0] || e.hi(1) - e.lo(1) > plan.reach[1] ||
           e.hi(2) - e.lo(2) > plan.reach[2];
  }

  /// Sorts the entries of a brick by cell, and within a cell by body. Returns their number.
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
    std::uint32_t place[each];  // random rank in the cell, plus 2^16 times the cell
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
    static_assert(sizeof(memory.stage) >= brick_objects * sizeof(std::uint32_t));
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

  /// Returns the first slot of the wide entries, against which all entries before them are tested.
  __device__ std::uint32_t first_wide(const Memory& memory, std::uint32_t) const {
    return memory.begin[plan.cells.total()];
  }

  /// Finds the runs of candidates of an entry before the first wide one.
  __device__ void find_runs(const Entry& e, std::uint32_t slot, const Memory& memory,
                            SlotRun (&run)[runs]) const {
    const BrickCells& cells = plan.cells;
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

/// The search by method rows. An object is in each row along x that it overlaps, and is tested against the
/// objects after it in that row. A pair is found in the row that holds the larger of both lower corners.
template <>
struct BrickSearch<BrickMethod::rows> {
  static constexpr int runs = 1;
  using Memory = SearchMemory<BrickMethod::rows>;

  const BrickPlan& plan;

  /// Returns the cells of an entry in one word: its first cell, and how many more rows it overlaps along y
  /// and z.
  __device__ std::uint32_t cells_of(const Entry& e) const {
    const BrickCells& cells = plan.cells;
    const std::int32_t y = cells.cell_of(e.lo(1), 1);
    const std::int32_t z = cells.cell_of(e.lo(2), 2);
    const std::int32_t rows_y = cells.cell_of(e.hi(1), 1) - y;
    const std::int32_t rows_z = cells.cell_of(e.hi(2), 2) - z;
    return static_cast<std::uint32_t>(cells.key(cells.cell_of(e.lo(0), 0), y, z) | rows_y << 16 |
                                      rows_z << 24);
  }
  /// Calls f(cell, tag) for each cell of an entry, with the tag that the entry has there.
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

  /// Sorts the entries as for method stencil, and returns their number. If there are more than the memory
  /// holds, they are not sorted.
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
    // The counts are made one cell further on, so that begin[c + 1] is the next free place of cell c, and at
    // last the end of cell c.
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
    // The order within a cell is random so far; the bodies' numbers give the final order.
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

  /// Returns the number of entries: an entry may have any length, so there are no wide entries to be tested
  /// apart.
  __device__ std::uint32_t first_wide(const Memory&, std::uint32_t entries) const { return entries; }

  __device__ void find_runs(const Entry& e, std::uint32_t slot, const Memory& memory,
                            SlotRun (&run)[runs]) const {
    const BrickCells& cells = plan.cells;
    const std::int32_t row = memory.key[slot] / cells.count[0] * cells.count[0];
    run[0] = {slot + 1, memory.begin[row + cells.cell_of(e.hi(0), 0) + 1] - slot - 1};
  }
};

}  // namespace scree
