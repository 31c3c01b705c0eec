// Matches: what searches among runs of candidates find, in one list whose order depends on the input alone.
// One of the headers that know which compiler reads them; for parallel libraries alone.
#pragma once

#include "core/array.hpp"
#include "core/timing.hpp"

#include <tbb/concurrent_queue.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <deque>

#if SCREE_WITH_CUDA
#include "core/error.hpp"

#include <cuda_runtime_api.h>
#endif

namespace scree {

/// Candidates from `begin` to before `end`.
struct Run {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

struct MatchTotals {
  std::int64_t matches = 0;
  std::int64_t tests = 0;
};

inline constexpr int items_at_once = 32;
inline constexpr int runs_at_once = 5;  // a part of an item's

/// Runs searches and lists what they find, one search after the other. In each, items come in blocks of
/// items_at_once, and in such a block one part of the items' runs after the other; within, item after item,
/// run after run.
///
/// A Search names its work (`label`) and has
///   std::int64_t items; int parts;            of each item
///   Item item(std::int64_t i)                 with a member `object`, all that a test needs of it
///   Run run(const Item&, int part, int r)     0 <= r < runs_at_once, many of them empty
///   Candidate candidate(std::uint32_t k)
///   bool meets(const Object&, int run, const Candidate&)    run: part * runs_at_once + r
///   Match match(const Object&, const Candidate&)
template <class Space, class Match>
class MatchFinder;

namespace detail {

/// What some items find: written as far as there is room, all counted.
template <class Match>
struct FoundMatches {
  Match* to;
  std::int64_t room;
  std::int64_t count = 0;
  std::int64_t tests = 0;
};

/// The tests of a block of items, in order, each a task: a candidate, and whose it is. Runs have few
/// candidates, and any number: a loop over each would end unforeseen, which costs a processor as much as
/// several tests. So tasks are written down `stride` at a time, which most runs are not longer than, and
/// tested in a loop without branches.
template <class Search>
class HostTasks {
 public:
  explicit HostTasks(const Search& search) : search_(search) {}

  /// Of items from `first` to before `end`, items_at_once at most.
  template <class Match>
  void search(std::int64_t first, std::int64_t end, FoundMatches<Match>& found) {
    const auto items = static_cast<std::uint32_t>(end - first);
    for (std::uint32_t i = 0; i < items; ++i) item_[i] = search_.item(first + i);
    for (int part = 0; part < search_.parts; ++part)
      for (std::uint32_t i = 0; i < items; ++i)
        for (int r = 0; r < runs_at_once; ++r) {
          const auto number = static_cast<std::uint32_t>(part * runs_at_once + r);
          add(search_.run(item_[i], part, r), number * items_at_once + i, found);
        }
    test(found);
  }

 private:
  static constexpr std::uint32_t stride = 8;
  static constexpr std::uint32_t most = 1024;

  template <class Match>
  void add(Run run, std::uint32_t owner, FoundMatches<Match>& found) {
    found.tests += run.end - run.begin;
    for (;;) {
      std::uint32_t* const candidate = candidate_ + count_;
      std::uint32_t* const owners = owner_ + count_;
      for (std::uint32_t j = 0; j < stride; ++j) candidate[j] = run.begin + j;
      for (std::uint32_t j = 0; j < stride; ++j) owners[j] = owner;
      const std::uint32_t left = run.end - run.begin;
      count_ += std::min(left, stride);
      if (count_ > most - stride) test(found);
      if (left <= stride) return;
      run.begin += stride;
    }
  }

  /// Does all tasks.
  template <class Match>
  void test(FoundMatches<Match>& found) {
    std::uint32_t hit[most];
    std::uint32_t hits = 0;
    for (std::uint32_t t = 0; t < count_; ++t) {
      hit[hits] = t;
      hits += search_.meets(object(t), static_cast<int>(owner_[t] / items_at_once),
                            search_.candidate(candidate_[t]))
                  ? 1
                  : 0;
    }
    const std::int64_t room = std::clamp<std::int64_t>(found.room - found.count, 0, hits);
    for (std::int64_t h = 0; h < room; ++h)
      found.to[found.count + h] = search_.match(object(hit[h]), search_.candidate(candidate_[hit[h]]));
    found.count += hits;
    count_ = 0;
  }

  const auto& object(std::uint32_t task) const { return item_[owner_[task] % items_at_once].object; }

