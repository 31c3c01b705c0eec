// Matches: the results of searches among runs of candidates, in one list whose order depends on the input
// alone.
#pragma once

#include <cstdint>

namespace scree {

/// A range of candidates, from `begin` to before `end`.
struct Run {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

struct MatchTotals {
  std::int64_t matches = 0;
  std::int64_t tests = 0;
};

inline constexpr int items_at_once = 32;
inline constexpr int runs_at_once = 5;  // runs in one part of an item's runs

/// Runs searches and lists their matches, one search after the other. Within a search, the items come in
/// blocks of items_at_once; within a block, one part of the items' runs follows the other; and within a part,
/// the order is item after item, run after run.
///
/// A Search names its work (`label`) and has
///   std::int64_t items; int parts;            number of items, of parts of an item's runs
///   Item item(std::int64_t i)                 with a member `object`: the data that a test needs
///   Run run(const Item&, int part, int r)     0 <= r < runs_at_once, many of them empty
///   Candidate candidate(std::uint32_t k)
///   bool meets(const Object&, int run, const Candidate&)    run: part * runs_at_once + r
///   Match match(const Object&, const Candidate&)
/// and, for Host, may have
///   static constexpr int lanes                candidates that are tested at once: a power of two, 8 at most
///   std::uint32_t meets_block(const Object&, int run, std::uint32_t block)
///                                             bit l is for candidate lanes * block + l, which may not exist
///   void prefetch(std::uint32_t block)
///   Item item_after(const Item&)              the next item, if it can be found faster from this one
template <class Space, class Match>
class MatchFinder;

}  // namespace scree
