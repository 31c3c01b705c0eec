// Tests that of the points that a body strikes at once the widest are kept.
#include "sim/impacts/struck_walls.hpp"

#include "core/random_orientation.hpp"
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace scree {
namespace {

/// Returns twice the area of the triangle or quadrangle of points in a plane, in any order.
double doubled_area(const StruckPoints& points, const Vec3& normal) {
  const auto of = [&](int a, int b, int c) {
    return std::abs(normal.dot((points.at[b] - points.at[a]).cross(points.at[c] - points.at[a])));
  };
  // The four triangles count each half of the quadrangle twice.
  return 0.5 * (of(0, 1, 2) + of(1, 2, 3) + of(2, 3, 0) + of(3, 0, 1));
}

TEST(StruckPoints, KeepTheCornersOfARectangleWhateverIsBetween) {
  Random random(7, 1);
  for (int run = 0; run < 20000; ++run) {
    const Quat turn = random_orientation(random);
    const Vec3 normal = turn * Vec3::UnitZ();
    const double length = random.uniform(0.1, 10), width = random.uniform(0.1, 10);
    std::vector<Vec3> flat;
    for (const double x : {0.0, length})
      for (const double y : {0.0, width}) flat.emplace_back(x, y, 0);
    // There are up to as many points between the corners as a manifold holds, and more.
    const int between = run % 40;
    for (int k = 0; k < between; ++k)
      flat.emplace_back(length * random.uniform(0.01, 0.99), k % 2 ? 0 : width * random.uniform(0.01, 0.99),
                        0);
    for (std::size_t k = flat.size() - 1; k > 0; --k)
      std::swap(flat[k], flat[static_cast<std::size_t>(random.uniform(0, 1) * static_cast<double>(k + 1))]);
    StruckPoints points;
    for (std::size_t k = 0; k < flat.size(); ++k)
      points.add(normal, turn * flat[k], static_cast<std::int32_t>(k));
    points.keep_widest(normal);
    ASSERT_EQ(points.count, Manifold::max_points);
    EXPECT_NEAR(doubled_area(points, normal), 2 * length * width, 1e-9 * length * width) << between;
    for (int k = 0; k < points.count; ++k)
      EXPECT_EQ(points.at[k], turn * flat[static_cast<std::size_t>(points.wall[k])]);
  }
}

TEST(StruckPoints, FewStayAsTheyAre) {
  StruckPoints points;
  for (int k = 0; k < Manifold::max_points; ++k) points.add(Vec3::UnitZ(), Vec3(k, 0, 0), k);
  points.keep_widest(Vec3::UnitZ());
  ASSERT_EQ(points.count, Manifold::max_points);
  for (int k = 0; k < points.count; ++k) EXPECT_EQ(points.wall[k], k);
}

}  // namespace
}  // namespace scree
