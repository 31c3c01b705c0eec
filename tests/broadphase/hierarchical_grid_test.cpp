// Tests of what the hierarchical grid promises beyond the right pairs: their order, that the scene may be
// written in any way, and the shape of the plan.
#include "broadphase/grid_plan.hpp"
#include "tests/broadphase/boxes.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <numeric>
#include <type_traits>

namespace scree {
namespace {

using namespace test;

template <class Space>
class HierarchicalGrid : public test::InSpace<Space> {};
TYPED_TEST_SUITE(HierarchicalGrid, test::Spaces, test::SpaceName);

template <class Space>
PairSet grid_pairs(const Boxes& boxes, int levels = 0) {
  return found<Space>({.method = BroadPhaseMethod::hierarchical_grid, .levels = levels}, boxes,
                      all_free(boxes));
}

/// Returns small and large boxes, dense and sparse, so that every search has work.
Boxes mixed_scene() {
  Boxes boxes = log_cloud(8000, 22, 0.05, 2);
  for (const Aabb& large : equal_cloud(5, 22, 9, 6)) boxes.push_back(large);
  boxes.push_back(ball(1e5, 0, 0, 1));
  return boxes;
}

TYPED_TEST(HierarchicalGrid, AgreesWithTheUniformGridAtSize) {
  const Boxes boxes = mixed_scene();
  const PairSet expected =
      sorted(found<TypeParam>({.method = BroadPhaseMethod::uniform_grid}, boxes, all_free(boxes)));
  for (int levels = 0; levels <= 8; ++levels) {
    EXPECT_TRUE(same_pairs(expected, sorted(grid_pairs<TypeParam>(boxes, levels)))) << levels;
  }
}

// Bricks have an order of their own. Only a GPU has them, and a forced number of levels excludes them.
TYPED_TEST(HierarchicalGrid, TheOrderIsThatOfTheHostWithOneThread) {
  const Boxes boxes = mixed_scene();
  for (const int levels : {0, 1, 4}) {
    if (levels == 0 && !std::is_same_v<TypeParam, Host>) continue;
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    const PairSet expected = tbb::task_arena(1).execute([&] { return grid_pairs<Host>(boxes, levels); });
    EXPECT_TRUE(same_pairs(expected, grid_pairs<TypeParam>(boxes, levels)));
    EXPECT_TRUE(same_pairs(expected, grid_pairs<TypeParam>(boxes, levels)));
  }
}

TYPED_TEST(HierarchicalGrid, TheOrderDoesNotDependOnThreadsOrHistory) {
  const Boxes boxes = mixed_scene();
  const auto used = make_broad_phase<TypeParam>({});
  const PairSet expected = found(*used, boxes, all_free(boxes));
  found(*used, equal_cloud(3000, 4, 0.1), all_free(Boxes(3000)));
  EXPECT_TRUE(same_pairs(expected, found(*used, boxes, all_free(boxes))));
  for (const int threads : {1, 3, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena(threads).execute(
        [&] { EXPECT_TRUE(same_pairs(expected, grid_pairs<TypeParam>(boxes))) << threads; });
  }
}

/// Returns the pairs of renumbered boxes by their old numbers: body k is the old body order[k].
PairSet renumbered(const PairSet& pairs, const std::vector<std::int32_t>& order) {
  PairSet old;
  for (const auto& [i, j] : pairs) {
    const auto a = order[static_cast<std::size_t>(i)];
    const auto b = order[static_cast<std::size_t>(j)];
    old.emplace_back(std::min(a, b), std::max(a, b));
  }
  return sorted(old);
}

TYPED_TEST(HierarchicalGrid, PermutationKeepsThePairs) {
  const Boxes boxes = mixed_scene();
  std::vector<std::int32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  Random random(21, 0);
  for (std::size_t k = order.size() - 1; k > 0; --k) {
    std::swap(order[k], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(k + 1))]);
  }
  Boxes permuted;
  for (const std::int32_t k : order) permuted.push_back(boxes[static_cast<std::size_t>(k)]);
  EXPECT_TRUE(
      same_pairs(sorted(grid_pairs<TypeParam>(boxes)), renumbered(grid_pairs<TypeParam>(permuted), order)));
}

TYPED_TEST(HierarchicalGrid, ReflectionScalingAndExchangeOfAxesKeepThePairs) {
  const Boxes boxes = mixed_scene();
  const PairSet expected = sorted(grid_pairs<TypeParam>(boxes));
  Boxes reflected, doubled, halved, turned;
  for (const Aabb& b : boxes) {
    reflected.push_back({{-b.hi[0], -b.hi[1], -b.hi[2]}, {-b.lo[0], -b.lo[1], -b.lo[2]}});
    doubled.push_back({{2 * b.lo[0], 2 * b.lo[1], 2 * b.lo[2]}, {2 * b.hi[0], 2 * b.hi[1], 2 * b.hi[2]}});
    halved.push_back({{b.lo[0] / 2, b.lo[1] / 2, b.lo[2] / 2}, {b.hi[0] / 2, b.hi[1] / 2, b.hi[2] / 2}});
    turned.push_back({{b.lo[1], b.lo[2], b.lo[0]}, {b.hi[1], b.hi[2], b.hi[0]}});
  }
  EXPECT_TRUE(same_pairs(expected, sorted(grid_pairs<TypeParam>(reflected))));
  EXPECT_TRUE(same_pairs(expected, sorted(grid_pairs<TypeParam>(doubled))));
  EXPECT_TRUE(same_pairs(expected, sorted(grid_pairs<TypeParam>(halved))));
  EXPECT_TRUE(same_pairs(expected, sorted(grid_pairs<TypeParam>(turned))));
}

TYPED_TEST(HierarchicalGrid, ShiftKeepsThePairs) {
  // Coordinates are multiples of 2^-10 within 2^13, so that shifts are exact.
  Boxes boxes;
  for (int k = 0; k < 5000; ++k) {
    Random random(22, static_cast<std::uint64_t>(k));
    Aabb one;
    for (int a = 0; a < 3; ++a) {
      one.lo[a] = static_cast<float>(std::floor(random.uniform(0, 20 * 1024)) / 1024);
      one.hi[a] = one.lo[a] + static_cast<float>(1 + static_cast<int>(random.uniform(0, 2048))) / 1024;
    }
    boxes.push_back(one);
  }
  const PairSet expected = sorted(grid_pairs<TypeParam>(boxes));
  for (const float shift : {1.0f, -20.0f, 1.0f / 1024, -4096.0f}) {
    Boxes shifted = boxes;
    for (Aabb& one : shifted) {
      for (int a = 0; a < 3; ++a) {
        one.lo[a] += shift;
        one.hi[a] += shift;
      }
    }
    EXPECT_TRUE(same_pairs(expected, sorted(grid_pairs<TypeParam>(shifted)))) << shift;
  }
}

// --- Work that must not blow up, counted in box tests so that no clock is needed

template <class Space>
std::int64_t tests_per_body(const Boxes& boxes) {
  const auto grid = make_broad_phase<Space>({});
  found(*grid, boxes, all_free(boxes));
  return grid->stats().candidates / static_cast<std::int64_t>(boxes.size());
}

TYPED_TEST(HierarchicalGrid, WorkStaysBounded) {
  constexpr int n = 20000;
  const Boxes plain = equal_cloud(n, 27.5, 0.5);
  EXPECT_LT(tests_per_body<TypeParam>(plain), 20);
  Boxes outlier = plain;
  outlier.push_back(ball(1e30, 1e30, -1e30, 1e23));
  EXPECT_LT(tests_per_body<TypeParam>(outlier), 30);
  Boxes giant = plain;
  giant.push_back(ball(0, 0, 0, 1e5));
  EXPECT_LT(tests_per_body<TypeParam>(giant), 30);
  EXPECT_LT(tests_per_body<TypeParam>(log_cloud(n, 20, 0.01, 1)), 60);
  EXPECT_LT(tests_per_body<TypeParam>(equal_cloud(n, 0.5, 1e-4)), 20);
  EXPECT_LT(tests_per_body<TypeParam>(equal_cloud(n, 1, 0)), 20);
  Boxes diagonal, clusters = plain;
  for (int k = 0; k < n; ++k) diagonal.push_back(ball(k, k, k, 0.5));
  for (const Aabb& b : plain)
    clusters.push_back({{b.lo[0] + 4e6f, b.lo[1], b.lo[2]}, {b.hi[0] + 4e6f, b.hi[1], b.hi[2]}});
  EXPECT_LT(tests_per_body<TypeParam>(diagonal), 20);
  EXPECT_LT(tests_per_body<TypeParam>(clusters), 40);
}

// --- The plan

GridPlan plan_of(const Boxes& boxes, int levels = 0) {
  Array<Aabb, Host> bounds;
  copy(bounds, boxes);
  const Census census = take_census<Host>(bounds.view());
  return plan_grid(census, count_sizes<Host>(bounds.view(), census), grid_costs<Host>, levels);
}

TEST(GridPlan, EqualSizesHaveOneLevelOfTheirOwnSize) {
  const GridPlan plan = plan_of(equal_cloud(1000, 10, 0.5));
  ASSERT_EQ(plan.levels.size(), 1u);
  EXPECT_NEAR(plan.levels[0].cell, 1.0, 1e-4);
  EXPECT_FALSE(plan.levels[0].hashed);
}

TEST(GridPlan, LevelsHoldEveryBodyOnceAndFitIt) {
  const Boxes boxes = mixed_scene();
  for (int forced = 0; forced <= 8; ++forced) {
    const GridPlan plan = plan_of(boxes, forced);
    if (forced > 0) {
      EXPECT_EQ(plan.levels.size(), static_cast<std::size_t>(std::min(forced, 7)));
    }
    std::vector<int> count(plan.levels.size());
    for (const Aabb& one : boxes)
      ++count[static_cast<std::size_t>(level_of_extent(plan.levels.data(), extent_of(one)))];
    std::uint32_t cells = 0;
    std::int32_t begin = 0;
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
      const GridLevel& level = plan.levels[l];
      EXPECT_EQ(level.begin, begin);
      EXPECT_EQ(level.end - level.begin, count[l]);
      EXPECT_EQ(level.base, cells);
      EXPECT_GT(level.cell, level.largest);
      EXPECT_TRUE(l == 0 || level.largest > plan.levels[l - 1].largest);
      begin = level.end;
      cells += level.cells();
    }
    EXPECT_EQ(plan.cells, cells);
    EXPECT_LT(cells, 8u * boxes.size() + 8u * 8192u);
  }
}

