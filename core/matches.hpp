// Matches: what searches among runs of candidates find, in one list whose order depends on the input alone.
#pragma once

#include <cstdint>

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
/// and, for Host, may have
///   static constexpr int lanes                candidates that are tested at once: a power of two, 8 at most
///   std::uint32_t meets_block(const Object&, int run, std::uint32_t block)
///                                             bit l: for candidate lanes * block + l, which may not be there
///   void prefetch(std::uint32_t block)
///   Item item_after(const Item&)              the next one, where that is found faster
template <class Space, class Match>
class MatchFinder;

}  // namespace scree
