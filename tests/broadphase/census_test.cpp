// Tests of the census and of the histogram of sizes, against serial loops.
#include "broadphase/census.hpp"

#include "tests/broadphase/boxes.hpp"
#include "tests/core/spaces.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

template <class Space>
class CensusTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(CensusTest, test::Spaces, test::SpaceName);

TEST(SizeClass, IsMonotoneAndEndsWhereItSays) {
  for (float x = FLT_MIN; x < 1e38f; x *= 1.037f) {
    EXPECT_LE(x, class_end(size_class(x)));
    EXPECT_EQ(size_class(class_end(size_class(x))), size_class(x));
    EXPECT_EQ(size_class(std::nextafter(class_end(size_class(x)), INFINITY)), size_class(x) + 1);
    EXPECT_LE(class_end(size_class(x)), 1.126f * x);
    EXPECT_EQ(size_class(2 * x), size_class(x) + classes_per_octave);
  }
}

TYPED_TEST(CensusTest, CountsAndRangesAreThoseOfALoop) {
  test::Boxes boxes = test::log_cloud(30000, 50, 1e-9, 10);
  for (std::size_t k = 0; k < boxes.size(); k += 11) boxes[k] = absent_bounds();
  for (std::size_t k = 5; k < boxes.size(); k += 13) boxes[k] = test::ball(1, 2, 3, 0);
  Array<Aabb, TypeParam> bounds;
  copy(bounds, boxes);
  const Census census = take_census<TypeParam>(bounds.view());
  const SizeHistogram sizes = count_sizes<TypeParam>(bounds.view(), census);

  Census expected;
  std::array<std::uint32_t, SizeHistogram::bins> count{};
  for (const Aabb& box : boxes) {
    if (is_absent(box)) continue;
    ++expected.present;
    float extent = 0;
    for (int a = 0; a < 3; ++a) {
      const auto centre = static_cast<float>(0.5 * (double{box.lo[a]} + double{box.hi[a]}));
      expected.lo[a] = std::min(expected.lo[a], centre);
      expected.hi[a] = std::max(expected.hi[a], centre);
      extent = std::max(extent, static_cast<float>(double{box.hi[a]} - double{box.lo[a]}));
    }
    expected.extended += extent > 0;
    expected.largest = std::max(expected.largest, extent);
    const int bin = static_cast<int>(std::bit_cast<std::uint32_t>(extent) >> 20) - sizes.first_class;
    ++count[static_cast<std::size_t>(std::clamp(bin, 0, 255))];
  }
  for (int a = 0; a < 3; ++a) {
    EXPECT_EQ(census.lo[a], expected.lo[a]);
    EXPECT_EQ(census.hi[a], expected.hi[a]);
  }
  EXPECT_EQ(census.present, expected.present);
  EXPECT_EQ(census.extended, expected.extended);
  EXPECT_EQ(census.largest, expected.largest);
  EXPECT_EQ(sizes.count, count);
}

}  // namespace
}  // namespace scree
