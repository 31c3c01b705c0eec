// Matches on Host: threads search chunks of items at once, and put what they find in its place.
// For parallel libraries alone.
#pragma once

#include "core/array.hpp"
#include "core/matches.hpp"
#include "core/timing.hpp"

#include <tbb/concurrent_queue.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <deque>

namespace scree {

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

}  // namespace scree
