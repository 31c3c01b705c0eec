// Count, scan, fill: how every broad phase turns searches into a list of pairs whose order depends on the
// input alone and whose length is known before memory is asked for.
#pragma once

#include "broadphase/broad_phase.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace scree {

/// Throws RunError, with both numbers, if so many pairs need more than `available` bytes.
inline void require_memory(std::int64_t pairs, std::size_t available) {
  const auto most = static_cast<std::int64_t>(available / sizeof(Pair));
  if (pairs <= most) return;
  throw RunError("the broad phase found " + std::to_string(pairs) + " pairs, which need " +
                 std::to_string(static_cast<std::uint64_t>(pairs) * sizeof(Pair)) + " bytes; " +
                 std::to_string(available) + " bytes are free. Do bodies overlap, or is a margin too wide?");
}

namespace detail {

struct CountHit {
  std::uint32_t hits = 0;
  SCREE_HD void operator()(Pair) { ++hits; }
};

struct WriteHit {
  Pair* next;
  SCREE_HD void operator()(Pair pair) { *next++ = pair; }
};

template <class Search>
struct CountItem {
  Search search;
  std::uint32_t* hits;
  std::uint32_t* tests;
  SCREE_HD void operator()(std::int64_t item) const {
    CountHit hit;
    tests[item] = search(item, hit);
    hits[item] = hit.hits;
  }
};

template <class Search>
struct FillItem {
  Search search;
  const std::int64_t* offsets;
  Pair* pairs;
  SCREE_HD void operator()(std::int64_t item) const {
    if (offsets[item] == offsets[item + 1]) return;
    WriteHit hit{pairs + offsets[item]};
    search(item, hit);
  }
};

}  // namespace detail

template <class Space>
class PairList {
 public:
  /// Runs the searches, one after the other in the list. A Search has `items`, the number of its work items;
  /// `count_label` and `fill_label`; and operator()(item, hit), which calls hit(pair) for each pair found, in
  /// the same order each time, and returns the number of box tests made.
  template <class... Search>
  ConstView<Pair> collect(BroadPhaseStats& stats, const Search&... searches) {
    const std::int64_t items = (searches.items + ...);
    hits_.resize(items);
    tests_.resize(items);
    std::int64_t first = 0;
    (count(searches, first), ...);
    stats.candidates = parallel::reduce<std::int64_t, Space>(
        "broadphase.traverse.candidates", items, parallel::detail::Widen<std::uint32_t>{tests_.data()},
        std::int64_t{0}, thrust::plus<std::int64_t>());
    stats.pairs = parallel::exclusive_scan<Space>("broadphase.traverse.scan", hits_, offsets_);
    reserve(stats.pairs);
    first = 0;
    (fill(searches, first), ...);
    return pairs_.view();
  }

 private:
  template <class Search>
  void count(const Search& search, std::int64_t& first) {
    parallel::for_each<Space>(Search::count_label, search.items,
                              detail::CountItem<Search>{search, hits_.data() + first, tests_.data() + first});
    first += search.items;
  }
  template <class Search>
  void fill(const Search& search, std::int64_t& first) {
    parallel::for_each<Space>(Search::fill_label, search.items,
                              detail::FillItem<Search>{search, offsets_.data() + first, pairs_.data()});
    first += search.items;
  }
  void reserve(std::int64_t pairs) {
    if (pairs > largest_) {
      // The old pairs are freed before the new ones are allocated.
      require_memory(pairs, Space::free_memory() + static_cast<std::size_t>(largest_) * sizeof(Pair));
      largest_ = pairs;
    }
    pairs_.resize(pairs);
  }

  Array<std::uint32_t, Space> hits_;
  Array<std::uint32_t, Space> tests_;
  Array<std::int64_t, Space> offsets_;
  Array<Pair, Space> pairs_;
  std::int64_t largest_ = 0;  ///< most pairs so far: for these there was memory
};

}  // namespace scree
