// Tests of spheres against spheres, planes and boxes, by their definition in long double.
#include "bench/narrowphase/families.hpp"
#include "bench/narrowphase/oracle.hpp"
#include "narrowphase/sphere_box.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr int draws = 20000;

Solid sphere(const Vec3& at, double radius) { return {at, Quat::Identity(), Vec3::Constant(radius)}; }

/// Expects what any single contact must satisfy: its point is midway between the surfaces, on the normal
/// through the centre of the sphere.
void expect_midway(const Solid& ball, const Vec3& outward, const Manifold& m, double tolerance) {
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(m.normal.norm(), 1.0, 1e-14);
  const Vec3 expected = ball.position + (ball.size.x() + 0.5 * m.points[0].gap) * outward;
  EXPECT_LT((m.points[0].position - expected).norm(), tolerance);
}

TEST(SphereSphere, GapNormalAndPointAreExact) {
  Random random(1, 0);
  for (int n = 0; n < draws; ++n) {
    const Vec3 origin = random.uniform(0, 100) * oracle::random_unit(random);
    const Solid a = sphere(origin, random.uniform(0.01, 1)),
                b = sphere(origin + random.uniform(0, 2.5) * oracle::random_unit(random),
                           random.uniform(0.01, 1));
    const oracle::Vec offset = b.position.cast<oracle::Real>() - a.position.cast<oracle::Real>();
    const double gap = static_cast<double>(offset.norm() - a.size.x() - b.size.x());
    const double margin = 0.1;
    Manifold m, swapped;
    const bool found = sphere_sphere(a, b, margin, m);
    if (std::fabs(gap - margin) > 1e-12) {
      ASSERT_EQ(found, gap < margin);
    }
    ASSERT_EQ(found, sphere_sphere(b, a, margin, swapped));
    if (!found) continue;
    EXPECT_NEAR(m.points[0].gap, gap, 1e-15);
    EXPECT_LT((m.normal - offset.normalized().cast<double>()).norm(), 1e-14);
    expect_midway(a, m.normal, m, 1e-13);
    EXPECT_EQ(swapped.normal, Vec3(-m.normal));
    EXPECT_EQ(swapped.points[0].position, m.points[0].position);
    EXPECT_EQ(swapped.points[0].gap, m.points[0].gap);
  }
}

TEST(SphereSphere, CoincidentCentresPartTheSameWayEveryTime) {
  for (const double scale : {1e-9, 1.0, 1e9}) {
    const Vec3 at = scale * Vec3(3, -2, 7);
    Manifold m;
    ASSERT_TRUE(sphere_sphere(sphere(at, scale), sphere(at, 2 * scale), 0, m));
    EXPECT_EQ(m.normal, Vec3(Vec3::UnitZ()));
    EXPECT_DOUBLE_EQ(m.points[0].gap, -3 * scale);
    EXPECT_TRUE(m.points[0].position.allFinite());
  }
}

TEST(SpherePlane, GapNormalAndPointAreExact) {
  Random random(2, 0);
  for (int n = 0; n < draws; ++n) {
    const Solid plane{random.uniform(-2, 2) * Vec3(1, 2, 3), oracle::random_turn(random), Vec3::Zero()};
    const Solid ball = sphere(plane.position + 2 * oracle::random_unit(random), random.uniform(0.01, 2));
    const oracle::Vec up = plane.orientation.cast<oracle::Real>() * oracle::Vec::UnitZ();
    const double gap = static_cast<double>(
        up.dot(ball.position.cast<oracle::Real>() - plane.position.cast<oracle::Real>()) - ball.size.x());
    Manifold m;
    const bool found = sphere_plane(ball, plane, 0.1, m);
    if (std::fabs(gap - 0.1) > 1e-12) {
      ASSERT_EQ(found, gap < 0.1);
    }
    if (!found) continue;
    EXPECT_NEAR(m.points[0].gap, gap, 4e-15);
    EXPECT_LT((m.normal + up.cast<double>()).norm(), 1e-14);
    expect_midway(ball, m.normal, m, 1e-13);
  }
}

TEST(SphereBox, FacesEdgesVerticesAndInsideAreExact) {
  Random random(3, 0);
  for (int n = 0; n < 5 * draws; ++n) {
    const double scale = std::pow(10.0, static_cast<double>(n % 13) - 6);
    const Solid box{scale * oracle::random_unit(random), oracle::random_turn(random),
                    scale * Vec3(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1))};
    Vec3 at;
    for (int k = 0; k < 3; ++k) at[k] = random.uniform(-1.5, 1.5) * box.size[k];
    const Solid ball = sphere(box.position + box.orientation * at, scale * random.uniform(0.01, 1));
    oracle::Vec nearest = oracle::Vec::Zero();
    const oracle::Real distance =
        oracle::to_surface(oracle::Box(box), ball.position.cast<oracle::Real>(), nearest);
    const double gap = static_cast<double>(distance) - ball.size.x();
    const double margin = 0.1 * scale;

    Manifold m;
    const bool found = sphere_box(ball, box, margin, m);
    if (std::fabs(gap - margin) > 1e-12 * scale) {
      ASSERT_EQ(found, gap < margin) << n;
    }
    if (!found) continue;
    ASSERT_NEAR(m.points[0].gap, gap, 1e-14 * scale) << n;
    expect_midway(ball, m.normal, m, 1e-14 * scale);
    if (std::fabs(static_cast<double>(distance)) < 1e-3 * scale) continue;  // the direction is rounding noise
    const oracle::Vec outward = (ball.position.cast<oracle::Real>() - nearest) / distance;
    EXPECT_LT((m.normal + outward.cast<double>()).norm(), 1e-11) << n;
  }
}

TEST(SphereBox, TiesInsideGoToTheFirstAxis) {
  const Solid box{Vec3(1, 2, 3), Quat::Identity(), Vec3::Constant(0.5)};
  Manifold m;
  ASSERT_TRUE(sphere_box(sphere(box.position, 0.1), box, 0, m));
  EXPECT_EQ(m.normal, Vec3(-1, 0, 0));
  EXPECT_DOUBLE_EQ(m.points[0].gap, -0.6);
  ASSERT_TRUE(sphere_box(sphere(box.position + Vec3(0.5, -0.5, 0.5), 0.1), box, 0, m));  // on a vertex
  EXPECT_EQ(m.normal, Vec3(-1, 0, 0));
  EXPECT_DOUBLE_EQ(m.points[0].gap, -0.1);
}

TEST(SphereBox, SizesMayDifferAThousandfold) {
  const Solid floor{Vec3::Zero(), Quat::Identity(), Vec3(1000, 1000, 1)};
  Manifold m;
  ASSERT_TRUE(sphere_box(sphere(Vec3(987.654321, -432.1, 1.000999999), 1e-3), floor, 0, m));
  EXPECT_NEAR(m.points[0].gap, -1e-9, 1e-15);
  EXPECT_LT((m.points[0].position - Vec3(987.654321, -432.1, 1 - 0.5e-9)).norm(), 1e-12);
}

}  // namespace
}  // namespace scree
