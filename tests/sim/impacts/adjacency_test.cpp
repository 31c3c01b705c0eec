// Tests of the pairs of each body, against those that a loop over all pairs finds.
#include "sim/impacts/adjacency.hpp"

#include "core/rng.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace scree {
namespace {

template <class Space>
class AdjacencyTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(AdjacencyTest, test::Spaces, test::SpaceName);

template <class T, class Space>
Array<T, Space> to_space(const std::vector<T>& list) {
  Array<T, Space> array(std::ssize(list));
  copy_bytes<Space, Host>(array.data(), list.data(), list.size() * sizeof(T));
  return array;
}
template <class T, class Space>
std::vector<T> to_host(ConstView<T> list) {
  std::vector<T> on_host(static_cast<std::size_t>(list.size()));
  copy_bytes<Host, Space>(on_host.data(), list.data(), on_host.size() * sizeof(T));
  return on_host;
}

/// Body 0 is not free; bodies 1 and 2 have many pairs: they are candidates with all others.
TYPED_TEST(AdjacencyTest, OfRandomPairs) {
  constexpr std::int32_t bodies = 1000;
  std::vector<Mobility> mobility(bodies, Mobility::free);
  mobility[0] = Mobility::fixed;
  std::vector<Pair> pairs;
  for (std::int32_t body = 0; body < 3; ++body)
    for (std::int32_t k = body + 1; k < bodies; ++k) pairs.push_back({body, k});
  Random random(5, 0);
  for (std::int32_t k = 3; k + 20 < bodies; ++k)
    pairs.push_back({k, k + 1 + static_cast<std::int32_t>(random.uniform(0, 19))});
  const auto pairs_there = to_space<Pair, TypeParam>(pairs);
  const auto mobility_there = to_space<Mobility, TypeParam>(mobility);

  Adjacency<TypeParam> adjacency;
  EXPECT_TRUE(adjacency.view().is_empty());
  for (int time = 0; time < 2; ++time) {
    adjacency.build(pairs_there.view(), mobility_there.view());
    const AdjacencyView seen = adjacency.view();
    EXPECT_FALSE(seen.is_empty());
    const auto begin = to_host<std::int64_t, TypeParam>(seen.begin);
    const auto row = to_host<std::int32_t, TypeParam>(seen.row);
    ASSERT_EQ(begin.size(), static_cast<std::size_t>(bodies + 1));
    for (std::int32_t body = 0; body < bodies; ++body) {
      std::vector<std::int32_t> expected;
      for (std::size_t k = 0; k < pairs.size() && body > 0; ++k)
        if (pairs[k].i == body || pairs[k].j == body) expected.push_back(static_cast<std::int32_t>(k));
      std::vector<std::int32_t> got(row.begin() + begin[static_cast<std::size_t>(body)],
                                    row.begin() + begin[static_cast<std::size_t>(body) + 1]);
      std::ranges::sort(got);
      ASSERT_EQ(got, expected) << body;
    }
    EXPECT_EQ((to_host<std::int32_t, TypeParam>(seen.between_many)), std::vector{bodies - 1});
  }
  adjacency.clear();
  EXPECT_TRUE(adjacency.view().is_empty());
}

}  // namespace
}  // namespace scree
