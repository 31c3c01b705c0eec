// Tests of what bricks depend on: lattice numbers that never separate overlapping boxes, one owner for each
// pair, and plans that fit; and that Device uses bricks and finds the same pairs.
#include "broadphase/bounds.hpp"
#include "broadphase/brick_plan.hpp"
#include "core/space_tiles.hpp"
#include "tests/broadphase/boxes.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace scree {
namespace {

using namespace test;

/// Returns a lattice so coarse that many numbers are equal.
BrickLattice coarse_lattice() { return {{-3, -3, -3}, {9000, 7000, 5000}, {4, 3, 2}}; }

LatticeBox in_numbers(const BrickLattice& lattice, const Aabb& box) {
  LatticeBox numbers;
  for (int a = 0; a < 3; ++a) {
    numbers.lo[a] = lattice.number_of(box.lo[a], a);
    numbers.hi[a] = lattice.number_of(box.hi[a], a);
  }
  return numbers;
}

/// Returns the entries of a box in all bricks that it overlaps, with their bricks.
std::vector<std::pair<std::uint32_t, Entry>> entries_of(const BrickLattice& lattice, const Aabb& box) {
  const LatticeBox numbers = in_numbers(lattice, box);
  std::vector<std::pair<std::uint32_t, Entry>> entries;
  for (std::int32_t z = numbers.lo[2] >> brick_bits; z <= numbers.hi[2] >> brick_bits; ++z)
    for (std::int32_t y = numbers.lo[1] >> brick_bits; y <= numbers.hi[1] >> brick_bits; ++y)
      for (std::int32_t x = numbers.lo[0] >> brick_bits; x <= numbers.hi[0] >> brick_bits; ++x) {
        const std::int32_t base[3] = {x << brick_bits, y << brick_bits, z << brick_bits};
        entries.emplace_back(lattice.brick(x, y, z), entry_in(numbers, base, not_fixed));
      }
  return entries;
}

TEST(BrickLattice, NumbersAreMonotoneAndWithinTheLattice) {
  const BrickLattice lattice = coarse_lattice();
  for (int a = 0; a < 3; ++a) {
    std::vector<float> at = {-FLT_MAX, FLT_MAX, -0.0f, 0.0f, -3, next_above(-3.0f), next_below(-3.0f), 1e30f};
    for (int k = 0; k < 3000; ++k) {
      Random random(1, static_cast<std::uint64_t>(k));
      at.push_back(static_cast<float>(random.uniform(-10, 20)));
      at.push_back(next_above(at.back()));
    }
    std::ranges::sort(at);
    std::int32_t last = 0;
    for (const float x : at) {
      const std::int32_t number = lattice.number_of(x, a);
      ASSERT_GE(number, last);
      last = number;
    }
    EXPECT_EQ(last, lattice.bricks[a] * brick_points - 1);
    EXPECT_EQ(lattice.number_of(-FLT_MAX, a), 0);
  }
}

// The boxes are small and large, inside and outside of the lattice, and some are on the same numbers.
TEST(BrickLattice, EachPairHasOneOwnerWhichNeverErrs) {
  const BrickLattice lattice = coarse_lattice();
  int asked = 0;
  int owned = 0;
  for (int k = 0; k < 20000; ++k) {
    Random random(2, static_cast<std::uint64_t>(k));
    const auto any = [&] {
      const double size = std::pow(10.0, random.uniform(-4, 1));
      Aabb one;
      for (int a = 0; a < 3; ++a) {
        const double lo = std::round(random.uniform(-6, 6) * 4096) / 4096;
        one.lo[a] = static_cast<float>(lo);
        one.hi[a] = static_cast<float>(lo + size * random.uniform());
      }
      return one;
    };
    const Aabb first = any();
    Aabb second = any();
    for (int a = 0; a < 3 && random.uniform() < 0.5; ++a) {  // touching boxes, or nearly touching ones
      const float size = second.hi[a] - second.lo[a];
      second.lo[a] = random.uniform() < 0.5 ? first.hi[a] : next_above(first.hi[a]);
      second.hi[a] = second.lo[a] + size;
    }
    int owners = 0;
    for (const auto& [brick, a] : entries_of(lattice, first)) {
      for (const auto& [other_brick, b] : entries_of(lattice, second)) {
        if (brick != other_brick || !may_meet(facing(a), b)) continue;
        ++owners;
        EXPECT_TRUE(may_meet(facing(b), a));
        if (meets_clearly(facing(a), b)) {
          EXPECT_TRUE(overlap(first, second)) << k;
        } else {
          ++asked;
        }
      }
    }
    EXPECT_LE(owners, 1) << k;
    EXPECT_TRUE(owners == 1 || !overlap(first, second)) << k;
    owned += owners;
  }
  EXPECT_GT(owned, 1000);
  EXPECT_GT(asked, 100);
}

TEST(BrickLattice, TwoFixedObjectsAreNobodysPair) {
  const std::int32_t base[3] = {0, 0, 0};
  const LatticeBox box{{1, 1, 1}, {5, 5, 5}};
  const Entry fixed = entry_in(box, base, 7);
  const Entry free = entry_in(box, base, 8 | not_fixed);
  EXPECT_FALSE(may_meet(facing(fixed), fixed));
  EXPECT_TRUE(may_meet(facing(fixed), free));
  EXPECT_TRUE(may_meet(facing(free), fixed));
  EXPECT_EQ(free.body(), 8u);
}

// --- Plans

std::unique_ptr<BrickSample> sample_of(const Boxes& boxes) {
  auto sample = std::make_unique<BrickSample>();
  *sample = {};
  const auto n = static_cast<std::size_t>(BrickSample::looked_at(static_cast<std::int64_t>(boxes.size())));
  const auto looked_at = [&](std::size_t k) -> const Aabb& {
    return boxes[static_cast<std::size_t>(
        BrickSample::object(static_cast<std::int64_t>(k), static_cast<std::int64_t>(boxes.size())))];
  };
  std::ranges::fill(sample->lo, ~0u);
  for (std::size_t k = 0; k < n; ++k) {
    const Aabb& box = looked_at(k);
    for (int a = 0; a < 3; ++a) {
      const std::uint32_t centre = ordered_bits(static_cast<float>(centre_of(box, a)));
      sample->lo[a] = std::min(sample->lo[a], centre);
      sample->hi[a] = std::max(sample->hi[a], centre);
    }
    ++sample->sizes[size_class(extent_of(box))];
    sample->largest = std::max(sample->largest, std::bit_cast<std::uint32_t>(extent_of(box)));
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Aabb& box = looked_at(k);
    int place = 0;
    for (int a = 0; a < 3; ++a) {
      const double lo = from_ordered_bits(sample->lo[a]);
      const double length = from_ordered_bits(sample->hi[a]) - lo;
      const double share = length > 0 ? (centre_of(box, a) - lo) / length : 0;
      place = place * BrickSample::width +
              std::min(static_cast<int>(share * BrickSample::width), BrickSample::width - 1);
    }
    ++sample->places[place];
  }
  return sample;
}

std::optional<BrickPlan> plan_of(const Boxes& boxes) {
  return plan_bricks(*sample_of(boxes), static_cast<std::int64_t>(boxes.size()));
}

/// Returns the number of objects that overlap the fullest brick.
std::int64_t fullest(const BrickPlan& plan, const Boxes& boxes) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(plan.lattice.total()));
  for (const Aabb& box : boxes)
    for (const auto& [brick, entry] : entries_of(plan.lattice, box)) ++counts[brick];
  return *std::ranges::max_element(counts);
}

