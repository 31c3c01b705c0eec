// Matches on Device: the lanes of a warp share the tests of 32 items, and each block learns from the blocks
// before it where its matches belong. For parallel sources alone.
#pragma once

#include "core/array.hpp"
#include "core/matches.hpp"
#include "core/space_policy.hpp"
#include "core/space_warp.hpp"
#include "core/timing.hpp"

#include <cstdint>

#if SCREE_WITH_CUDA

namespace scree {

namespace detail {

/// The output of a search. Each block searches a tile of items, and finds the place of its matches with a
/// decoupled look-back.
template <class Match>
struct MatchOutput {
  Match* matches;
  Word room;     ///< number of matches that fit; those beyond are counted and not written
  Word* total;   ///< number of matches before this search, and after it
  Word* ticket;  ///< number of the next tile: tiles start in order, so none waits for one that cannot start
  Word* tests;   ///< numbers of tests, in test_counters parts
  Word* tiles;   ///< look-back state of each tile
};

inline constexpr int match_warps = 4;       // warps of a block
inline constexpr int test_counters = 64;    // several, so that blocks do not queue for one
inline constexpr std::uint32_t kept = 256;  // matches that a warp keeps until their place is known
inline constexpr std::uint32_t words = 32;  // words of 32 tasks whose runs are found at once

/// A run that is not empty, among the tasks of a warp. A task is the test of one candidate of a run.
struct alignas(8) TaskRun {
  std::uint32_t shift;  ///< number of a candidate less that of its task (modulo 2^32)
  std::uint32_t owner;  ///< lane of the item, plus 32 times the number of the run
};

/// Shared memory of a warp.
template <class Object, class Match>
struct MatchStage {
  Object object[32];
  TaskRun run[32 * runs_at_once];
  std::uint32_t starts[words];  ///< one bit for each task: whether a run starts there
  std::uint32_t before[words];  ///< number of runs that start before the word, less one
  Match match[kept];
};

/// Tests the candidates of the runs of 32 items, one item for each lane. Calls sink(hit, match), which the
/// whole warp enters. `mine` says whether the runs of this lane are to be tested, and `first_run` is the
/// number of the first of `run`.
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
    at = begin - done;  // large if the tasks belong to an earlier window
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
      // Each lane does two tasks at once, so that the loads of both are under way.
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

/// Does all tests of 32 items; returns the number of tests of this lane's item.
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
    std::uint32_t length = 0;  // runs do not share candidates, so that a lane has fewer than 2^32 tasks
#pragma unroll
    for (int u = 0; u < runs_at_once; ++u) {
      run[u] = here ? search.run(item, part, u) : Run{};
      length += run[u].end - run[u].begin;
    }
    tests += length;
    // All 32 lanes together have fewer than 2^32 tasks, too, unless one has over 2^26: then the lanes take
    // turns.
    const bool in_turns = __any_sync(all_lanes, length > (1u << 26));
    for (unsigned turn = 0; turn < (in_turns ? 32u : 1u); ++turn)
      do_tasks(search, part * runs_at_once, run, !in_turns || turn == lane, stage, sink);
  }
  return tests;
}

/// Writes matches in the order of the lanes, as far as there is room.
template <class Match>
struct MatchSink {
  Match* to;
  Word room;
  Word count = 0;
  // The state since begin(), for the tasks of one window.
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
  /// Does the same as on Host: calls reserve(n) before `out` is made to hold n matches. If `out` has too
  /// little room, the searches are done again.
  template <class Reserve, class... Search>
  MatchTotals find(Array<Match, Device>& out, const Reserve& reserve, const Search&... searches) {
    using detail::Word;
    constexpr std::int64_t count = sizeof...(Search);
    // The state holds the totals, the tickets, the numbers of tests and the tiles, in this order.
    constexpr std::int64_t head = count + 1 + count + detail::test_counters;
    const std::int64_t tiles = (tiles_of(searches) + ... + std::int64_t{0});
    state_.resize(head + tiles);
    for (;;) {
      detail::clear_bytes(state_.data(), static_cast<std::size_t>(state_.size()) * sizeof(Word));
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
    detail::require_launched(Search::label);
  }

  Array<detail::Word, Device> state_;
};

}  // namespace scree

#endif
