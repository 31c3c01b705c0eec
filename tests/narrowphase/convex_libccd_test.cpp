// Tests of libccd for convex particles: whatever it answers, the contact is as deep as by axes, and as deep
// as the bodies are.
#include "narrowphase/convex_libccd.hpp"

#include "bench/narrowphase/convex_families.hpp"
#include "bench/narrowphase/convex_oracle.hpp"
#include "bench/narrowphase/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace scree {
namespace {

using oracle::ConvexFamily;
using oracle::ConvexPair;

constexpr double rounding = 1e-12;  // share of the length

std::vector<ConvexFamily> all_convex_families() {
  std::vector<ConvexFamily> all;
  for (int f = 0; f < static_cast<int>(ConvexFamily::count); ++f) all.push_back(static_cast<ConvexFamily>(f));
  return all;
}

double least_gap(const Manifold& m) {
  double least = HUGE_VAL;
  for (int k = 0; k < m.count; ++k) least = std::min(least, m.points[k].gap);
  return least;
}

/// The pair in long double, about the place of its first body, as the narrow phase has it.
struct Exact {
  oracle::Convex a, b;
  explicit Exact(const ConvexPair& p)
      : a(p.a, p.data_a.hull, p.a.solid.position), b(p.b, p.data_b.hull, p.a.solid.position) {}
  double along(const Vec3& n) const {
    return static_cast<double>(oracle::separation_along(a, b, n.cast<oracle::Real>().normalized()));
  }
  double separation() const { return static_cast<double>(oracle::separation(a, b)); }
};

// ---- The oracle itself ----

TEST(ConvexOracle, KnowsWhatBoxesAre) {
  for (std::uint64_t n = 0; n < 500; ++n) {
    const oracle::SolidPair p = oracle::make_pair(oracle::Family::any, n);
    const oracle::Convex a({Shape::box, p.a}, nullptr, p.a.position),
        b({Shape::box, p.b}, nullptr, p.a.position);
    const double separation = static_cast<double>(oracle::separation(p.a, p.b));
    if (separation > 0) continue;
    ASSERT_NEAR(static_cast<double>(oracle::separation(a, b)), separation, rounding * p.length) << n;
  }
}

TEST(ConvexOracle, KnowsASphereInACylinderAndAPointInABox) {
  Random random(1, 0);
  for (int n = 0; n < 300; ++n) {
    const double radius = random.uniform(0.2, 1), half = random.uniform(0.2, 1),
                 ball = random.uniform(0.01, 0.5);
    const double from_axis = radius * random.uniform(), along = half * random.uniform(-1, 1);
    const Vec3 at = rotation_of(random.uniform(0, 6) * Vec3::UnitZ()) * Vec3(from_axis, 0, along);
    const ShapedSolid sphere{Shape::sphere, {at, Quat::Identity(), Vec3::Constant(ball)}};
    const ShapedSolid cylinder{Shape::cylinder, {Vec3::Zero(), Quat::Identity(), {radius, radius, half}}};
    const ShapedSolid box{Shape::box, {Vec3::Zero(), Quat::Identity(), {2, 2, half}}};
    const auto separation = [](const ShapedSolid& a, const ShapedSolid& b) {
      return static_cast<double>(oracle::separation(oracle::Convex(a, nullptr, Vec3::Zero()),
                                                    oracle::Convex(b, nullptr, Vec3::Zero())));
    };
    ASSERT_NEAR(separation(sphere, cylinder), -std::min(radius - from_axis, half - std::abs(along)) - ball,
                1e-14);
    ASSERT_NEAR(separation(box, sphere), std::abs(along) - half - ball, 1e-14);
  }
}

// ---- The axes ----

// With a sphere's centre on the axis of a cylinder, all radii lead out equally, and the offset of the centres
// singles out none.
TEST(ConvexAxes, ACylinderLetsWhatIsOnItsAxisOutSideways) {
  const ShapedSolid cylinder{Shape::cylinder, {Vec3::Zero(), Quat::Identity(), {0.2, 0.2, 1}}};
  const ShapedSolid sphere{Shape::sphere, {Vec3::Zero(), Quat::Identity(), Vec3::Constant(0.1)}};
  const ShapeData none{};
  Manifold m;
  ASSERT_EQ(find_general_contacts(sphere, cylinder, {&none, &none}, {.margin = 0}, &m), 1);
  EXPECT_NEAR(m.points[0].gap, -0.3, 1e-12);
  EXPECT_NEAR(m.normal.z(), 0, 1e-12);
}

// A climb from the best face and the best edge ended 1e-3 of the size inside, though the bodies are apart by
// 1e-4 of the size.
TEST(ConvexAxes, ABoxNextToApartFromACylinderIsApart) {
  const ShapedSolid box{
      Shape::box,
      {Vec3::Zero(), Quat(0.3116862855290285, 0.37801167500118699, -0.84435673888934704, 0.21684217871083336),
       Vec3(0.36877981853682895, 0.52607123531984934, 0.43927262832135971)}};
  const ShapedSolid cylinder{
      Shape::cylinder,
      {Vec3(0.83889546004035509, -0.6774361653595069, -0.74953987939320266),
       Quat(0.98444044375384865, -0.14485036985184574, -0.05827987745861473, 0.080615376566246955),
       Vec3(0.40050163088355734, 0.40050163088355734, 0.36949541954909737)}};
  const double truth = static_cast<double>(oracle::separation(
      oracle::Convex(box, nullptr, Vec3::Zero()), oracle::Convex(cylinder, nullptr, Vec3::Zero())));
  EXPECT_NEAR(truth, 3.6878e-5, 1e-8);
  const ConvexBody a(box, nullptr, Vec3::Zero()), b(cylinder, nullptr, Vec3::Zero());
  ConvexAxes axes;
  ASSERT_TRUE(best_axes(a, b, HUGE_VAL, std::min(a.size(), b.size()), axes));
  EXPECT_NEAR(axes.best.separation, truth, 1e-8);
}

// ---- By libccd ----

class ConvexByLibccd : public testing::TestWithParam<libccd::Method> {};
INSTANTIATE_TEST_SUITE_P(Each, ConvexByLibccd, testing::Values(libccd::Method::gjk, libccd::Method::mpr),
                         [](const auto& method) {
                           return method.param == libccd::Method::gjk ? "gjk" : "mpr";
                         });

TEST_P(ConvexByLibccd, NothingIsMissedAndTheDepthIsRight) {
  for (const ConvexFamily family : all_convex_families()) {
    NarrowPhaseStats stats;
    for (std::uint64_t n = 0; n < 77; ++n) {
      const ConvexPair p = oracle::make_pair(family, n);
      const double margin = 0.05 * p.smallest, slack = rounding * p.length;
      Manifold by_libccd, by_axes;
      ASSERT_EQ(find_contacts_by_libccd(p.a, p.b, p.shapes(), margin, GetParam(), &by_libccd, stats), 1)
          << oracle::name_of(family) << " " << n;
      ASSERT_EQ(find_general_contacts(p.a, p.b, p.shapes(), {.margin = margin}, &by_axes), 1);
      ASSERT_TRUE(by_libccd.normal.allFinite() && std::abs(by_libccd.normal.norm() - 1) < 1e-12) << n;
      ASSERT_TRUE(by_libccd.count >= 1 && by_libccd.count <= Manifold::max_points);
      for (int k = 0; k < by_libccd.count; ++k)
        ASSERT_TRUE(by_libccd.points[k].position.allFinite() && std::isfinite(by_libccd.points[k].gap));

      // The samples of the oracle may fall short of the largest separation, and no direction shows more than
      // that: the largest of the three is the best estimate.
      const Exact exact(p);
      const double truth =
          std::max({exact.separation(), exact.along(by_libccd.normal), exact.along(by_axes.normal)});
      const double allowed =
          oracle::most_given_away(truth, p.smallest) + tolerance::same_feature * p.smallest + slack;
      ASSERT_NEAR(least_gap(by_libccd), truth, allowed) << oracle::name_of(family) << " " << n;
      ASSERT_NEAR(least_gap(by_axes), truth, allowed) << oracle::name_of(family) << " " << n;
      ASSERT_GE(exact.along(by_libccd.normal), truth - allowed) << oracle::name_of(family) << " " << n;

      Manifold swapped;
      ASSERT_EQ(
          find_contacts_by_libccd(p.b, p.a, {&p.data_b, &p.data_a}, margin, GetParam(), &swapped, stats), 1);
      ASSERT_NEAR(least_gap(swapped), truth, allowed) << oracle::name_of(family) << " " << n;
      ASSERT_GE(exact.along(-swapped.normal), truth - allowed) << oracle::name_of(family) << " " << n;
    }
    EXPECT_GT(stats.ccd_calls, 100) << oracle::name_of(family);
    if (GetParam() == libccd::Method::gjk &&
        (family == ConvexFamily::shallow || family == ConvexFamily::far)) {
      EXPECT_LT(stats.ccd_rejected, stats.ccd_calls / 50);  // otherwise the calls of libccd are wrong
    }
  }
}

TEST_P(ConvexByLibccd, BodiesThatAreApartAreFoundByAxes) {
  int found = 0;
  for (std::uint64_t n = 0; n < 330; ++n) {
    ConvexPair p = oracle::make_pair(ConvexFamily::any, n);
    const Vec3 offset = p.b.solid.position - p.a.solid.position;
    p.b.solid.position += (0.2 + 0.1 * static_cast<double>(n % 7)) * p.length * offset.normalized();
    NarrowPhaseStats stats;
    Manifold by_libccd, by_axes;
    const int count = find_contacts_by_libccd(p.a, p.b, p.shapes(), p.length, GetParam(), &by_libccd, stats);
    ASSERT_EQ(count, find_general_contacts(p.a, p.b, p.shapes(), {.margin = p.length}, &by_axes));
    if (count == 0 || stats.ccd_calls > 0) continue;
    ++found;
    ASSERT_EQ(by_libccd.normal, by_axes.normal);
    ASSERT_EQ(by_libccd.count, by_axes.count);
    for (int k = 0; k < by_libccd.count; ++k) {
      ASSERT_EQ(by_libccd.points[k].position, by_axes.points[k].position);
      ASSERT_EQ(by_libccd.points[k].gap, by_axes.points[k].gap);
      ASSERT_EQ(by_libccd.points[k].feature, by_axes.points[k].feature);
    }
  }
  EXPECT_GT(found, 200);
}

TEST_P(ConvexByLibccd, ACertificateRefusesAWrongDirection) {
  NarrowPhaseStats stats;
  for (const ConvexFamily family : {ConvexFamily::deep, ConvexFamily::slender, ConvexFamily::size_ratio}) {
    for (std::uint64_t n = 0; n < 220; ++n) {
      const ConvexPair p = oracle::make_pair(family, n);
      const ConvexBody a(p.a, &p.data_a, p.a.solid.position), b(p.b, &p.data_b, p.a.solid.position);
      ConvexAxes axes;
      ASSERT_TRUE(best_axes(a, b, HUGE_VAL, p.smallest, axes));
      const auto axis = detail::certified_axis(a, b, axes, p.smallest, GetParam(), stats);
      if (!axis) continue;
      // The separation of the axis is that along its direction, and the direction is no worse than that of
      // the axes.
      const double along = Exact(p).along(axis->normal);
      ASSERT_NEAR(axis->separation, along, rounding * p.length) << oracle::name_of(family) << " " << n;
      ASSERT_GE(along, axes.best.separation - tolerance::libccd_excess * p.smallest - rounding * p.length);
    }
  }
  EXPECT_GT(stats.ccd_rejected, 50);
  EXPECT_LT(stats.ccd_rejected, stats.ccd_calls);
}

TEST_P(ConvexByLibccd, EveryCallEnds) {
  double worst = 0;
  for (const ConvexFamily family : all_convex_families()) {
    for (std::uint64_t n = 0; n < 55; ++n) {
      const ConvexPair p = oracle::make_pair(family, n);
      const ConvexBody a(p.a, &p.data_a, p.a.solid.position), b(p.b, &p.data_b, p.a.solid.position);
      // The search gets the budget that is used, and budgets that run out in each of its phases.
      for (const int budget : {detail::support_budget_of(a, b), static_cast<int>(n % 40)}) {
        const auto start = std::chrono::steady_clock::now();
        const libccd::Answer answer = detail::ask_libccd(a, b, GetParam(), budget);
        worst =
            std::max(worst, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
        ASSERT_LE(answer.supports, budget + 16);  // a false support point ends each running loop
        if (answer.direction) {
          ASSERT_NEAR(answer.direction->norm(), 1.0, 1e-12);
        }
      }
    }
  }
  EXPECT_LT(worst, 1.0);  // (s)
}

TEST(ConvexCrosscheck, AgreesOnShallowPairsAndFindsLibccdAtFaultElsewhere) {
  CrosscheckStats shallow, all;
  for (std::uint64_t n = 0; n < 330; ++n) {
    const ConvexPair p = oracle::make_pair(ConvexFamily::shallow, n);
    crosscheck(p.a, p.b, p.shapes(), shallow);
    const ConvexPair q = oracle::make_pair(all_convex_families()[n % 11], n / 11);
    crosscheck(q.a, q.b, q.shapes(), all);
  }
  EXPECT_EQ(shallow.asked, 330);
  EXPECT_LT(shallow.ccd_deeper.total() + shallow.touching.total(), 7);
  EXPECT_EQ(shallow.ccd_shallower.total(), 0);
  EXPECT_GT(all.ccd_deeper.total(), 10);
  EXPECT_LT(all.ccd_shallower.total(), 5);  // cylinders deep in one another
}

TEST(ConvexPairs, AreThoseThatLibccdCanBeAskedAbout) {
  using enum Shape;
  const auto both = [](Shape a, Shape b) { return is_convex_pair(a, b) && is_convex_pair(b, a); };
  for (const Shape general : {capsule, cylinder, polyhedron}) {
    for (const Shape other : {box, capsule, cylinder, polyhedron}) EXPECT_TRUE(both(general, other));
    EXPECT_EQ(both(general, sphere), general != capsule);  // capsule and sphere have a closed form
    for (const Shape surface : {plane, tube, triangle})
      EXPECT_FALSE(is_convex_pair(general, surface) || is_convex_pair(surface, general));
  }
  EXPECT_FALSE(is_convex_pair(sphere, sphere) || is_convex_pair(box, box) || is_convex_pair(sphere, box));
}

}  // namespace
}  // namespace scree
