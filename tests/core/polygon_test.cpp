// Tests of polygons cut into triangles: for any form, the triangles have the area of the polygon and its
// sense of turning.
#include "core/polygon.hpp"

#include "core/random_orientation.hpp"
#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace scree {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

double signed_area(const std::vector<Vec3>& corners) {
  double sum = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return sum;
}

/// Expects a polygon, given counterclockwise in the plane z = 0 and then turned in space, to be cut into
/// `triangles` triangles.
void expect_cut(const std::vector<Vec3>& flat, Random& random, std::size_t triangles) {
  const Quat turn = random_orientation(random);
  std::vector<Vec3> corners;
  for (const Vec3& c : flat) corners.push_back(turn * (c + Vec3(2, -1, 3)));
  Triangles parts;
  ASSERT_TRUE(cut_polygon(corners, parts));
  EXPECT_EQ(parts.size(), triangles);
  double sum = 0;
  for (const auto& [a, b, c] : parts) {
    const double area = signed_area({flat[std::size_t(a)], flat[std::size_t(b)], flat[std::size_t(c)]});
    EXPECT_GT(area, 0);
    sum += area;
  }
  EXPECT_NEAR(sum, signed_area(flat), 1e-9 * std::abs(signed_area(flat)));
}

TEST(Polygon, AConvexOneIsAFan) {
  const std::vector<Vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  Triangles parts;
  ASSERT_TRUE(cut_polygon(square, parts));
  EXPECT_EQ(parts, (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Polygon, StarsOfAnySizeKeepTheirArea) {
  Random random(1, 0);
  for (const double size : {1e-3, 1.0, 1e3}) {
    for (int n = 0; n < 200; ++n) {
      const int corners = 4 + n % 40;
      std::vector<Vec3> star;
      for (int k = 0; k < corners; ++k) {
        const double angle = 2 * pi * (k + random.uniform(0, 0.8)) / corners,
                     radius = size * random.uniform(0.1, 1);
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
      }
      expect_cut(star, random, std::size_t(corners - 2));
    }
  }
}

TEST(Polygon, CombsAndSpiralsKeepTheirArea) {
  Random random(2, 0);
  for (int teeth = 1; teeth < 30; ++teeth) {
    std::vector<Vec3> comb = {{0, -0.3, 0}, {2.0 * teeth, -0.3, 0}};
    for (int k = teeth; k > 0; --k) {
      comb.emplace_back(2.0 * k - 0.5, 1, 0);
      comb.emplace_back(2.0 * k - 1, 0, 0);
      comb.emplace_back(2.0 * k - 1.5, 1, 0);
    }
    expect_cut(comb, random, comb.size() - 2);
    std::vector<Vec3> spiral;
    for (int k = 0; k <= 3 * teeth; ++k)
      spiral.emplace_back((1 + 0.3 * k) * std::cos(0.5 * k), (1 + 0.3 * k) * std::sin(0.5 * k), 0);
    for (int k = 3 * teeth; k >= 0; --k)
      spiral.emplace_back((1.2 + 0.3 * k) * std::cos(0.5 * k), (1.2 + 0.3 * k) * std::sin(0.5 * k), 0);
    std::vector<Vec3> reversed(spiral.rbegin(), spiral.rend());
    expect_cut(signed_area(spiral) > 0 ? spiral : reversed, random, spiral.size() - 2);
  }
}

TEST(Polygon, CornersInEdgesAreKept) {
  Random random(3, 0);
  // The corners go round a square, starting at each corner in turn: the fan about the first corner would
  // leave some out.
  for (std::size_t first = 0; first < 8; ++first) {
    const std::vector<Vec3> around = {{0, 0, 0}, {0.3, 0, 0}, {1, 0, 0}, {1, 0.6, 0},
                                      {1, 1, 0}, {0.2, 1, 0}, {0, 1, 0}, {0, 0.5, 0}};
    std::vector<Vec3> square;
    for (std::size_t k = 0; k < 8; ++k) square.push_back(around[(first + k) % 8]);
    expect_cut(square, random, 6);
  }
}

TEST(Polygon, CornersThatAreThereTwiceAndWaysBackHaveNoTriangle) {
  Random random(4, 0);
  expect_cut({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, random, 2);
  expect_cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, random, 2);
}

TEST(Polygon, OneThatCrossesItselfIsSaid) {
  const std::vector<Vec3> bow = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1.5, 0}};
  Triangles parts;
  EXPECT_FALSE(cut_polygon(bow, parts));
  EXPECT_EQ(parts.size(), 2u);
}

TEST(Polygon, WithoutAreaItIsAFan) {
  Triangles parts;
  EXPECT_TRUE(cut_polygon(std::vector<Vec3>(5, Vec3(1, 2, 3)), parts));
  EXPECT_EQ(parts.size(), 3u);
  EXPECT_TRUE(
      cut_polygon(std::vector<Vec3>{{0, 0, 0}, {1e200, 0, 0}, {1e200, 1e200, 0}, {0, 1e200, 0}}, parts));
}

}  // namespace
}  // namespace scree
