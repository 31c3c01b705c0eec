// Programs of phases: loops whose phases wait for one another and whose number of passes only the results
// tell, such as sweeps until the impulses converge. On a GPU the whole loop is one launch of a cooperative
// kernel, without the host between. For parallel sources alone.
#pragma once

#include "core/array.hpp"
#include "core/block_limit.hpp"
#include "core/space_tiles.hpp"
#include "core/thread_pool.hpp"
#include "core/timing.hpp"

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

#if SCREE_WITH_CUDA
#include <cuda/atomic>
#endif

/// Before a SCREE_HD template that calls functions of its arguments: these need to run only where it is
/// called.
#if defined(__CUDACC__)
#define SCREE_CALLS_ITS_ARGUMENTS _Pragma("nv_exec_check_disable")
#else
#define SCREE_CALLS_ITS_ARGUMENTS
#endif

namespace scree::parallel {

namespace detail {

/// Sum over a tile of a phase on Host.
template <class Program>
struct TileOfPhase {
  const Program& program;
  const typename Program::State& state;
  int phase;
  std::int64_t items;
  typename Program::Sum* sums;
  void operator()(std::int64_t t) const {
    typename Program::Sum sum{};
    const std::int64_t end = std::min((t + 1) * tile, items);
    for (std::int64_t item = t * tile; item < end; ++item) sum = sum + program(state, phase, item);
    sums[t] = sum;
  }
};

/// A program that does its work on a range of items in one call, program.over(state, phase, begin, end), and
/// whose items() depend on the state alone. All phases are cut into ranges in the same way, so that one
/// thread works on the same part of each.
template <class Program>
concept WorksOnRuns = requires(const Program& program, const typename Program::State& state) {
  { program.over(state, 0, std::int64_t{}, std::int64_t{}) } -> std::same_as<typename Program::Sum>;
};

template <class Program>
requires WorksOnRuns<Program>
typename Program::State run(Host, const char* label, const Program& program, typename Program::State state) {
  using Sum = typename Program::Sum;
  constexpr std::int64_t most_runs = 128;
  constexpr std::int64_t fewest = 16;   // items that are worth more than one thread, some 2 us
  constexpr std::int64_t together = 4;  // least items of a range
  const bool shared = program.most_items() >= fewest;
  const std::int64_t runs_at_most = shared ? std::min(program.most_items() / together, most_runs) : 1;
  const timing::Call<Host> call(label);
  std::vector<Sum> sums;
  for (int phases = program.phases(state); phases > 0; phases = program.phases(state)) {
    sums.assign(static_cast<std::size_t>(phases * runs_at_most), Sum{});
    const auto runs_of = [&](int phase) {
      const std::int64_t items = program.items(state, phase);
      return items < fewest ? 1 : std::min(items / together, runs_at_most);
    };
    const auto work = [&](int phase, std::int64_t first, std::int64_t last) {
      const std::int64_t items = program.items(state, phase);
      const std::int64_t runs = runs_of(phase);
      for (std::int64_t r = first; r < last; ++r) {
        sums[static_cast<std::size_t>(phase * runs_at_most + r)] =
            program.over(state, phase, items * r / runs, items * (r + 1) / runs);
      }
    };
    if (shared) {
      scree::detail::ThreadPool::get().for_ranges_in_phases(phases, runs_of, work);
    } else {
      for (int phase = 0; phase < phases; ++phase) work(phase, 0, 1);
    }
    Sum total{};
    for (const Sum& sum : sums) total = total + sum;
    state = program.judge(state, total);
  }
  return state;
}

template <class Program>
typename Program::State run(Host, const char* label, const Program& program, typename Program::State state) {
  constexpr std::int64_t fewest = 8;  // tiles worth waking threads for
  std::vector<typename Program::Sum> sums;
  for (int phases = program.phases(state); phases > 0; phases = program.phases(state)) {
    typename Program::Sum total{};
    for (int phase = 0; phase < phases; ++phase) {
      const std::int64_t items = program.items(state, phase);
      sums.resize(static_cast<std::size_t>(tiles_of(items)));
      parallel::for_each<Host>(label, tiles_of(items),
                               TileOfPhase<Program>{program, state, phase, items, sums.data()}, fewest);
      for (const typename Program::Sum& sum : sums) total = total + sum;
    }
    state = program.judge(state, total);
  }
  return state;
}

#if SCREE_WITH_CUDA

/// A barrier for all blocks of a launch. The lower bits of a word in memory, which is 0 at first, count the
/// blocks that have arrived; the last of them flips the highest bit and clears the others. Unlike in
/// grid.sync() of cooperative groups, no block waits for the result of its atomic addition.
class GridBarrier {
 public:
  __device__ explicit GridBarrier(unsigned* word) : word_(*word) {}

