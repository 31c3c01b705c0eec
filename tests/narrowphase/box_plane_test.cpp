#include "narrowphase/box_plane.hpp"

#include "bench/narrowphase/families.hpp"
#include "bench/narrowphase/oracle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace scree {
namespace {

TEST(BoxPlane, PointsAreTheCornersWithinTheMargin) {
  Random random(1, 0);
  for (int n = 0; n < 20000; ++n) {
    const Solid plane{oracle::random_unit(random), oracle::random_turn(random), Vec3::Zero()};
    const Vec3 up = plane.orientation * Vec3::UnitZ();
    const Solid box{plane.position + random.uniform(-1, 2) * up, oracle::random_turn(random),
                    Vec3(random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1))};
    const double margin = 0.05;
    std::vector<double> heights;
    const auto vertices = oracle::Box(box).vertices;
    for (const oracle::Vec& v : vertices) {
      heights.push_back(static_cast<double>((plane.orientation.cast<oracle::Real>() * oracle::Vec::UnitZ())
                                                .dot(v - plane.position.cast<oracle::Real>())));
    }
    const double lowest = *std::min_element(heights.begin(), heights.end());
    const auto within = std::count_if(heights.begin(), heights.end(), [](double h) { return h <= 0.05; });

    Manifold m;
    ASSERT_EQ(box_plane(box, plane, margin, m), within > 0) << n;
    if (within == 0) continue;
    if (within <= Manifold::max_points) {
      ASSERT_EQ(m.count, within) << n;
    } else {
      ASSERT_GE(m.count, 2) << n;
      ASSERT_LE(m.count, Manifold::max_points) << n;
    }
    EXPECT_LT((m.normal + up).norm(), 1e-14);
    std::set<std::uint32_t> features;
    double deepest = HUGE_VAL;
    for (int k = 0; k < m.count; ++k) {
      features.insert(m.points[k].feature);
      deepest = std::min(deepest, m.points[k].gap);
      // There is a corner with this gap half the gap above or below the point.
      const Vec3 corner = m.points[k].position + 0.5 * m.points[k].gap * up;
      double nearest = HUGE_VAL;
      for (int c = 0; c < 8; ++c) {
        if (std::fabs(heights[c] - m.points[k].gap) > 1e-14) continue;
        nearest = std::min(nearest, (vertices[c].cast<double>() - corner).norm());
      }
      EXPECT_LT(nearest, 1e-14) << n;
    }
    EXPECT_EQ(features.size(), static_cast<std::size_t>(m.count));
    EXPECT_NEAR(deepest, lowest, 1e-14);
  }
}

TEST(BoxPlane, ADeepBoxStandsOnItsLowerFace) {
  Manifold m;
  const Solid plane{Vec3::Zero(), Quat::Identity(), Vec3::Zero()};
  const Solid box{Vec3(4, 5, -3), rotation_of(Vec3(1e-9, 2e-9, 0.3)), Vec3(0.5, 0.6, 0.7)};
  ASSERT_TRUE(box_plane(box, plane, 0, m));
  ASSERT_EQ(m.count, 4);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(m.points[k].gap, -3.7, 1e-8);
    EXPECT_NEAR((m.points[k].position - Vec3(4, 5, -3.7 / 2)).norm(), std::hypot(0.5, 0.6), 1e-8);
  }
}

}  // namespace
}  // namespace scree