TEST(BrickPlan, OrderedBitsOrderFloats) {
  const float rising[] = {-FLT_MAX, -1, -1e-40f, 0, 1e-40f, 1, FLT_MAX};
  for (std::size_t k = 0; k + 1 < std::size(rising); ++k)
    EXPECT_LT(ordered_bits(rising[k]), ordered_bits(rising[k + 1]));
  for (const float x : rising) EXPECT_EQ(from_ordered_bits(ordered_bits(x)), x);
  EXPECT_EQ(ordered_bits(-0.0f), ordered_bits(0.0f));
}

TEST(BrickPlan, TheSampleIsSpreadOverAllObjects) {
  for (std::int64_t k = 0; k < 1000; ++k) EXPECT_EQ(BrickSample::object(k, 1000), k);
  constexpr std::int64_t count = body_mask;
  std::int64_t before = -1;
  for (std::int64_t k = 0; k < BrickSample::most; ++k) {
    EXPECT_LT(before, BrickSample::object(k, count));
    before = BrickSample::object(k, count);
  }
  EXPECT_LT(before, count);
}

TEST(BrickPlan, EqualSizesHaveAStencilAndBricksThatHoldThem) {
  const Boxes boxes = equal_cloud(100000, 47, 0.5);
  const auto plan = plan_of(boxes);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->method, BrickMethod::stencil);
  EXPECT_GT(plan->lattice.total(), 50);
  EXPECT_LE(fullest(*plan, boxes), std::int64_t{brick_objects});
  EXPECT_GT(fullest(*plan, boxes), brick_objects / 2);
  EXPECT_LE(plan->cells.total(), most_cells(plan->method));
}