  __device__ void wait() {
    __syncthreads();
    if (threadIdx.x == 0) {
      word_.fetch_add(blockIdx.x == 0 ? flip - (gridDim.x - 1) : 1u, cuda::memory_order_release);
      while ((word_.load(cuda::memory_order_relaxed) & flip) == before_) {
      }
      cuda::atomic_thread_fence(cuda::memory_order_acquire, cuda::thread_scope_device);
      before_ ^= flip;
    }
    __syncthreads();
  }

 private:
  static constexpr unsigned flip = 1u << 31;
  cuda::atomic_ref<unsigned, cuda::thread_scope_device> word_;
  unsigned before_ = 0;  // the highest bit, as the block's first thread knows it
};

/// How many phases from `first` on have so few items that one block does them sooner than all blocks would
/// pass a barrier. 0 where items() depend on what other blocks do meanwhile. `items`: those of phase `first`.
template <class Program>
__device__ int phases_of_one_block(const Program& program, const typename Program::State& state, int first,
                                   int phases, std::int64_t items) {
  int few = 0;
  if constexpr (WorksOnRuns<Program>) {
    while (items <= Program::threads) {
      if (first + ++few == phases) break;
      items = program.items(state, first + few);
    }
  }
  return few;
}

constexpr int warp = 32;

/// A program whose items go different ways, so that the threads of a warp work on them one after the other.
template <class Program>
concept Diverges = requires {
  requires Program::diverges;
};

/// The items of a phase that a thread works on: `first`, and then each `stride`-th. They are dealt to the
/// blocks warp by warp, so that a phase of few items still uses all processors. If they diverge, few items
/// also use few threads of each warp.
struct ItemsOfThread {
  std::int64_t first, stride;

