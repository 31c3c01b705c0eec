// What must be refused before memory is asked for cannot be tried out at full size: the rule is tested alone.
#include "broadphase/pair_list.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

TEST(RequireMemory, LetsPassWhatFits) {
  EXPECT_NO_THROW(require_memory(0, 0));
  EXPECT_NO_THROW(require_memory(10, 80));
}

TEST(RequireMemory, RefusesTheRestWithTheNumbers) {
  EXPECT_THROW(require_memory(11, 87), RunError);
  try {
    require_memory(5'000'000'000, 30'000'000'000);
    FAIL();
  } catch (const RunError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("5000000000 pairs"), std::string::npos) << text;
    EXPECT_NE(text.find("40000000000 bytes"), std::string::npos) << text;
    EXPECT_NE(text.find("30000000000 bytes are free"), std::string::npos) << text;
  }
}

TEST(RequireMemory, DoesNotOverflow) {
  EXPECT_THROW(require_memory(std::int64_t{1} << 60, 1 << 20), RunError);
}

/// Item i is in i % 3 pairs (i, i + 1).
struct Toy {
  static constexpr const char* count_label = "toy.count";
  static constexpr const char* fill_label = "toy.fill";
  std::int64_t items;
  template <class Hit>
  SCREE_HD std::uint32_t operator()(std::int64_t i, Hit& hit) const {
    for (std::int64_t k = 0; k < i % 3; ++k)
      hit({static_cast<std::int32_t>(i), static_cast<std::int32_t>(i + 1)});
    return 5;
  }
};

TEST(PairList, PutsTheHitsOfAllSearchesInTheirOrder) {
  PairList<Host> list;
  BroadPhaseStats stats;
  // The second call has fewer pairs than the first and must not show the rest of them.
  for (const std::int64_t n : {1000, 10}) {
    const ConstView<Pair> pairs = list.collect(stats, Toy{n}, Toy{3});
    std::vector<std::int32_t> expected;
    for (const std::int64_t items : {n, std::int64_t{3}}) {
      for (std::int64_t i = 0; i < items; ++i)
        expected.insert(expected.end(), static_cast<std::size_t>(i % 3), static_cast<std::int32_t>(i));
    }
    ASSERT_EQ(pairs.size(), static_cast<std::int64_t>(expected.size()));
    for (std::int64_t k = 0; k < pairs.size(); ++k)
      ASSERT_EQ(pairs[k].i, expected[static_cast<std::size_t>(k)]);
    EXPECT_EQ(stats.pairs, pairs.size());
    EXPECT_EQ(stats.candidates, 5 * (n + 3));
  }
}

}  // namespace
}  // namespace scree