TEST(BrickPlan, MixedSizesHaveRows) {
  const Boxes boxes = log_cloud(100000, 47, 0.01, 1);
  const auto plan = plan_of(boxes);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->method, BrickMethod::rows);
  EXPECT_LE(fullest(*plan, boxes), std::int64_t{brick_objects});
  EXPECT_LE(plan->cells.total(), most_cells(plan->method));
}

// This holds whether the sample contains the giant or not.
TEST(BrickPlan, OneGiantIsNoReasonForOtherBricks) {
  Boxes boxes = equal_cloud(400000, 74, 0.5);
  const auto plan = plan_of(boxes);
  ASSERT_TRUE(plan);
  boxes[static_cast<std::size_t>(BrickSample::object(1000, 400000))] = ball(0, 0, 0, 500);
  const auto with_giant = plan_of(boxes);
  ASSERT_TRUE(with_giant);
  EXPECT_EQ(with_giant->method, BrickMethod::stencil);
  // The stencil reaches as far as the class of the other sizes does, or at most an eighth farther.
  EXPECT_NEAR(static_cast<double>(with_giant->lattice.total()), static_cast<double>(plan->lattice.total()),
              0.15 * static_cast<double>(plan->lattice.total()));
}

TEST(BrickPlan, FewObjectsHaveOneBrick) {
  const auto plan = plan_of(equal_cloud(300, 8, 0.5));
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->lattice.total(), 1);
}

TEST(BrickPlan, CellsHoldTheirNumbers) {
  for (const Boxes& boxes : {equal_cloud(100000, 47, 0.5), log_cloud(100000, 47, 0.01, 1)}) {
    const auto plan = plan_of(boxes);
    ASSERT_TRUE(plan);
    for (int a = 0; a < 3; ++a) {
      for (std::int32_t number = 0; number <= last_local; ++number) {
        ASSERT_LT(plan->cells.cell_of(number, a), plan->cells.count[a]);
        if (plan->method == BrickMethod::stencil && a > 0 && number >= plan->reach[a]) {
          ASSERT_LE(plan->cells.cell_of(number, a), plan->cells.cell_of(number - plan->reach[a], a) + 1);
        }
      }
    }
  }
}

