#include "sim/dynamics/coloring.hpp"

#include "core/rng.hpp"
#include "sim/dynamics/ball_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace scree {
namespace {

Coloring color(const std::vector<std::pair<int, int>>& pairs, const std::vector<Mobility>& mobility) {
  std::vector<ManifoldHeader> manifolds(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    manifolds[k].i = pairs[k].first;
    manifolds[k].j = pairs[k].second;
  }
  Coloring coloring;
  color_contacts(BallPairs(), {manifolds.data(), static_cast<std::int64_t>(manifolds.size())},
                 {mobility.data(), static_cast<std::int64_t>(mobility.size())}, coloring);
  return coloring;
}

/// Each contact once; no free body twice in a colour that is solved in parallel.
void expect_valid(const Coloring& coloring, const std::vector<std::pair<int, int>>& pairs,
                  const std::vector<Mobility>& mobility) {
  std::vector<std::int32_t> all(coloring.order);
  std::sort(all.begin(), all.end());
  for (std::size_t k = 0; k < pairs.size(); ++k) ASSERT_EQ(all[k], static_cast<std::int32_t>(k));
  for (std::int64_t c = 0; c < coloring.colors(); ++c) {
    if (coloring.last_is_serial && c + 1 == coloring.colors()) continue;
    std::set<int> seen;
    for (std::int64_t k = coloring.color_begin[c]; k < coloring.color_begin[c + 1]; ++k) {
      const auto& [i, j] = pairs[coloring.order[k]];
      for (const int body : {i, j}) {
        if (mobility[body] != Mobility::free) continue;
        ASSERT_TRUE(seen.insert(body).second) << "colour " << c;
      }
    }
  }
}

TEST(Coloring, RandomGraphs) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed, 0);
    std::vector<Mobility> mobility(200);
    for (Mobility& m : mobility) m = random.uniform() < 0.1 ? Mobility::fixed : Mobility::free;
    std::set<std::pair<int, int>> edges;
    while (edges.size() < 700) {
      const int i = static_cast<int>(random.uniform(0, 200));
      const int j = static_cast<int>(random.uniform(0, 200));
      if (i < j) edges.insert({i, j});
    }
    const std::vector<std::pair<int, int>> pairs(edges.begin(), edges.end());
    const Coloring coloring = color(pairs, mobility);
    expect_valid(coloring, pairs, mobility);
    EXPECT_LE(coloring.colors(), 30);
  }
}

TEST(Coloring, ABodyWithMoreContactsThanColoursSpillsIntoASerialRest) {
  std::vector<std::pair<int, int>> pairs;
  for (int k = 1; k <= 100; ++k) pairs.push_back({0, k});
  const std::vector<Mobility> mobility(101, Mobility::free);
  const Coloring coloring = color(pairs, mobility);
  expect_valid(coloring, pairs, mobility);
  EXPECT_TRUE(coloring.last_is_serial);
  EXPECT_EQ(coloring.colors(), 65);
}

TEST(Coloring, AFixedHubNeedsOneColour) {
  std::vector<std::pair<int, int>> pairs;
  for (int k = 1; k <= 100; ++k) pairs.push_back({0, k});
  std::vector<Mobility> mobility(101, Mobility::free);
  mobility[0] = Mobility::fixed;
  EXPECT_EQ(color(pairs, mobility).colors(), 1);
}

TEST(Coloring, NoContacts) { EXPECT_EQ(color({}, {}).colors(), 0); }

}  // namespace
}  // namespace scree
