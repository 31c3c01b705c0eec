// Tests of what the comparators promise beyond the right pairs: their order, and the work that they do.
#include "core/error.hpp"
#include "tests/broadphase/boxes.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace scree {
namespace {

using namespace test;

template <class Space>
class Comparators : public test::InSpace<Space> {};
TYPED_TEST_SUITE(Comparators, test::Spaces, test::SpaceName);

constexpr BroadPhaseMethod comparators[] = {BroadPhaseMethod::alternative_grid,
                                            BroadPhaseMethod::uniform_grid, BroadPhaseMethod::sweep_and_prune,
                                            BroadPhaseMethod::lbvh, BroadPhaseMethod::brute_force};

Boxes mixed_scene() {
  Boxes boxes = log_cloud(3000, 16, 0.05, 2);
  for (const Aabb& same : Boxes(300, ball(1, 2, 3, 0.2))) boxes.push_back(same);
  boxes.push_back(ball(1e5, 0, 0, 1));
  return boxes;
}

std::vector<Mobility> every_third_fixed(const Boxes& boxes) {
  std::vector<Mobility> mobility = all_free(boxes);
  for (std::size_t k = 0; k < mobility.size(); k += 3) mobility[k] = Mobility::fixed;
  return mobility;
}

TYPED_TEST(Comparators, TheOrderIsThatOfTheHostWithOneThread) {
  const Boxes boxes = mixed_scene();
  const std::vector<Mobility> mobility = every_third_fixed(boxes);
  for (const BroadPhaseMethod method : comparators) {
    const auto on_host = [&](int threads) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
      return tbb::task_arena(threads).execute(
          [&] { return found<Host>({.method = method}, boxes, mobility); });
    };
    const PairSet expected = on_host(1);
    EXPECT_TRUE(same_pairs(expected, on_host(8)));
    const auto used = make_broad_phase<TypeParam>({.method = method});
    EXPECT_TRUE(same_pairs(expected, found(*used, boxes, mobility)));
    found(*used, equal_cloud(1000, 4, 0.1), all_free(Boxes(1000)));
    EXPECT_TRUE(same_pairs(expected, found(*used, boxes, mobility)));
  }
}

template <class Space>
std::int64_t tests_per_body(BroadPhaseMethod method, const Boxes& boxes) {
  const auto broad_phase = make_broad_phase<Space>({.method = method});
  found(*broad_phase, boxes, all_free(boxes));
  return broad_phase->stats().candidates / static_cast<std::int64_t>(boxes.size());
}

TYPED_TEST(Comparators, TheSweepGoesAlongTheLine) {
  for (int axis = 0; axis < 3; ++axis) {
    Boxes boxes;
    for (int k = -5000; k < 5000; ++k)
      boxes.push_back(ball(axis == 0 ? k : 7, axis == 1 ? k : 7, axis == 2 ? k : 7, 0.6));
    EXPECT_LE(tests_per_body<TypeParam>(BroadPhaseMethod::sweep_and_prune, boxes), 2);
    // A single outlier does not turn the sweep either.
    boxes.push_back(ball(axis == 0 ? 7 : 1e7, axis == 0 ? 1e7 : 7, 7, 1));
    EXPECT_LE(tests_per_body<TypeParam>(BroadPhaseMethod::sweep_and_prune, boxes), 2);
  }
}

// Each pair may be in up to eight cells, but small objects are tested against each other only in the cells of
// their own level.
TYPED_TEST(Comparators, TheAlternativeGridTestsFewBoxes) {
  constexpr int n = 20000;
  const auto tests = [](const Boxes& boxes) {
    return tests_per_body<TypeParam>(BroadPhaseMethod::alternative_grid, boxes);
  };
  const Boxes plain = equal_cloud(n, 27.5, 0.5);
  EXPECT_LT(tests(plain), 35);
  Boxes outlier = plain;
  outlier.push_back(ball(1e30, 1e30, -1e30, 1e23));
  EXPECT_LT(tests(outlier), 45);
  Boxes giant = plain;
  giant.push_back(ball(0, 0, 0, 1e5));
  EXPECT_LT(tests(giant), 45);
  // Cells that are 2^19 apart have one key.
  Boxes clusters = plain;
  for (const Aabb& b : plain)
    clusters.push_back({{b.lo[0] + 524296, b.lo[1], b.lo[2]}, {b.hi[0] + 524296, b.hi[1], b.hi[2]}});
  EXPECT_LT(tests(clusters), 70);
}

// --- The hierarchy

TYPED_TEST(Comparators, TheHierarchyTestsFewNodes) {
  constexpr int n = 20000;
  const auto tests = [](const Boxes& boxes) {
    return tests_per_body<TypeParam>(BroadPhaseMethod::lbvh, boxes);
  };
  const Boxes plain = equal_cloud(n, 27.5, 0.5);
  EXPECT_LT(tests(plain), 45);
  Boxes outlier = plain;
  outlier.push_back(ball(1e30, 1e30, -1e30, 1e23));
  EXPECT_LT(tests(outlier), 45);
  Boxes giant = plain;
  giant.push_back(ball(0, 0, 0, 1e5));
  EXPECT_LT(tests(giant), 75);
  Boxes diagonal, clusters = plain;
  for (int k = 0; k < n; ++k) diagonal.push_back(ball(k, k, k, 0.5));
  for (const Aabb& b : plain)
    clusters.push_back({{b.lo[0] + 4e6f, b.lo[1], b.lo[2]}, {b.hi[0] + 4e6f, b.hi[1], b.hi[2]}});
  EXPECT_LT(tests(diagonal), 30);
  EXPECT_LT(tests(clusters), 60);
  EXPECT_LT(tests(log_cloud(n, 20, 0.01, 1)), 60);
  EXPECT_LT(tests(Boxes(2000, ball(1, 2, 3, 0.5))), 20);
}

// Along one path there is one split for each bit of the codes, and below it are leaves with equal codes.
TYPED_TEST(Comparators, ADeepHierarchy) {
  Boxes boxes;
  for (int power = 0; power < 40; ++power) {
    const double x = std::ldexp(1.0, -power);
    for (int axis = 0; axis < 3; ++axis)
      boxes.push_back(ball(axis == 0 ? x : 0, axis == 1 ? x : 0, axis == 2 ? x : 0, 0.01));
  }
  for (int k = 0; k < 300; ++k) boxes.push_back(ball(0, 0, 0, 1e-4 * (k % 30)));
  expect_definition<TypeParam>(boxes);
}

// A million bodies at one point have 499,999,500,000 pairs, which take 4 TB. They are counted by nodes, since
// tests of single pairs would take an hour.
TYPED_TEST(Comparators, TheHierarchyRefusesMorePairsThanThereIsMemoryFor) {
  const Boxes boxes(1000000, ball(3, -2, 1, 0.5));
  try {
    found<TypeParam>({.method = BroadPhaseMethod::lbvh}, boxes, all_free(boxes));
    FAIL();
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("499999500000 pairs"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace scree