  const Search& search_;
  typename Search::Item item_[items_at_once];
  std::uint32_t count_ = 0;
  std::uint32_t candidate_[most];
  std::uint32_t owner_[most];  ///< item, and items_at_once times the run's number
};

}  // namespace detail

template <class Match>
class MatchFinder<Host, Match> {
 public:
  /// Calls `reserve(n)` before `out` is made to hold n matches: no memory is asked for that it refuses. Where
  /// `out` has too little room, the searches are done again.
  template <class Reserve, class... Search>
  MatchTotals find(Array<Match, Host>& out, const Reserve& reserve, const Search&... searches) {
    for (;;) {
      MatchTotals totals;
      (run(searches, {out.data(), out.capacity()}, totals), ...);
      reserve(totals.matches);
      const bool fits = totals.matches <= out.capacity();
      out.resize(totals.matches);
      if (fits) return totals;
    }
  }

 private:
  static constexpr std::int64_t chunk_items = 1024;
  static constexpr std::int64_t kept = 32 * chunk_items;  // matches of a chunk until their place is known

  /// Items that are searched by one thread.
  struct Chunk {
    std::int64_t first;
    Array<Match, Host> matches;
    detail::FoundMatches<Match> found;
    std::int64_t place;  ///< of its first match
  };

  template <class Search>
  void run(const Search& search, View<Match> out, MatchTotals& totals) {
    const timing::Call<Host> call(Search::label);
    if (search.items > chunk_items) return run_chunks(search, out, totals);
    detail::FoundMatches<Match> found{};
    if (totals.matches < out.size()) found = {out.data() + totals.matches, out.size() - totals.matches};
    search_chunk(search, 0, found);  // without waking a thread
    totals.matches += found.count;
    totals.tests += found.tests;
  }

  /// Chunks are searched at once, get their places in order, and are copied there at once. What a chunk finds
  /// beyond `kept` it searches again.
  template <class Search>
  void run_chunks(const Search& search, View<Match> out, MatchTotals& totals) {
    tbb::concurrent_queue<Chunk*> idle;
    const auto under_way = static_cast<std::size_t>(2 * tbb::this_task_arena::max_concurrency());
    while (chunks_.size() < under_way) chunks_.emplace_back().matches.resize(kept);
    for (Chunk& chunk : chunks_) idle.push(&chunk);
    std::int64_t next = 0;
    const auto begin = [&](tbb::flow_control& flow) {
      Chunk* chunk = nullptr;
      if (next >= search.items) {
        flow.stop();
        return chunk;
      }
      while (!idle.try_pop(chunk)) continue;  // one is idle: as many may be under way as there are
      chunk->first = next;
      next += chunk_items;
      return chunk;
    };
    const auto find = [&](Chunk* chunk) {
      chunk->found = {chunk->matches.data(), kept};
      search_chunk(search, chunk->first, chunk->found);
      return chunk;
    };
    const auto place = [&](Chunk* chunk) {
      chunk->place = totals.matches;
      totals.matches += chunk->found.count;
      totals.tests += chunk->found.tests;
      return chunk;
    };
    const auto put = [&](Chunk* chunk) {
      const std::int64_t count = chunk->found.count;
      if (chunk->place + count <= out.size()) {
        Match* const to = out.data() + chunk->place;
        if (count <= kept) {
          std::copy_n(chunk->matches.data(), count, to);
        } else {
          detail::FoundMatches<Match> there{to, count};
          search_chunk(search, chunk->first, there);
        }
      }
      idle.push(chunk);
    };
    using tbb::filter_mode;
    tbb::parallel_pipeline(under_way,
                           tbb::make_filter<void, Chunk*>(filter_mode::serial_in_order, begin) &
                               tbb::make_filter<Chunk*, Chunk*>(filter_mode::parallel, find) &
                               tbb::make_filter<Chunk*, Chunk*>(filter_mode::serial_in_order, place) &
                               tbb::make_filter<Chunk*, void>(filter_mode::parallel, put));
  }

  template <class Search>
  static void search_chunk(const Search& search, std::int64_t first, detail::FoundMatches<Match>& found) {
    const std::int64_t end = std::min(first + chunk_items, search.items);
    detail::HostTasks<Search> tasks(search);
    for (; first < end; first += items_at_once)
      tasks.search(first, std::min(first + items_at_once, end), found);
  }

