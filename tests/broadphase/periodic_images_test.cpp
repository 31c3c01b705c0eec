// Tests that every method finds the pairs of a periodic space through images: those of the definition, over
// all images.
#include "broadphase/periodic_images.hpp"

#include "tests/broadphase/boxes.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

using namespace test;

template <class Space>
class PeriodicImagesTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(PeriodicImagesTest, test::Spaces, test::SpaceName);

/// The unit of all places and sizes (m), so that moving by a period rounds nothing.
constexpr double unit = 1.0 / 1024;

double whole(double x) { return unit * std::round(x / unit); }

/// Returns boxes with their centres in the cell. Their half extents are from `least` to `largest` shares of
/// the period, or of 1 m along axes without a period.
Boxes boxes_in(const Period& period, int n, double least, double largest, std::uint64_t seed) {
  Boxes boxes;
  for (int i = 0; i < n; ++i) {
    Random random(seed, static_cast<std::uint64_t>(i));
    double at[3], half[3];
    for (int a = 0; a < 3; ++a) {
      const double side = period.is_along(a) ? period.length[a] : 1.0;
      at[a] = period.low[a] + whole(random.uniform(0, side));
      half[a] = whole(side * random.uniform(least, largest));
    }
    boxes.push_back(box(at[0], at[1], at[2], half[0], half[1], half[2]));
  }
  return boxes;
}

/// Returns the pairs of which some image of one box meets the other, by double arithmetic, which holds all
/// these numbers exactly.
PairSet by_definition_in(const Period& period, const Boxes& boxes, const std::vector<Mobility>& mobility) {
  const auto meet = [&](const Aabb& p, const Aabb& q) {
    for (int a = 0; a < 3; ++a) {
      bool meets = false;
      for (int shift = -2; shift <= 2; ++shift) {
        const double by = shift * period.length[a];
        meets = meets || (p.lo[a] <= q.hi[a] + by && q.lo[a] + by <= p.hi[a]);
      }
      if (!meets) return false;
    }
    return true;
  };
  PairSet pairs;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if ((mobility[i] != Mobility::fixed || mobility[j] != Mobility::fixed) && meet(boxes[i], boxes[j]))
        pairs.emplace_back(i, j);
  return pairs;
}

template <class Space>
PairSet found_in(const Period& period, const BroadPhaseSettings& settings, const Boxes& boxes,
                 const std::vector<Mobility>& mobility) {
  Array<Aabb, Space> bounds;
  Array<Mobility, Space> mobilities;
  copy(bounds, boxes);
  copy(mobilities, mobility);
  PeriodicImages<Space> images;
  images.take(std::as_const(bounds).view(), std::as_const(mobilities).view(), period);
  const auto broad_phase = make_broad_phase<Space>(settings);
  return set_of<Space>(images.pairs_of(broad_phase->find(images.bounds().view(), images.mobility().view())));
}

/// Expects every method to find the pairs of the definition; some of them must exist only through images.
template <class Space>
void expect_images(const Period& period, const Boxes& boxes, const std::vector<Mobility>& mobility) {
  const PairSet expected = by_definition_in(period, boxes, mobility);
  ASSERT_GT(expected.size(), by_definition(boxes, mobility).size());
  for (const auto& [name, settings] : every_method()) {
    const PairSet found = found_in<Space>(period, settings, boxes, mobility);
    EXPECT_TRUE(same_pairs(expected, sorted(found))) << name;
    EXPECT_EQ(found, found_in<Space>(period, settings, boxes, mobility)) << name << ": the order";
  }
}

/// Returns periods along one, two and three axes, cubic and not.
std::vector<Period> periods() {
  return {period_of(Vec3(-0.25, 0, 0), Vec3(1, 0, 0)),   period_of(Vec3(0, 3, 0), Vec3(0, 0.5, 0)),
          period_of(Vec3(0, 0, -7), Vec3(0, 0, 2)),      period_of(Vec3(1, 0, 0.5), Vec3(1, 0, 0.75)),
          period_of(Vec3(0, -0.5, 0), Vec3(0, 1, 0.25)), period_of(Vec3(-0.5, -0.5, -0.5), Vec3(1, 1, 1)),
          period_of(Vec3(100, 10, -1), Vec3(4, 0.5, 1))};
}

TYPED_TEST(PeriodicImagesTest, SmallBoxes) {
  for (const Period& period : periods()) {
    const Boxes boxes = boxes_in(period, 600, 0.02, 0.05, 1);
    expect_images<TypeParam>(period, boxes, all_free(boxes));
  }
}

// Half extents go up to a quarter of the period, the most that is allowed, so that many boxes reach through
// several ends.
TYPED_TEST(PeriodicImagesTest, LargeBoxesAmongSmallOnes) {
  for (const Period& period : periods()) {
    Boxes boxes = boxes_in(period, 150, 0.001, 0.01, 2);
    for (const Aabb& large : boxes_in(period, 20, 0.2, 0.249, 3)) boxes.push_back(large);
    std::swap(boxes[3], boxes.back());
    expect_images<TypeParam>(period, boxes, all_free(boxes));
  }
}

TYPED_TEST(PeriodicImagesTest, FixedBoxesHaveImagesAndNoPairsOfTheirOwn) {
  for (const Period& period : periods()) {
    const Boxes boxes = boxes_in(period, 300, 0.02, 0.1, 4);
    std::vector<Mobility> mobility = all_free(boxes);
    for (std::size_t k = 0; k < mobility.size(); k += 2) mobility[k] = Mobility::fixed;
    expect_images<TypeParam>(period, boxes, mobility);
  }
}

// The boxes are at the ends of the cell, or just touch through them: closed boxes meet.
TYPED_TEST(PeriodicImagesTest, BoxesThatTouchThroughTheEnds) {
  const Period period = period_of(Vec3(0, 0, 0), Vec3(1, 1, 1));
  const double r = 8 * unit;
  const Boxes boxes = {ball(0, 0, 0, r),      ball(1 - 2 * r, 0, 0, r),          ball(2 * r, 1 - 2 * r, 0, r),
                       ball(r, 0, 1 - r, r),  ball(1 - 2 * r - unit, 0.5, 0, r), ball(0, 0.5, 0, r),
                       ball(0.5, 0.5, 0.5, r)};
  const PairSet expected = {{0, 1}, {0, 2}, {0, 3}, {2, 3}};
  EXPECT_EQ(by_definition_in(period, boxes, all_free(boxes)), expected);
  for (const auto& [name, settings] : every_method())
    EXPECT_EQ(sorted(found_in<TypeParam>(period, settings, boxes, all_free(boxes))), expected) << name;
}

TYPED_TEST(PeriodicImagesTest, AbsentBoxesHaveNone) {
  const Period period = period_of(Vec3(0, 0, 0), Vec3(1, 1, 1));
  const Boxes boxes = {absent_bounds(), ball(0.01, 0.01, 0.01, 0.02), absent_bounds()};
  EXPECT_TRUE(found_in<TypeParam>(period, {}, boxes, all_free(boxes)).empty());
  EXPECT_TRUE(found_in<TypeParam>(period, {}, {}, {}).empty());
}

}  // namespace
}  // namespace scree
