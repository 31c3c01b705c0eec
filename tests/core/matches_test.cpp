// Tests of the matches that searches find, in their order, against serial loops: with empty runs, runs of
// thousands of candidates, items that find more than a warp keeps, and too little room.
#include "core/parallel.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace scree {
namespace {

template <class Space>
class Matches : public test::InSpace<Space> {};
TYPED_TEST_SUITE(Matches, test::Spaces, test::SpaceName);

struct Match {
  std::int64_t item;
  std::uint32_t candidate;
  friend bool operator==(const Match&, const Match&) = default;
};

/// A toy search: the candidates of run r of item i depend on both in no simple way, and every `keeps`-th of
/// them matches.
struct Toy {
  static constexpr const char* label = "toy";
  using Candidate = std::uint32_t;
  struct Object {
    std::int64_t item;
  };
  struct Item {
    Object object;
  };

  std::int64_t items;
  int parts;
  std::uint32_t longest;
  std::uint32_t keeps;

  SCREE_HD Item item(std::int64_t i) const { return {{i}}; }
  SCREE_HD Run run(const Item& item, int part, int r) const {
    const auto i = static_cast<std::uint32_t>(item.object.item);
    const std::uint32_t mix =
        (i * 2654435761u) ^ (static_cast<std::uint32_t>(part * runs_at_once + r) * 40503u);
    const std::uint32_t length = mix % 3 == 0 ? 0 : mix / 3 % longest;
    return {mix % 1000, mix % 1000 + length};
  }
  SCREE_HD Candidate candidate(std::uint32_t k) const { return k; }
  SCREE_HD bool meets(const Object& o, int r, Candidate k) const {
    return (static_cast<std::uint32_t>(o.item) + static_cast<std::uint32_t>(r) + k) % keeps == 0;
  }
  SCREE_HD Match match(const Object& o, Candidate k) const { return {o.item, k}; }
};

/// A toy search that tests four candidates at once, on Host.
struct ToyOfFour : Toy {
  static constexpr int lanes = 4;

  std::uint32_t meets_block(const Object& o, int r, std::uint32_t block) const {
    std::uint32_t bits = 0;
    for (std::uint32_t l = 0; l < 4; ++l) bits |= meets(o, r, 4 * block + l) ? 1u << l : 0;
    return bits;
  }
  void prefetch(std::uint32_t) const {}
  Item item_after(const Item& before) const { return item(before.object.item + 1); }
};

void append(const Toy& toy, std::vector<Match>& found, std::int64_t& tests) {
  for (std::int64_t block = 0; block < toy.items; block += items_at_once)
    for (int part = 0; part < toy.parts; ++part)
      for (std::int64_t i = block; i < std::min(block + items_at_once, toy.items); ++i)
        for (int r = 0; r < runs_at_once; ++r) {
          const auto item = toy.item(i);
          const Run run = toy.run(item, part, r);
          tests += run.end - run.begin;
          for (std::uint32_t k = run.begin; k < run.end; ++k)
            if (toy.meets(item.object, part * runs_at_once + r, k))
              found.push_back(toy.match(item.object, k));
        }
}

template <class A, class Space>
void expect_found(const A& a, const Toy& b, MatchFinder<Space, Match>& finder, Array<Match, Space>& out) {
  std::vector<Match> expected;
  std::int64_t tests = 0;
  append(a, expected, tests);
  append(b, expected, tests);
  const MatchTotals totals = finder.find(
      out, [](std::int64_t) {}, a, b);
  EXPECT_EQ(totals.matches, static_cast<std::int64_t>(expected.size()));
  EXPECT_EQ(totals.tests, tests);
  EXPECT_TRUE(to_vector(out) == expected)
      << a.items << " items, " << a.parts << " parts, longest " << a.longest;
}

TYPED_TEST(Matches, AreThoseOfTheLoops) {
  MatchFinder<TypeParam, Match> finder;
  Array<Match, TypeParam> out;
  for (const std::int64_t n : {0, 1, 31, 32, 33, 127, 129, 5000})
    for (const int parts : {1, 2, 4})
      for (const std::uint32_t longest : {2u, 20u, 3000u}) {
        expect_found(Toy{n, parts, longest, 3}, {n / 2, 2, 50, 1}, finder, out);
        expect_found(ToyOfFour{{n, parts, longest, 3}}, {n / 2, 2, 50, 1}, finder, out);
        if (n > 0 && longest > 20)
          expect_found(Toy{n / 16 + 1, parts, longest, 1}, {0, 1, 1, 1}, finder, out);
      }
}

TYPED_TEST(Matches, AreRefusedBeforeThereIsRoom) {
  MatchFinder<TypeParam, Match> finder;
  Array<Match, TypeParam> out;
  const Toy toy{1000, 5, 100, 2};
  EXPECT_THROW(finder.find(
                   out,
                   [](std::int64_t n) {
                     if (n > 10) throw 1;
                   },
                   toy),
               int);
  EXPECT_EQ(out.capacity(), 0);
}

}  // namespace
}  // namespace scree
