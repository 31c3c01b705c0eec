// Time of impact beside bisection in long double.
#include "core/rng.hpp"
#include "sim/dynamics/flight.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

long double gap_at(long double gap, long double u, long double a, long double s) {
  return gap + u * s + 0.5L * a * s * s;
}

/// First sign change on a fine grid, then bisection; infinite beyond `horizon`.
long double first_root(double gap, double u, double a, double horizon) {
  const int cells = 4000;
  for (int k = 0; k < cells; ++k) {
    long double lo = horizon * k / cells;
    long double hi = static_cast<long double>(horizon) * (k + 1) / cells;
    if (gap_at(gap, u, a, hi) > 0) continue;
    for (int it = 0; it < 100; ++it) {
      const long double mid = 0.5L * (lo + hi);
      (gap_at(gap, u, a, mid) > 0 ? lo : hi) = mid;
    }
    return hi;
  }
  return HUGE_VALL;
}

TEST(TimeOfImpact, AgreesWithBisection) {
  for (std::uint64_t item = 0; item < 3000; ++item) {
    Random random(5, item);
    const double gap = std::pow(10.0, random.uniform(-6, 0));
    const double u = random.uniform(-3, 1);
    const double a = item % 3 == 0 ? 0.0 : random.uniform(-20, 5);
    const double horizon = 2.0;
    const double s = time_of_impact(gap, u, a);
    const long double oracle = first_root(gap, u, a, horizon);
    const double depth = u * u - 2 * a * gap;
    if (std::abs(depth) < 1e-2) continue;  // grazing: the grid of the oracle may step over a double root
    if (oracle == HUGE_VALL) {
      ASSERT_GT(s, horizon * (1 - 1e-9)) << gap << " " << u << " " << a;
    } else {
      ASSERT_NEAR(s, static_cast<double>(oracle), 1e-12 * (1 + s)) << gap << " " << u << " " << a;
    }
  }
}

TEST(TimeOfImpact, OverlapIsNow) { EXPECT_EQ(time_of_impact(-0.1, -1, 0), 0.0); }
TEST(TimeOfImpact, PartingBodiesNeverMeet) { EXPECT_EQ(time_of_impact(0.1, 1, 0), HUGE_VAL); }
TEST(TimeOfImpact, RestingAtADistanceNeverMeets) { EXPECT_EQ(time_of_impact(0.1, 0, 0), HUGE_VAL); }

}  // namespace
}  // namespace scree
