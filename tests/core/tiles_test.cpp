// Tests of work in tiles, against loops over the same items.
#include "core/space_tiles.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace scree {
namespace {

template <class Space>
class TilesTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(TilesTest, test::Spaces, test::SpaceName);

struct EveryThird {
  using Record = std::int64_t;
  View<std::int64_t> out;
  bool is_end(std::int64_t) const { return false; }
  SCREE_HD bool find(std::int64_t item, Record& record) const {
    record = 10 * item;
    return item % 3 == 0;
  }
  SCREE_HD void store(std::int64_t to, std::int64_t item, const Record& record) const {
    out[to] = record + item;
  }
};

/// Finds every third item kind by kind; an item that is not found may have no kind, or have one.
struct EveryThirdByKind : EveryThird {
  static constexpr int kinds = 2;
  View<std::int64_t> kept;
  SCREE_HD int kind(std::int64_t item) const {
    if (item / parallel::tile == 3 || item % 3 == 1) return -1;
    return item % 5 == 0 ? 1 : 0;
  }
  SCREE_HD bool find(std::int64_t item, Record& record) const {
    return EveryThird::find(item, record) && item / parallel::tile != 3;
  }
  SCREE_HD void keep(std::int64_t item, const Record& record) const { kept[item] = record; }
  SCREE_HD void place(std::int64_t to, std::int64_t item) const { out[to] = kept[item] + item; }
};

template <class Space, class Find>
void expect_found_in_order() {
  constexpr std::int64_t tiles = 300;
  Array<std::int64_t, Space> out(tiles * parallel::tile);
  Array<std::int32_t, Space> counts(tiles);
  Array<std::int64_t, Space> kept(out.size());
  Find find{};
  find.out = out.view();
  if constexpr (requires { find.kept; }) find.kept = kept.view();
  parallel::compact_tiles<Space>("test", tiles, find, counts.data());
  const std::vector<std::int64_t> found = to_vector(out);
  const std::vector<std::int32_t> count = to_vector(counts);
  for (std::int64_t t = 0; t < tiles; ++t) {
    std::vector<std::int64_t> expected;
    for (std::int64_t item = t * parallel::tile; item < (t + 1) * parallel::tile; ++item)
      if (std::int64_t record; find.find(item, record)) expected.push_back(record + item);
    ASSERT_EQ(count[static_cast<std::size_t>(t)], static_cast<std::int32_t>(expected.size()));
    const auto first = found.begin() + t * parallel::tile;
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), first)) << t;
  }
}

TYPED_TEST(TilesTest, WhatIsFoundIsAtTheFrontOfItsTileInOrder) {
  expect_found_in_order<TypeParam, EveryThird>();
}

TYPED_TEST(TilesTest, WhatIsFoundByKindIsInTheSameOrder) {
  expect_found_in_order<TypeParam, EveryThirdByKind>();
}

struct CountVisits {
  View<std::int32_t> visits;
  SCREE_HD void operator()(std::int64_t t, std::int32_t k) const { ++visits[t * parallel::tile + k]; }
};

TYPED_TEST(TilesTest, WhatIsFoundIsVisitedOnce) {
  const std::vector<std::int32_t> found{0, 1, 7, parallel::tile, 0, 200};
  Array<std::int32_t, TypeParam> counts, visits(std::ssize(found) * parallel::tile);
  copy(counts, found);
  parallel::fill("test", visits, 0);
  parallel::for_each_found<TypeParam>("test", counts.size(), counts.data(), CountVisits{visits.view()});
  parallel::for_each_found<TypeParam>("test", 0, counts.data(), CountVisits{visits.view()});
  const std::vector<std::int32_t> seen = to_vector(visits);
  for (std::size_t k = 0; k < seen.size(); ++k)
    EXPECT_EQ(seen[k], static_cast<std::int32_t>(k % parallel::tile) < found[k / parallel::tile] ? 1 : 0)
        << k;
}

struct Number {
  double value = 0;
  SCREE_HD friend Number operator+(const Number& a, const Number& b) { return {a.value + b.value}; }
};
struct Item {
  SCREE_HD Number operator()(std::int64_t i) const { return {static_cast<double>(i % 1000)}; }
};

TYPED_TEST(TilesTest, SumsOfAnyLengthStayInTheSpace) {
  for (const std::int64_t n : {0, 1, 255, 256, 257, 65536, 65537, 1000000}) {
    Array<Number, TypeParam> scratch, sum(1);
    parallel::sum_into<Number, TypeParam>("test", n, Item{}, scratch, sum.data());
    double expected = 0;
    for (std::int64_t i = 0; i < n; ++i) expected += static_cast<double>(i % 1000);
    EXPECT_EQ(to_vector(sum)[0].value, expected) << n;
  }
}

}  // namespace
}  // namespace scree
