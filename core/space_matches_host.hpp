// Matches on Host: threads search chunks of items concurrently, and put the matches of each in their place.
// For parallel sources alone.
#pragma once

#include "core/array.hpp"
#include "core/matches.hpp"
#include "core/thread_pool.hpp"
#include "core/timing.hpp"

#include <tbb/concurrent_queue.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <deque>
#include <new>
#include <utility>

namespace scree {

namespace detail {

/// The matches of some items: they are written as far as there is room, and all are counted.
template <class Match>
struct FoundMatches {
  Match* to;
  std::int64_t room;
  std::int64_t count = 0;
  std::int64_t tests = 0;
};

/// Returns the number of candidates that a search tests at once.
template <class Search>
constexpr std::uint32_t lanes_of() {
  if constexpr (requires { Search::lanes; }) {
    return Search::lanes;
  } else {
    return 1;
  }
}

/// The tests of a block of items, in order. Each task is a block of candidates that are tested at once, with
/// its item and run. Runs have few candidates, and any number: the end of a loop over each would be
/// mispredicted, which costs a processor as much as several tests. Therefore tasks are written down `stride`
/// at a time, which most runs do not exceed, and then tested in a loop without branches, whose result is a
/// bit for each candidate.
template <class Search>
class HostTasks {
 public:
  explicit HostTasks(const Search& search) : search_(search) {}

  /// Searches for the items from `first` to before `end`, items_at_once at most.
  template <class Match>
  void search(std::int64_t first, std::int64_t end, FoundMatches<Match>& found) {
    const auto items = static_cast<std::uint32_t>(end - first);
    // Items are constructed in place, since they can be large.
    new (&item_[0]) Item(search_.item(first));
    for (std::uint32_t i = 1; i < items; ++i) new (&item_[i]) Item(item_after(item_[i - 1], first + i));
    for (int part = 0; part < search_.parts; ++part) {
      for (std::uint32_t i = 0; i < items; ++i) find_runs(item_[i], part, run_[i]);
      write_down(items, static_cast<std::uint32_t>(part) * runs_at_once, found);
    }
    test(count_, found);
    count_ = 0;
  }

 private:
  static constexpr std::uint32_t lanes = lanes_of<Search>();
  static constexpr std::uint32_t stride = lanes > 1 ? 2 : 8;
  static constexpr std::uint32_t most = 1024;
  static constexpr std::uint32_t in_word = 64 / lanes;  // tasks whose bits fit in a word

  using Item = typename Search::Item;

  /// Candidate lanes * block and those that follow it, if `those` has a bit for them.
  struct Task {
    std::uint32_t block;
    std::uint16_t owner;  ///< number of the item, plus items_at_once times that of the run
    std::uint16_t those;
  };

  Item item_after(const Item& before, std::int64_t i) const {
    if constexpr (requires { search_.item_after(before); }) {
      return search_.item_after(before);
    } else {
      return search_.item(i);
    }
  }

  /// Finds the runs of a part. Each call has its run's number as a constant, so that the compiler shares
  /// their common work.
  void find_runs(const Item& item, int part, Run (&to)[runs_at_once]) const {
    [&]<int... r>(std::integer_sequence<int, r...>) { ((to[r] = search_.run(item, part, r)), ...); }
    (std::make_integer_sequence<int, runs_at_once>());
  }

