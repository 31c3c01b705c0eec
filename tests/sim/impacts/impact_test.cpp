// Tests of the time of impact, against bisection in long double, and of what the sweeps of one impact leave.
#include "sim/impacts/impact.hpp"

#include "core/rng.hpp"
#include "sim/laws/flight.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

long double gap_at(long double gap, long double u, long double a, long double s) {
  return gap + u * s + 0.5L * a * s * s;
}

/// Finds the first sign change on a fine grid, then bisects; returns infinity beyond `horizon`.
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
    if (std::abs(depth) < 1e-2) continue;  // a graze: the grid of the oracle may step over a double root
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

/// Bodies of any inertia strike at points of one plane, with friction. At one point the law has one solution,
/// and the impulses are that solution to rounding; at several points they are one of many solutions.
TEST(SweepImpact, ImpulsesMeetTheLawToRounding) {
  int left = 0, impacts = 0;
  for (std::uint64_t item = 0; item < 2000; ++item) {
    Random random(31, item);
    const auto vector = [&](double size) {
      const double x = random.uniform(-size, size), y = random.uniform(-size, size);
      return Vec3(x, y, random.uniform(-size, size));
    };
    const auto body = [&](double inverse_mass) {
      const Mat3 root = Mat3::Identity() + 0.5 * Mat3(vector(1) * vector(1).transpose());
      return SolverBody{vector(1), vector(2), inverse_mass, 40 * inverse_mass * root * root.transpose()};
    };
    SolverBody i = body(1), j = body(random.uniform(0.1, 10));
    const Vec3 normal = vector(1).normalized();
    const double friction = random.uniform(0, 1.2);
    const int count = item % 2 == 0 ? 1 : 1 + static_cast<int>(item % Manifold::max_points);
    ContactRow rows[Manifold::max_points];
    RowCoupling couplings[Manifold::max_points];
    for (int k = 0; k < count; ++k) {
      const Vec3 drawn = vector(0.3);
      const Vec3 across = drawn - normal.dot(drawn) * normal;
      rows[k] = make_row(normal, 0.2 * normal + across, -0.2 * normal + across, 0.0, i, j, couplings[k]);
      rows[k].target = random.uniform(0, 1);
    }
    RollingCouple rolling;
    detail::sweep_impact(rows, couplings, count, normal, friction, rolling, {.guides = {}, .i = 0, .j = 1}, i,
                         j);
    ImpulseChange residual;
    for (int k = 0; k < count; ++k)
      residual.add(rows[k],
                   natural_map(rows[k], normal, friction, rows[k].relative_velocity(i, j)) - rows[k].impulse);
    ++impacts;
    if (count == 1) {
      EXPECT_TRUE(residual.within(1e-12)) << item << " " << residual.step << " " << residual.size;
    } else if (!residual.within(1e-9)) {
      ++left;
    }
  }
  EXPECT_LT(left, impacts / 50);  // these sweeps end at their limit, before they converge
}

}  // namespace
}  // namespace scree
