// Tests of the scale of the centres and of their Z-order: it keeps the order, and is as fine as stated, even
// where there are outliers.
#include "broadphase/centre_scale.hpp"

#include "tests/broadphase/boxes.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

using namespace test;

CentreScale scale_of(const Boxes& boxes) {
  Array<Aabb, Host> bounds;
  copy(bounds, boxes);
  return CentreScale(take_census<Host>(bounds.view()));
}

TEST(CentreScale, KeepsTheOrderOfCoordinates) {
  for (const double far : {0.0, 1.0, 1e3, 1e30, 3e38}) {
    Boxes boxes = equal_cloud(500, 10, 0);
    boxes.push_back(ball(-far, far, 0, 0));
    const CentreScale scale = scale_of(boxes);
    std::uint32_t before = 0;
    for (const double sign : {-1.0, 1.0}) {
      for (double distance = 1e-12; distance < 1e39; distance *= 1.003) {
        const std::uint32_t number = scale.number(sign * (sign < 0 ? 1e27 / distance : distance));
        ASSERT_LT(number, 1u << CentreScale::bits);
        ASSERT_GE(number, before);
        before = number;
      }
    }
  }
}

TEST(CentreScale, IsFineAndEvenAmongTheMany) {
  EXPECT_GT(scale_of(equal_cloud(500, 10, 0)).number(1e-4), scale_of(equal_cloud(500, 10, 0)).number(0));
  Boxes boxes = equal_cloud(500, 10, 0);
  boxes.push_back(ball(1e30, 0, 0, 0));
  const CentreScale scale = scale_of(boxes);
  const double step = 10.0 / 2048;
  for (double x = -5; x < 5 - step; x += step) EXPECT_GT(scale.number(x + step), scale.number(x)) << x;
}

TEST(CentreScale, TakesWhatLiesAtOnePoint) {
  for (const Boxes& boxes : {Boxes(), Boxes(3, ball(0, 0, 0, 0)), Boxes(3, ball(3e38, 0, -3e38, 0))}) {
    const CentreScale scale = scale_of(boxes);
    EXPECT_LT(scale.number(-1), scale.number(-0.0) + 1);
    EXPECT_LE(scale.number(0), scale.number(3e38));
  }
}

TEST(MortonCode, InterleavesTheBitsOfTheAxes) {
  const Boxes boxes = equal_cloud(1000, 10, 0.3);
  const CentreScale scale = scale_of(boxes);
  for (const Aabb& box : boxes) {
    std::uint64_t expected = 0;
    for (int bit = 0; bit < CentreScale::bits; ++bit) {
      for (int a = 0; a < 3; ++a) {
        const std::uint64_t number = scale.number(centre_of(box, a));
        expected |= (number >> bit & 1) << (3 * bit + 2 - a);
      }
    }
    ASSERT_EQ(morton_code(scale, box), expected);
    ASSERT_LT(expected, beyond_z_order);
  }
}

}  // namespace
}  // namespace scree