TEST(GridPlan, EachPairOfLevelsIsSearchedFromOneSide) {
  const GridPlan plan = plan_of(mixed_scene(), 5);
  std::vector<std::pair<int, int>> searched;
  for (const LevelPair& descent : plan.descents) searched.emplace_back(descent.to, descent.from);
  for (const LevelPair& ascent : plan.ascents) searched.emplace_back(ascent.from, ascent.to);
  std::sort(searched.begin(), searched.end());
  std::vector<std::pair<int, int>> all;
  for (int i = 0; i < 5; ++i) {
    for (int j = i + 1; j < 5; ++j) all.emplace_back(i, j);
  }
  EXPECT_EQ(searched, all);
}

TEST(GridPlan, ALoneGiantGetsItsOwnLevelAndSearchesDownward) {
  Boxes boxes = equal_cloud(5000, 18, 0.5);
  boxes.push_back(ball(0, 0, 0, 1000));
  const GridPlan plan = plan_of(boxes);
  ASSERT_EQ(plan.levels.size(), 2u);
  ASSERT_EQ(plan.descents.size(), 1u);
  EXPECT_EQ(plan.levels[1].end - plan.levels[1].begin, 1);
}

TEST(GridPlan, ASparseLevelGetsWiderCellsAndADenseTable) {
  const GridPlan natural = plan_of(equal_cloud(5000, 20, 0.5));
  EXPECT_FALSE(natural.levels[0].hashed);
  EXPECT_NEAR(natural.levels[0].cell, 1.0, 1e-3);
  const GridPlan sparse = plan_of(equal_cloud(5000, 38, 0.5));
  EXPECT_FALSE(sparse.levels[0].hashed);
  EXPECT_GT(sparse.levels[0].cell, 1.05);
  EXPECT_LE(sparse.levels[0].cell, 2);
  const GridPlan sparser = plan_of(equal_cloud(5000, 200, 0.5));
  EXPECT_TRUE(sparser.levels[0].hashed);
  EXPECT_NEAR(sparser.levels[0].cell, 1.0, 1e-3);
}

TEST(GridPlan, AnOutlierOnlyChangesTheTable) {
  Boxes boxes = equal_cloud(5000, 18, 0.5);
  boxes.push_back(ball(1e8, 0, 0, 0.5));
  const GridPlan plan = plan_of(boxes);
  EXPECT_TRUE(plan.levels[0].hashed);
  EXPECT_NEAR(plan.levels[0].cell, 1.0, 1e-3);
}

}  // namespace
}  // namespace scree