  std::deque<Chunk> chunks_;  // which stay where they are
};

#if SCREE_WITH_CUDA

namespace detail {

using Word = unsigned long long;

/// Where the blocks of a search put what they find. Each tile of items publishes how much it has found, as
/// soon as it knows, and then how much it and all before it have (decoupled look-back; Merrill and Garland
/// 2016, "Single-pass Parallel Prefix Scan with Decoupled Look-back").
template <class Match>
struct MatchOutput {
  Match* matches;
  Word room;     ///< what lies beyond is counted and not written
  Word* total;   ///< before this search, and after it
  Word* ticket;  ///< the next tile: tiles start in their order, so that none waits for one that cannot start
  Word* tests;   ///< test_counters sums
  Word* tiles;   ///< state of each
};

inline constexpr int match_warps = 4;       // of a block
inline constexpr int test_counters = 64;    // so that blocks do not queue for one
inline constexpr std::uint32_t kept = 256;  // matches that a warp keeps until it knows their place
inline constexpr std::uint32_t words = 32;  // of 32 tasks: those whose runs are found at once
inline constexpr unsigned all_lanes = 0xffffffffu;
inline constexpr Word tile_known = Word{1} << 62;
inline constexpr Word tile_summed = Word{2} << 62;
inline constexpr Word tile_value = tile_known - 1;

/// A run that is not empty, among the tasks of a warp.
struct alignas(8) TaskRun {
  std::uint32_t shift;  ///< from its tasks to its candidates
  std::uint32_t owner;  ///< lane of its item, and 32 times its number
};

/// What a warp shares.
template <class Object, class Match>
struct MatchStage {
  Object object[32];
  TaskRun run[32 * runs_at_once];
  std::uint32_t starts[words];  ///< bit for each task: a run starts
  std::uint32_t before[words];  ///< runs that start before the word, less one
  Match match[kept];
};

template <class T>
__device__ T sum_before(T value, T& total) {
  const unsigned lane = threadIdx.x % 32;
  T sum = value;
  for (unsigned d = 1; d < 32; d *= 2) {
    const T other = __shfl_up_sync(all_lanes, sum, d);
    if (lane >= d) sum += other;
  }
  total = __shfl_sync(all_lanes, sum, 31);
  return sum - value;
}

/// The tests of the runs of 32 items, spread over the lanes of a warp: each test is a task, in the order of
/// items, runs and candidates. Calls sink(hit, match), which the whole warp enters. `mine`: whether those of
/// this lane are to be done. `first_run`: number of the first of `run`.
template <class Search, class Stage, class Sink>
__device__ void do_tasks(const Search& search, int first_run, const Run (&run)[runs_at_once], bool mine,
                         Stage& stage, Sink& sink) {
  const unsigned lane = threadIdx.x % 32;
  std::uint32_t lengths[runs_at_once];
  std::uint32_t length = 0;
  std::uint32_t used = 0;
#pragma unroll
  for (int u = 0; u < runs_at_once; ++u) {
    lengths[u] = mine ? run[u].end - run[u].begin : 0;
    length += lengths[u];
    used += lengths[u] > 0;
  }
  std::uint32_t tasks;
  const std::uint32_t begin = sum_before(length, tasks);
  std::uint32_t slots;
  std::uint32_t slot = sum_before(used, slots);
  std::uint32_t at = begin;
#pragma unroll
  for (int u = 0; u < runs_at_once; ++u) {
    if (lengths[u] > 0)
      stage.run[slot++] = {run[u].begin - at, lane + 32u * static_cast<unsigned>(first_run + u)};
    at += lengths[u];
  }
  std::uint32_t slots_before = 0;
  for (std::uint32_t done = 0; done < tasks;) {
    const std::uint32_t left = min(tasks - done, 32 * words);
    stage.starts[lane] = 0;
    __syncwarp();
    at = begin - done;  // of an earlier window: large
#pragma unroll
    for (int u = 0; u < runs_at_once; ++u) {
      if (lengths[u] > 0 && at < left) atomicOr(&stage.starts[at / 32], 1u << (at % 32));
      at += lengths[u];
    }
    __syncwarp();
    std::uint32_t started;
    stage.before[lane] =
        slots_before + sum_before(static_cast<std::uint32_t>(__popc(stage.starts[lane])), started) - 1;
    slots_before += started;
    __syncwarp();
    sink.begin();
    for (std::uint32_t word = 0; 32 * word < left; word += 2) {
      // Two tasks of a lane at once, so that the loads of both are under way.
      typename Search::Candidate candidate[2];
      TaskRun of[2];
      bool active[2];
#pragma unroll
      for (std::uint32_t h = 0; h < 2; ++h) {
        const std::uint32_t task = min(32 * (word + h) + lane, left - 1);
        active[h] = 32 * (word + h) + lane < left;
        const std::uint32_t reached = stage.starts[task / 32] & ((2u << task % 32) - 1);
        of[h] = stage.run[stage.before[task / 32] + static_cast<std::uint32_t>(__popc(reached))];
        candidate[h] = search.candidate(done + task + of[h].shift);
      }
#pragma unroll
      for (std::uint32_t h = 0; h < 2; ++h) {
        const auto& object = stage.object[of[h].owner % 32];
        const bool hit = search.meets(object, static_cast<int>(of[h].owner / 32), candidate[h]) & active[h];
        sink(hit, [&] { return search.match(object, candidate[h]); });
      }
    }
    sink.end();
    done += left;
    __syncwarp();
  }
}

/// All tests of 32 items; returns their number for this lane's.
template <class Search, class Stage, class Sink>
__device__ Word search_items(const Search& search, std::int64_t first, Stage& stage, Sink& sink) {
  const unsigned lane = threadIdx.x % 32;
  const std::int64_t i = first + lane;
  const bool here = i < search.items;
  const auto item = search.item(here ? i : first);
  stage.object[lane] = item.object;
  Word tests = 0;
  for (int part = 0; part < search.parts; ++part) {
    Run run[runs_at_once];
    std::uint32_t length = 0;  // runs do not share candidates, so that a lane's tasks are fewer than 2^32
#pragma unroll
    for (int u = 0; u < runs_at_once; ++u) {
      run[u] = here ? search.run(item, part, u) : Run{};
      length += run[u].end - run[u].begin;
    }
    tests += length;
    // Those of all 32 lanes are too, unless one has over 2^26: then the lanes take turns.
    const bool in_turns = __any_sync(all_lanes, length > (1u << 26));
    for (unsigned turn = 0; turn < (in_turns ? 32u : 1u); ++turn)
      do_tasks(search, part * runs_at_once, run, !in_turns || turn == lane, stage, sink);
  }
  return tests;
}

/// Puts matches where they belong in the order of the lanes, up to the room that there is.
template <class Match>
struct MatchSink {
  Match* to;
  Word room;
  Word count = 0;
  // Since begin(), for the tasks of one window.
  Match* next = nullptr;
  std::uint32_t left = 0;
  std::uint32_t fresh = 0;