// Where all objects are on a line, the lattice has one row of bricks, whose points must not run out of
// numbers.
TEST(BrickPlan, ARowOfBricksIsNotTooLong) {
  Boxes line;
  for (int k = 0; k < 60000; ++k) line.push_back(ball(1e-3 * k, 0, 0, 1e-7));
  const auto sample = sample_of(line);
  for (const std::int64_t objects : {60000, 1000000, 10000000, 100000000, 200000000}) {
    const auto plan = plan_bricks(*sample, objects);
    if (plan) {
      EXPECT_LE(plan->lattice.bricks[0], most_bricks_along) << objects;
    }
    EXPECT_EQ(plan.has_value(), objects < 100000000) << objects;
  }
}

TEST(BrickPlan, FlatScenesHaveFullBricks) {
  Boxes plate = equal_cloud(100000, 400, 0.5);
  for (Aabb& box : plate) {
    box.lo[2] = -0.5;
    box.hi[2] = 0.5;
  }
  const auto plan = plan_of(plate);
  ASSERT_TRUE(plan);
  EXPECT_LE(fullest(*plan, plate), std::int64_t{brick_objects});
  EXPECT_GT(fullest(*plan, plate), brick_objects / 2);
}

TEST(BrickPlan, DeclinesWhatDoesNotSuit) {
  EXPECT_FALSE(plan_of(Boxes(5000, ball(3, -2, 1, 0.5))));  // all objects at one point
  EXPECT_FALSE(plan_of(equal_cloud(5000, 10, 0)));          // points without extent
  EXPECT_FALSE(plan_of(equal_cloud(20000, 2, 0.5)));        // all objects overlap one another
  Boxes cluster = equal_cloud(50000, 1, 0.001);
  for (const Aabb& far : equal_cloud(50000, 10000, 0.001, 5)) cluster.push_back(far);
  EXPECT_FALSE(plan_of(cluster));  // nearly all objects in one place, and the others anywhere
}

// --- On the GPU

template <class Space>
class Bricked : public test::InSpace<Space> {};
TYPED_TEST_SUITE(Bricked, test::Spaces, test::SpaceName);

template <class Space>
void expect_bricks(const Boxes& boxes, const char* what) {
  const auto grid = make_broad_phase<Space>({});
  const std::vector<Mobility> mobility = all_free(boxes);
  const PairSet first = found(*grid, boxes, mobility);
  if constexpr (!std::is_same_v<Space, Host>) {
    EXPECT_GT(grid->stats().bricks, 0) << what;
  }
  EXPECT_TRUE(same_pairs(first, found(*grid, boxes, mobility))) << what;
  // The grid is compared with the definition in find_test.cpp, where objects are few.
  EXPECT_TRUE(same_pairs(sorted(found<Space>({.levels = 4}, boxes, mobility)), sorted(first))) << what;
}

TYPED_TEST(Bricked, SuchScenesUseThemAndTwoRunsGiveTheSameBytes) {
  constexpr bool on_host = std::is_same_v<TypeParam, Host>;
  for (const int n : on_host ? std::vector{3000} : std::vector{3000, 100000, 400000}) {
    const double side = std::cbrt(n);
    expect_bricks<TypeParam>(equal_cloud(n, side, 0.5), "equal");
    expect_bricks<TypeParam>(log_cloud(n, side, 0.01, 1), "mixed");
    Boxes giants = equal_cloud(n, side, 0.5);
    for (const Aabb& giant : equal_cloud(20, side, side / 8, 5)) giants.push_back(giant);
    giants.push_back(ball(0, 0, 0, 10 * side));
    expect_bricks<TypeParam>(giants, "giants");
    Boxes plate;
    for (Aabb box : equal_cloud(n, 6 * side, 0.5)) {
      box.lo[2] = -0.5;
      box.hi[2] = 0.5;
      plate.push_back(box);
    }
    expect_bricks<TypeParam>(plate, "plate");
  }
}

