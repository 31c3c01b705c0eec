// Tests of libccd for boxes: whatever it answers, the manifold is as good as that of the 15 axes.
#include "bench/narrowphase/families.hpp"
#include "bench/narrowphase/oracle.hpp"
#include "narrowphase/box_box_crosscheck.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

namespace scree {
namespace {

using oracle::Family;
using oracle::SolidPair;

class LibccdMethods : public testing::TestWithParam<libccd::Method> {};
INSTANTIATE_TEST_SUITE_P(Each, LibccdMethods, testing::Values(libccd::Method::gjk, libccd::Method::mpr),
                         [](const auto& method) {
                           return method.param == libccd::Method::gjk ? "gjk" : "mpr";
                         });

TEST_P(LibccdMethods, NothingIsMissedAndTheDepthIsRight) {
  for (int f = 0; f < static_cast<int>(Family::count); ++f) {
    const auto family = static_cast<Family>(f);
    NarrowPhaseStats stats;
    for (std::uint64_t n = 0; n < 5000; ++n) {
      const SolidPair p = oracle::make_pair(family, n);
      const double smallest = p.smallest, margin = 0.05 * smallest;
      Manifold by_libccd, by_axes;
      const bool found = box_box_libccd(p.a, p.b, margin, GetParam(), by_libccd, stats);
      ASSERT_EQ(found, box_box(p.a, p.b, margin, by_axes)) << oracle::name_of(family) << " " << n;
      if (!found) continue;
      for (int k = 0; k < by_libccd.count; ++k) {
        ASSERT_TRUE(by_libccd.points[k].position.allFinite());
        ASSERT_TRUE(std::isfinite(by_libccd.points[k].gap));
      }
      const double separation = static_cast<double>(oracle::separation(p.a, p.b));
      if (separation > 0) continue;
      const double allowed =
          oracle::most_given_away(separation, smallest) + tolerance::same_feature * smallest;
      const double slack = 1e-12 * p.length;
      ASSERT_NEAR(detail::smallest_gap(by_libccd), separation, allowed + slack)
          << oracle::name_of(family) << " " << n;
      const oracle::Vec normal = by_libccd.normal.cast<oracle::Real>();
      const double along =
          static_cast<double>(oracle::separation_along(oracle::Box(p.a), oracle::Box(p.b), normal));
      ASSERT_GE(along, separation - allowed - slack) << oracle::name_of(family) << " " << n;
    }
    std::printf("%-14s %6lld calls, %5.2f %% refused\n", oracle::name_of(family),
                static_cast<long long>(stats.ccd_calls),
                100.0 * static_cast<double>(stats.ccd_rejected) /
                    static_cast<double>(std::max<std::int64_t>(1, stats.ccd_calls)));
    EXPECT_GT(stats.ccd_calls, 0);
    if (family == Family::shallow) {
      EXPECT_LT(stats.ccd_rejected, stats.ccd_calls / 100);  // otherwise the calls of libccd are wrong
    }
  }
}

// MPR is right for most shallow contacts, and the 15 axes are never worse than MPR.
TEST(Crosscheck, AgreesWithPortalRefinementOnShallowPairs) {
  CrosscheckStats stats;
  for (std::uint64_t n = 0; n < 40000; ++n) {
    const SolidPair p = oracle::make_pair(Family::shallow, n);
    if (separating_axes(BoxPair(p.a, p.b), HUGE_VAL).separation < -1e-3 * p.smallest) continue;
    crosscheck(p.a, p.b, stats);
  }
  EXPECT_GT(stats.asked, 10000);
  EXPECT_LT(stats.touching.total() + stats.ccd_deeper.total(), stats.asked / 1000);
  EXPECT_EQ(stats.touching.total(), 0);
  EXPECT_EQ(stats.ccd_shallower.total(), 0);
}

TEST_P(LibccdMethods, ACertificateRefusesAWrongDirection) {
  // In deep overlaps the portal ray of MPR is far from the shortest way out.
  NarrowPhaseStats stats;
  for (std::uint64_t n = 0; n < 3000; ++n) {
    SolidPair p = oracle::make_pair(Family::any, n);
    p.b.position = p.a.position + 0.2 * (p.b.position - p.a.position);
    const BoxPair pair(p.a, p.b);
    const BoxAxes axes = separating_axes(pair, 0);
    const auto direction = detail::certified_direction(pair, axes, GetParam(), stats);
    if (!direction) continue;
    const double along = static_cast<double>(
        oracle::separation_along(oracle::Box(p.a), oracle::Box(p.b), direction->cast<oracle::Real>()));
    ASSERT_GE(along, static_cast<double>(oracle::separation(p.a, p.b)) - 2 * tolerance::libccd_excess);
  }
  if (GetParam() == libccd::Method::mpr) {
    EXPECT_GT(stats.ccd_rejected, 100);
  }
}

TEST_P(LibccdMethods, EveryCallEnds) {
  // EPA runs for ever without the support budget in these families: thin floors under small boxes.
  Random random(4, 0);
  double worst = 0;
  for (int n = 0; n < 20000; ++n) {
    libccd::Boxes boxes;
    const double flat = std::pow(10.0, -random.uniform(0, 6)), wide = std::pow(10.0, random.uniform(0, 4));
    boxes.half[0] = Vec3(wide, wide * random.uniform(0.1, 1), wide * flat);
    boxes.half[1] = Vec3(1, random.uniform(0.1, 1), random.uniform(1e-3, 1));
    const double tilt = n % 3 ? std::pow(10.0, -random.uniform(0, 15)) : 0.0;
    boxes.turn = rotation_of(tilt * oracle::random_unit(random)).toRotationMatrix();
    boxes.offset = Vec3(random.uniform(-wide, wide), random.uniform(-wide, wide),
                        random.uniform(0, boxes.half[0].z() + boxes.half[1].z()));
    if (n % 7 == 0) boxes.offset.setZero();
    // The search gets the budget that is used, and budgets that run out in each of its phases.
    for (const int budget : {libccd::support_budget, n % 40}) {
      const auto start = std::chrono::steady_clock::now();
      const libccd::Answer answer = libccd::separating_direction(boxes, GetParam(), budget);
      worst =
          std::max(worst, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      ASSERT_LE(answer.supports, budget + 16);  // a false support point ends each running loop
      if (answer.direction) {
        ASSERT_NEAR(answer.direction->norm(), 1.0, 1e-12);
      }
    }
  }
  EXPECT_LT(worst, 1.0);  // (s)
}

}  // namespace
}  // namespace scree