  /// Writes down the tasks of one part of the items' runs; `first_run` is the number of the first run in it.
  template <class Match>
  void write_down(std::uint32_t items, std::uint32_t first_run, FoundMatches<Match>& found) {
    std::int64_t tests = 0;
    std::uint32_t count = count_;
    for (std::uint32_t i = 0; i < items; ++i) {
      auto owner = static_cast<std::uint16_t>(first_run * items_at_once + i);
      for (const Run run : run_[i]) {
        const std::uint32_t length = run.end - run.begin;
        tests += length;
        std::uint32_t block = run.begin / lanes;
        std::uint32_t before = run.begin % lanes;
        std::uint32_t left = length > 0 ? before + length : 0;
        for (;;) {
          const std::uint32_t those = ((1u << std::min(left, stride * lanes)) - 1) >> before << before;
          for (std::uint32_t j = 0; j < stride; ++j)
            task_[count + j] = {block + j, owner,
                                static_cast<std::uint16_t>(those >> (j * lanes) & ((1u << lanes) - 1))};
          count += std::min((left + lanes - 1) / lanes, stride);
          if (count > most - stride) {
            test(count, found);
            count = 0;
          }
          if constexpr (lanes > 1) search_.prefetch(block);
          if (left <= stride * lanes) break;
          block += stride;
          left -= stride * lanes;
          before = 0;
        }
        owner += items_at_once;
      }
    }
    count_ = count;
    found.tests += tests;
  }

  /// Does all tasks that are written down.
  template <class Match>
  [[gnu::noinline]] void test(std::uint32_t count, FoundMatches<Match>& found) {
    for (std::uint32_t first = 0; first < count; first += in_word) {
      std::uint64_t hits = 0;
      const std::uint32_t end = std::min(count - first, in_word);
      for (std::uint32_t t = 0; t < end; ++t) hits |= std::uint64_t{meeting(task_[first + t])} << (t * lanes);
      for (; hits != 0; hits &= hits - 1) {
        const auto bit = static_cast<std::uint32_t>(std::countr_zero(hits));
        const Task& task = task_[first + bit / lanes];
        if (found.count < found.room)
          found.to[found.count] =
              search_.match(object(task), search_.candidate(task.block * lanes + bit % lanes));
        ++found.count;
      }
    }
  }

  /// Returns a bit for each candidate of the task: whether it meets the object.
  std::uint32_t meeting(const Task& task) const {
    const int run = task.owner / items_at_once;
    if constexpr (lanes > 1) {
      return search_.meets_block(object(task), run, task.block) & task.those;
    } else {
      return search_.meets(object(task), run, search_.candidate(task.block)) ? 1 : 0;
    }
  }

  const auto& object(const Task& task) const { return item_[task.owner % items_at_once].object; }

  const Search& search_;
  Item item_[items_at_once];
  Run run_[items_at_once][runs_at_once];
  std::uint32_t count_ = 0;
  Task task_[most];
};

}  // namespace detail

template <class Match>
class MatchFinder<Host, Match> {
 public:
  /// Lists the matches of the searches in `out`. Calls reserve(n) before `out` is made to hold n matches, and
  /// allocates nothing if that throws. If `out` has too little room, the searches are done again.
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
  static constexpr std::int64_t kept = 32 * chunk_items;  // matches that a chunk keeps until placed

  /// Items that one thread searches.
  struct Chunk {
    std::int64_t first;
    Array<Match, Host> matches;
    detail::FoundMatches<Match> found;
    std::int64_t place;  ///< place of its first match in the list
  };

  template <class Search>
  void run(const Search& search, View<Match> out, MatchTotals& totals) {
    const timing::Call<Host> call(Search::label);
    if (search.items > chunk_items) return run_chunks(search, out, totals);
    detail::FoundMatches<Match> found{};
    if (totals.matches < out.size()) found = {out.data() + totals.matches, out.size() - totals.matches};
    search_chunk(search, 0, found);  // on this thread: waking another would take longer
    totals.matches += found.count;
    totals.tests += found.tests;
  }

  /// Searches chunks concurrently, assigns their places in order, and copies them there concurrently. A chunk
  /// with more than `kept` matches is searched again.
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
      while (!idle.try_pop(chunk)) continue;  // one is idle: no more are under way than there are
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
    detail::ThreadPool::get().release_workers();
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

  std::deque<Chunk> chunks_;  // a deque, since chunks must not move in memory
};

}  // namespace scree