template <class Space>
void expect_pairs_of_the_uniform_grid(const Boxes& boxes, bool in_bricks) {
  const auto grid = make_broad_phase<Space>({});
  const std::vector<Mobility> mobility = all_free(boxes);
  EXPECT_TRUE(same_pairs(sorted(found<Space>({.method = BroadPhaseMethod::uniform_grid}, boxes, mobility)),
                         sorted(found(*grid, boxes, mobility))));
  if constexpr (!std::is_same_v<Space, Host>) {
    EXPECT_EQ(grid->stats().bricks > 0, in_bricks);
  }
}

// There are more pairs than a warp keeps in its memory, so that it searches again.
TYPED_TEST(Bricked, ManyPairsToAnObject) {
  const Boxes boxes = equal_cloud(30000, 20, 0.5);
  ASSERT_TRUE(plan_of(boxes));
  expect_pairs_of_the_uniform_grid<TypeParam>(boxes, true);
}

/// A value whose bytes would pass for entries that meet all others, also those of their own kind: numbers of
/// 16 bits with all flags. A block of threads that adds up such values on Device leaves them behind in its
/// memory.
struct alignas(16) MeetsAll {
  static constexpr int entries = 12;
  Entry entry[entries];
  SCREE_HD MeetsAll() {
    for (Entry& each : entry) each = {{0x80008000u, 0x80008000u, 0x80008000u}, ~0u};
  }
  SCREE_HD friend MeetsAll operator+(const MeetsAll& a, const MeetsAll&) { return a; }
};
struct MakeMeetsAll {
  SCREE_HD MeetsAll operator()(std::int64_t) const { return {}; }
};

/// Returns a cloud that is dense below and sparse above, so that many bricks hold fewer than 64 objects.
Boxes thinning_cloud(int n, double side) {
  Boxes boxes = equal_cloud(n, side, 0.5);
  for (Aabb& box : boxes) {
    const double share = centre_of(box, 2) / side + 0.5;
    const auto z = static_cast<float>(side * std::pow(share, 8));
    box.lo[2] = z - 0.5f;
    box.hi[2] = z + 0.5f;
  }
  return boxes;
}

// Bricks with few entries read memory beyond them: once, scenes with two decades of radii found pairs with
// bodies that do not exist.
TYPED_TEST(Bricked, PairsDoNotHangOnWhatTheMemoryHeld) {
  const Boxes boxes = thinning_cloud(100000, 100);
  const auto plan = plan_of(boxes);
  ASSERT_TRUE(plan);
  std::vector<int> objects(static_cast<std::size_t>(plan->lattice.total()));
  for (const Aabb& box : boxes)
    for (const auto& [brick, entry] : entries_of(plan->lattice, box)) ++objects[brick];
  ASSERT_GT(std::ranges::count_if(objects, [](int count) { return count > 1 && count < 64; }), 50);
  parallel::sum_by_tiles<MeetsAll, TypeParam>("spoil", 1 << 20, MakeMeetsAll{});
  expect_pairs_of_the_uniform_grid<TypeParam>(boxes, true);
}

// The sample does not contain the crowd, and the grid does what bricks cannot.
TYPED_TEST(Bricked, AHiddenCrowdIsLeftToTheGrid) {
  Boxes boxes = equal_cloud(400000, 74, 0.5);
  std::vector<bool> seen(boxes.size());
  for (std::int64_t k = 0; k < BrickSample::most; ++k)
    seen[static_cast<std::size_t>(BrickSample::object(k, 400000))] = true;
  for (std::size_t k = 0; k < 20000; ++k)
    if (!seen[k]) boxes[k] = ball(1, 2, 3 + 1e-3 * static_cast<double>(k), 1e-3);
  const auto plan = plan_of(boxes);
  ASSERT_TRUE(plan);
  ASSERT_GT(fullest(*plan, boxes), std::int64_t{brick_objects});
  expect_pairs_of_the_uniform_grid<TypeParam>(boxes, false);
}

}  // namespace
}  // namespace scree