  template <class Program>
  __device__ static ItemsOfThread of(std::int64_t items) {
    constexpr int warps_of_block = Program::threads / warp;
    const std::int64_t warps = std::int64_t{gridDim.x} * warps_of_block;
    const std::int64_t number = std::int64_t{threadIdx.x / warp} * gridDim.x + blockIdx.x;
    const std::int64_t lane = threadIdx.x % warp;
    std::int64_t lanes = warp;
    if constexpr (Diverges<Program>) lanes = std::clamp((items + warps - 1) / warps, std::int64_t{1}, lanes);
    return {lane < lanes ? number * lanes + lane : items, warps * lanes};
  }
};

/// All blocks are on the GPU at once, and wait for each other between phases. Each block has its own copy of
/// the state and computes the next one from the sums of all blocks. There are two sets of sums, because
/// blocks that are behind may still read one of them.
template <class Program>
__global__ void __launch_bounds__(Program::threads, blocks_at_once<Program>())
    run_phases(const __grid_constant__ Program program, const typename Program::State start,
               typename Program::Sum* sums, typename Program::State* out, unsigned* barrier_word) {
  using Sum = typename Program::Sum;
  constexpr bool adds_up = !std::is_empty_v<Sum>;
  constexpr int threads = Program::threads;
  __shared__ BlockRoom<Sum, threads> room;
  __shared__ BlockRoom<typename Program::State, 1> state_room;
  typename Program::State& state = *state_room.data();
  if (threadIdx.x == 0) state = start;
  __syncthreads();
  GridBarrier barrier(barrier_word);
  Sum* const sums_of[] = {sums, sums + gridDim.x};
  int set = 0;
  for (int phases = program.phases(state); phases > 0; phases = program.phases(state)) {
    Sum mine{};
    for (int phase = 0; phase < phases;) {
      if (phase > 0) barrier.wait();
      const std::int64_t items = program.items(state, phase);
      if (const int few = phases_of_one_block(program, state, phase, phases, items); few > 0) {
        for (int k = 0; blockIdx.x == 0 && k < few; ++k) {
          if (k > 0) __syncthreads();
          const std::int64_t item = threadIdx.x;
          if (item < program.items(state, phase + k)) mine = mine + program(state, phase + k, item);
        }
        phase += few;
        continue;
      }
      const auto of_thread = ItemsOfThread::of<Program>(items);
      for (std::int64_t i = of_thread.first; i < items; i += of_thread.stride)
        mine = mine + program(state, phase, i);
      ++phase;
    }
    if constexpr (adds_up) {
      const Sum sum = sum_over_block<threads>(mine, room.data());
      if (threadIdx.x == 0) sums_of[set][blockIdx.x] = sum;
    }
    barrier.wait();
    Sum of_blocks{};
    if constexpr (adds_up) {
      for (unsigned b = threadIdx.x; b < gridDim.x; b += threads) of_blocks = of_blocks + sums_of[set][b];
      of_blocks = sum_over_block<threads>(of_blocks, room.data());
    }
    if (threadIdx.x == 0) state = program.judge(state, of_blocks);
    __syncthreads();
    set = 1 - set;
  }
  if (blockIdx.x == 0 && threadIdx.x == 0) *out = state;
}

/// Blocks that the GPU can hold at once.
struct GpuRoom {
  int processors = 0, on_each = 0;
};
template <class Program>
GpuRoom room_for() {
  static const GpuRoom room = [] {
    int device = 0;
    GpuRoom found;
    cudaGetDevice(&device);
    cudaDeviceGetAttribute(&found.processors, cudaDevAttrMultiProcessorCount, device);
    cudaOccupancyMaxActiveBlocksPerMultiprocessor(&found.on_each, run_phases<Program>, Program::threads, 0);
    scree::detail::require_launched("the first program of phases");
    return GpuRoom{std::max(found.processors, 1), std::max(found.on_each, 1)};
  }();
  return room;
}

/// A barrier of fewer blocks is quicker: there is one block on each processor, as long as its threads have
/// few items each.
template <class Program>
unsigned blocks_for(std::int64_t items) {
  constexpr std::int64_t least = Diverges<Program> ? Program::threads / warp : 64;  // items of a block
  constexpr std::int64_t few = 2;                                                   // items of a thread
  const GpuRoom room = room_for<Program>();
  const bool alone = items <= few * room.processors * Program::threads;
  const std::int64_t most = room.processors * (alone ? 1 : room.on_each);
  return static_cast<unsigned>(std::clamp<std::int64_t>((items + least - 1) / least, 1,
                                                        std::min<std::int64_t>(most, block_limit.load())));
}

template <class Program>
typename Program::State run(Device, const char* label, Program program, typename Program::State state) {
  const timing::Call<Device> call(label);
  const unsigned blocks = blocks_for<Program>(program.most_items());
  Array<typename Program::Sum, Device> sums(2 * std::int64_t{blocks});
  Array<typename Program::State, Device> out(1);
  Array<unsigned, Device> barrier_word(1);
  auto* sums_data = sums.data();
  auto* out_data = out.data();
  auto* word_data = barrier_word.data();
  cudaMemsetAsync(word_data, 0, sizeof(unsigned));
  void* arguments[] = {&program, &state, &sums_data, &out_data, &word_data};
  cudaLaunchCooperativeKernel(run_phases<Program>, blocks, Program::threads, arguments);
  scree::detail::require_launched(label);
  copy_bytes<Host, Device>(&state, out.data(), sizeof(state));
  return state;
}

#endif

}  // namespace detail

/// Runs a program and returns its last state. A pass over the program is program.phases(state) phases. Each
/// phase calls program(state, phase, item) for program.items(state, phase) items at once; the results, of
/// type Program::Sum with an operator + (Sum may be empty), are added up over the pass. After a pass, state =
/// program.judge(state, sum). The program ends when phases() is 0. More threads than program.most_items() are
/// not used. Program::threads, a power of 2, is the size of a block: the barrier of fewer and larger blocks
/// is quicker, if registers suffice; Program::diverges, if it is there and true, tells that the
/// items go different ways. On Device the whole program is one launch, in which a phase costs some
/// microseconds. The order of the additions depends on the size of the GPU, and is the same from run to run.
template <class Space, class Program>
typename Program::State run_in_phases(const char* label, const Program& program,
                                      const typename Program::State& start) {
  return detail::run(Space{}, label, program, start);
}

}  // namespace scree::parallel
