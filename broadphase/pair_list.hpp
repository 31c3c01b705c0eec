// The list of pairs, as every broad phase makes it.
#pragma once

#include "broadphase/aabb.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

namespace scree {

/// Throws RunError, with both numbers, if that many pairs need more than `available` bytes.
inline void require_memory(std::int64_t pairs, std::size_t available) {
  const auto most = static_cast<std::int64_t>(available / sizeof(Pair));
  if (pairs <= most) return;
  throw RunError("the broad phase found " + std::to_string(pairs) + " pairs, which need " +
                 std::to_string(static_cast<std::uint64_t>(pairs) * sizeof(Pair)) + " bytes; " +
                 std::to_string(available) + " bytes are free. Do bodies overlap, or is a margin too wide?");
}

/// A corner of a body's box, with a tag that fills it up to 16 bytes.
struct alignas(16) Corner {
  float at[3];
  std::int32_t tag;  ///< lower corner: the body; upper corner: bits of which the two bodies of a pair share
                     ///< none, bit 0 if it is fixed
};

/// The data of a body that a test needs.
struct Boxed {
  Corner lo;
  Corner hi;

  SCREE_HD std::int32_t body() const { return lo.tag; }
  SCREE_HD Aabb box() const { return {{lo.at[0], lo.at[1], lo.at[2]}, {hi.at[0], hi.at[1], hi.at[2]}}; }
};

SCREE_HD inline Boxed boxed(const Aabb& box, std::int32_t body, Mobility mobility) {
  return {{{box.lo[0], box.lo[1], box.lo[2]}, body},
          {{box.hi[0], box.hi[1], box.hi[2]}, mobility == Mobility::fixed ? 1 : 0}};
}

SCREE_HD inline bool may_collide(const Boxed& a, const Boxed& b) {
  return overlap(a.box(), b.box()) & ((a.hi.tag & b.hi.tag) == 0);
}

/// A search in which each of the sorted objects is tested against one run of them, which item() finds.
struct RunSearch {
  using Object = Boxed;
  using Candidate = Boxed;
  struct Item {
    Boxed object;
    Run run;
  };

  std::int64_t items;
  const Boxed* sorted;
  int parts = 1;

  SCREE_HD Run run(const Item& item, int, int r) const { return r == 0 ? item.run : Run{}; }
  SCREE_HD Boxed candidate(std::uint32_t k) const { return sorted[k]; }
  SCREE_HD bool meets(const Boxed& a, int, const Boxed& b) const { return may_collide(a, b); }
  SCREE_HD Pair match(const Boxed& a, const Boxed& b) const { return pair_of(a.body(), b.body()); }
};

template <class Space>
class PairList {
 public:
  /// Returns the pairs that the searches find (core/space_matches.hpp), in an order that depends on the input
  /// alone. Throws RunError if there is not enough memory for the pairs, before any is allocated.
  template <class... Search>
  ConstView<Pair> collect(BroadPhaseStats& stats, const Search&... searches) {
    const MatchTotals totals = finder_.find(
        pairs_, [this](std::int64_t pairs) { require_room(pairs); }, searches...);
    stats.pairs = totals.matches;
    stats.candidates = totals.tests;
    return pairs_.view();
  }

  /// Returns room for the given number of pairs, for a method that counts and lists pairs by itself. Throws
  /// as collect() does.
  View<Pair> room_for(std::int64_t pairs) {
    require_room(pairs);
    pairs_.resize(pairs);
    return pairs_.view();
  }

 private:
  void require_room(std::int64_t pairs) const {
    if (pairs <= pairs_.capacity()) return;
    // The old pairs are freed before the new ones are allocated.
    require_memory(pairs, Space::free_memory() + static_cast<std::size_t>(pairs_.capacity()) * sizeof(Pair));
  }

  MatchFinder<Space, Pair> finder_;
  Array<Pair, Space> pairs_;
};

}  // namespace scree
