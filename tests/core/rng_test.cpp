// Tests of Philox against the vectors published with it, and of the moments of the stream.
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace scree {
namespace {

using Words = std::array<std::uint32_t, 4>;

// The known answers come with Random123: zeros, ones, and the digits of pi.
TEST(Philox, KnownAnswers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, FirstDrawIsThePhiloxWord) {
  // The first draw has 53 bits of the first two words of philox(0, 0).
  EXPECT_EQ(Random(0, 0).uniform(), static_cast<double>(0x6627e8d5e169c58dull >> 11) * 0x1p-53);
}

TEST(Random, StreamsDependOnAllOfSeedAndItem) {
  const double first = Random(1, 2).uniform();
  EXPECT_EQ(Random(1, 2).uniform(), first);
  EXPECT_NE(Random(2, 2).uniform(), first);
  EXPECT_NE(Random(1, 3).uniform(), first);
  EXPECT_NE(Random(1 + (1ull << 32), 2).uniform(), first);
  EXPECT_NE(Random(1, 2 + (1ull << 32)).uniform(), first);
}

// Checks the moments of n draws; the bounds are five standard deviations of each estimate.
void expect_uniform(const std::array<double, 3>& sums, double lag_product, double n) {
  EXPECT_NEAR(sums[0] / n, 1.0 / 2, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(sums[1] / n, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / n));
  EXPECT_NEAR(sums[2] / n, 1.0 / 4, 5 * std::sqrt(9.0 / 112 / n));
  // Products of neighbours share factors: their variance is 7/144 plus twice the covariance 1/48 of adjacent
  // products.
  EXPECT_NEAR(lag_product / n, 1.0 / 4, 5 * std::sqrt((7.0 / 144 + 2.0 / 48) / n));
}

template <class Draw>
void check_moments(Draw draw) {
  constexpr int n = 1000000;
  std::array<double, 3> sums{};
  double lag_product = 0;
  double last = draw(n);
  for (int i = 0; i < n; ++i) {
    const double x = draw(i);
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    sums[0] += x;
    sums[1] += x * x;
    sums[2] += x * x * x;
    lag_product += x * last;
    last = x;
  }
  expect_uniform(sums, lag_product, n);
}

TEST(Random, DrawsOfOneStreamAreUniform) {
  Random random(7, 1);
  check_moments([&random](int) { return random.uniform(); });
}

TEST(Random, FirstDrawsOfManyItemsAreUniform) {
  check_moments([](int item) { return Random(7, static_cast<std::uint64_t>(item)).uniform(); });
}

TEST(Random, RangeKeepsItsEnds) {
  Random random(7, 2);
  double low = 1e300;
  double high = -1e300;
  for (int i = 0; i < 100000; ++i) {
    const double x = random.uniform(-3, 5);
    low = std::fmin(low, x);
    high = std::fmax(high, x);
  }
  EXPECT_GE(low, -3.0);
  EXPECT_LT(high, 5.0);
  EXPECT_LT(low, -2.99);
  EXPECT_GT(high, 4.99);
}

}  // namespace
}  // namespace scree