  __device__ void begin() {
    next = to + count;
    left = room > count ? static_cast<std::uint32_t>(min(room - count, Word{32 * words})) : 0;
    fresh = 0;
  }
  template <class Make>
  __device__ void operator()(bool hit, const Make& make) {
    const unsigned hits = __ballot_sync(all_lanes, hit);
    const std::uint32_t at =
        fresh + static_cast<std::uint32_t>(__popc(hits & ((1u << threadIdx.x % 32) - 1)));
    if (hit && at < left) next[at] = make();
    fresh += static_cast<std::uint32_t>(__popc(hits));
  }
  __device__ void end() { count += fresh; }
};

__device__ inline Word load_state(const Word* state) {
  Word value;
  asm volatile("ld.relaxed.gpu.global.u64 %0, [%1];" : "=l"(value) : "l"(state) : "memory");
  return value;
}
__device__ inline void store_state(Word* state, Word value) {
  asm volatile("st.relaxed.gpu.global.u64 [%0], %1;" ::"l"(state), "l"(value) : "memory");
}

/// Tells the tiles after this one what it has found, and returns what those before it have found; entered by
/// one warp, which looks at 256 of them at once.
__device__ inline Word found_before(Word* states, std::int64_t tile, Word found) {
  constexpr int at_once = 8;
  const int lane = static_cast<int>(threadIdx.x % 32);
  if (lane == 0) store_state(states + tile, (tile == 0 ? tile_summed : tile_known) | found);
  Word sum = 0;
  bool done = tile == 0;
  for (std::int64_t last = tile - 1; !done; last -= 32 * at_once) {
    Word state[at_once];
#pragma unroll
    for (int k = 0; k < at_once; ++k) {
      const std::int64_t before = last - 32 * k - lane;
      state[k] = before >= 0 ? load_state(states + before) : tile_summed;
    }
#pragma unroll
    for (int k = 0; k < at_once; ++k) {
      if (done) continue;
      while (state[k] < tile_known) state[k] = load_state(states + last - 32 * k - lane);
      const unsigned summed = __ballot_sync(all_lanes, state[k] >= tile_summed);
      const int nearest = summed ? __ffs(static_cast<int>(summed)) - 1 : 31;
      Word value = lane <= nearest ? state[k] & tile_value : 0;
      for (int d = 16; d > 0; d /= 2) value += __shfl_xor_sync(all_lanes, value, d);
      sum += value;
      done = summed != 0;
    }
  }
  if (lane == 0 && tile > 0) store_state(states + tile, tile_summed | (sum + found));
  return sum;
}

template <class Search, class Match>
__global__ void __launch_bounds__(32 * match_warps, 8)
    find_matches(const __grid_constant__ Search search, const MatchOutput<Match> out) {
  using Object = decltype(search.item(0).object);
  __shared__ MatchStage<Object, Match> stages[match_warps];
  __shared__ Word found[match_warps];
  __shared__ Word tile_of_block;
  __shared__ Word place;
  const unsigned warp = threadIdx.x / 32;
  const unsigned lane = threadIdx.x % 32;
  if (threadIdx.x == 0) tile_of_block = atomicAdd(out.ticket, Word{1});
  __syncthreads();
  const auto tile = static_cast<std::int64_t>(tile_of_block);
  const std::int64_t first = 32 * (match_warps * tile + warp);
  MatchStage<Object, Match>& stage = stages[warp];
  Word tests = 0;
  MatchSink<Match> keep{stage.match, kept};
  if (first < search.items) tests = search_items(search, first, stage, keep);
  for (int d = 16; d > 0; d /= 2) tests += __shfl_xor_sync(all_lanes, tests, d);
  if (lane == 0) {
    found[warp] = keep.count;
    if (tests > 0) atomicAdd(out.tests + tile % test_counters, tests);
  }
  __syncthreads();
  if (warp == 0) {
    Word in_tile = 0;
    for (int w = 0; w < match_warps; ++w) in_tile += found[w];
    const Word before = found_before(out.tiles, tile, in_tile);
    if (lane == 0) {
      place = *out.total + before;
      if (tile + 1 == gridDim.x) out.total[1] = place + in_tile;
    }
  }
  __syncthreads();
  Word at = place;
  for (unsigned w = 0; w < warp; ++w) at += found[w];
  const Word room = out.room > at ? out.room - at : 0;
  if (keep.count <= kept) {
    for (Word k = lane; k < keep.count && k < room; k += 32) out.matches[at + k] = stage.match[k];
  } else if (room > 0) {
    MatchSink<Match> rest{out.matches + at, room};
    search_items(search, first, stage, rest);
  }
}

}  // namespace detail

template <class Match>
class MatchFinder<Device, Match> {
 public:
  /// As on Host. Where `out` has too little room, the searches are done again.
  template <class Reserve, class... Search>
  MatchTotals find(Array<Match, Device>& out, const Reserve& reserve, const Search&... searches) {
    using detail::Word;
    constexpr std::int64_t count = sizeof...(Search);
    // In the order of totals, tickets, tests and tiles.
    constexpr std::int64_t head = count + 1 + count + detail::test_counters;
    const std::int64_t tiles = (tiles_of(searches) + ... + std::int64_t{0});
    state_.resize(head + tiles);
    for (;;) {
      if (cudaMemsetAsync(state_.data(), 0, static_cast<std::size_t>(state_.size()) * sizeof(Word)) !=
          cudaSuccess)
        throw RunError("CUDA: could not clear memory");
      std::int64_t tile = head;
      std::int64_t number = 0;
      const auto launch = [&](const auto& search) {
        Word* state = state_.data();
        start(search, {out.data(), static_cast<Word>(out.capacity()), state + number,
                       state + count + 1 + number, state + 2 * count + 1, state + tile});
        tile += tiles_of(search);
        ++number;
      };
      (launch(searches), ...);
      Word totals[head];
      copy_bytes<Host, Device>(totals, state_.data(), sizeof(totals));
      MatchTotals result{.matches = static_cast<std::int64_t>(totals[count]), .tests = 0};
      for (int k = 0; k < detail::test_counters; ++k)
        result.tests += static_cast<std::int64_t>(totals[2 * count + 1 + k]);
      reserve(result.matches);
      const bool fits = result.matches <= out.capacity();
      out.resize(result.matches);
      if (fits) return result;
    }
  }

 private:
  static constexpr std::int64_t tile_items = 32 * detail::match_warps;

  template <class Search>
  static std::int64_t tiles_of(const Search& search) {
    return (search.items + tile_items - 1) / tile_items;
  }

  template <class Search>
  static void start(const Search& search, const detail::MatchOutput<Match>& out) {
    const timing::Call<Device> call(Search::label);
    const std::int64_t tiles = tiles_of(search);
    if (tiles == 0) {
      copy_bytes<Device, Device>(out.total + 1, out.total, sizeof(*out.total));
      return;
    }
    detail::find_matches<<<static_cast<unsigned>(tiles), 32 * detail::match_warps>>>(search, out);
  }

  Array<detail::Word, Device> state_;
};

#endif

}  // namespace scree
