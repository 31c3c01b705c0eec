// Tests of hulls of points that are nearly equal, nearly in a plane, thin, small, large and far away: a few
// sets of each family of the campaign (bench/hulls), and points whose hull is known.
#include "bench/hulls/judge.hpp"
#include "core/error.hpp"
#include "core/geometry.hpp"
#include "core/random_orientation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace scree {
namespace {

using oracle::HullFamily;

/// Returns a cube of 1 m as a lattice of (steps + 1)^3 points.
std::vector<Vec3> lattice(int steps, const Quat& turn) {
  std::vector<Vec3> points;
  for (int x = 0; x <= steps; ++x)
    for (int y = 0; y <= steps; ++y)
      for (int z = 0; z <= steps; ++z) points.push_back(turn * (Vec3(x, y, z) / steps - Vec3::Constant(0.5)));
  return points;
}

std::string refusal_of(const std::vector<Vec3>& points) {
  try {
    make_hull(points);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(AwkwardHulls, SetsOfEachFamilyAreAsTheirExactHulls) {
  for (int f = 0; f < static_cast<int>(HullFamily::count); ++f) {
    const auto family = static_cast<HullFamily>(f);
    for (std::uint64_t n = 0; n < 40; ++n)
      EXPECT_EQ(oracle::judge_hull(oracle::make_points(family, n)).fault, "") << oracle::name_of(family) << n;
  }
}

TEST(AwkwardHulls, AThinPlateWithBevelsKeepsItsThickness) {
  // Qhull fails on these sets: their facets are so narrow that it merges what it must not, or that its
  // normals are noise. Points farther apart than the plate is thick then counted as one.
  for (const std::uint64_t n : {15, 258, 1221, 2563, 3117, 58850})
    EXPECT_EQ(oracle::judge_hull(oracle::make_points(HullFamily::bevels, n)).fault, "") << n;
}

TEST(AwkwardHulls, ATurnedLatticeOfFewDigitsIsACube) {
  Random random(7, 0);
  for (const double digit : {1e-6, 1e-7, 1e-8, 1e-12, 0.0})  // 0 stands for single precision
    for (const int steps : {1, 2, 4, 8}) {
      std::vector<Vec3> points = lattice(steps, random_orientation(random));
      for (Vec3& p : points)
        p = digit > 0 ? Vec3((p / digit).array().round() * digit) : p.cast<float>().cast<double>();
      const Hull hull = make_hull(points);
      EXPECT_EQ(hull.vertices.size(), 8u) << digit << ' ' << steps;
      EXPECT_EQ(hull.faces.size(), 6u) << digit << ' ' << steps;
      EXPECT_NEAR(hull.volume, 1, 5e-6);
    }
}

TEST(AwkwardHulls, PointsInFacesAndEdgesAreNoVertices) {
  // The prism has as many vertices as a hull may have, and more points than that.
  std::vector<Vec3> points;
  for (const double z : {-0.5, 0.0, 0.5})
    for (int k = 0; k < 64; ++k) points.emplace_back(std::cos(2 * pi * k / 64), std::sin(2 * pi * k / 64), z);
  points.emplace_back(0, 0, 0.5);
  const Hull prism = make_hull(points);
  EXPECT_EQ(prism.vertices.size(), 128u);
  EXPECT_EQ(prism.faces.size(), 66u);
  EXPECT_NEAR(prism.volume, 32 * std::sin(2 * pi / 64), 1e-13);
  EXPECT_EQ(make_hull(lattice(8, Quat::Identity())).vertices.size(), 8u);
}

TEST(AwkwardHulls, EqualPointsCountOnce) {
  Random random(8, 0);
  for (const double far : {0.0, 1e-16, 1e-12, 1e-9, 1e-7}) {
    std::vector<Vec3> points;
    for (int k = 0; k < 5; ++k)
      for (const Vec3& corner : lattice(1, Quat::Identity()))
        points.push_back(corner +
                         far * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    const Hull hull = make_hull(points);
    EXPECT_EQ(hull.vertices.size(), 8u) << far;
    EXPECT_EQ(hull.faces.size(), 6u) << far;
  }
}

TEST(AwkwardHulls, SizePlaceAndThinnessDoNotMatter) {
  Random random(9, 0);
  for (const double size : {1e-150, 1e-6, 1.0, 1e6, 1e90})
    for (const double thin : {1.0, 1e-3, 1e-6})
      for (const double away : {0.0, 1e3, 1e6}) {
        if (thin < 1e-9 * away) continue;  // the thickness is lost in the rounding of the coordinates
        const Quat turn = random_orientation(random);
        std::vector<Vec3> points = lattice(2, Quat::Identity());
        for (Vec3& p : points) p = size * (Vec3(away, away, -away) + turn * Vec3(p.x(), p.y(), thin * p.z()));
        const Hull hull = make_hull(points);
        const double rounding = 1e-15 * (away + 1) / thin;
        const double volume = hull.volume / (size * size * size * thin);
        EXPECT_EQ(hull.vertices.size(), 8u) << size << ' ' << thin << ' ' << away;
        if (std::isnormal(size * size * size * thin)) {
          EXPECT_NEAR(volume, 1, 5e-6 + 8 * rounding);
        }
      }
}

TEST(AwkwardHulls, WhatHasNoVolumeIsRefused) {
  Random random(10, 0);
  for (const double thick : {0.0, 1e-16, 1e-12, 1e-9, 2e-8})
    for (const double size : {1e-6, 1.0, 1e6}) {
      const Quat turn = random_orientation(random);
      std::vector<Vec3> plane, line;
      for (const Vec3& p : lattice(3, Quat::Identity())) {
        const double off = thick * random.uniform(-1, 1);
        plane.push_back(size * (turn * Vec3(p.x(), p.y(), off)));
        line.push_back(size * (turn * Vec3(p.x(), off, thick * random.uniform(-1, 1))));
      }
      EXPECT_NE(refusal_of(plane).find("in a plane"), std::string::npos) << thick << ' ' << size;
      EXPECT_NE(refusal_of(line).find("in a plane"), std::string::npos) << thick << ' ' << size;
    }
  EXPECT_NE(refusal_of(std::vector<Vec3>(9, Vec3(1, 2, 3))).find("in a plane"), std::string::npos);
  EXPECT_NE(refusal_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).find("four points"), std::string::npos);
  for (const double bad : {HUGE_VAL, -HUGE_VAL, std::numeric_limits<double>::quiet_NaN()}) {
    std::vector<Vec3> points = lattice(1, Quat::Identity());
    points[3].y() = bad;
    EXPECT_NE(refusal_of(points).find("no finite number"), std::string::npos) << bad;
  }
  const double most = std::numeric_limits<double>::max();
  EXPECT_NE(refusal_of({{-most, 0, 0}, {most, 0, 0}, {0, 1, 0}, {0, 0, 1}}).find("too far apart"),
            std::string::npos);
}

bool are_same(const Hull& a, const Hull& b) {
  bool same = a.volume == b.volume && a.centre == b.centre && a.axes.coeffs() == b.axes.coeffs() &&
              a.vertices == b.vertices && a.corners == b.corners && a.faces.size() == b.faces.size();
  for (std::size_t f = 0; same && f < a.faces.size(); ++f) same = a.faces[f].normal == b.faces[f].normal;
  return same;
}

TEST(AwkwardHulls, ThreadsMakeTheSameBits) {
  constexpr std::uint64_t sets = 20;
  std::array<std::vector<Hull>, 3> hulls;
  const auto make = [](std::vector<Hull>& out) {
    for (std::uint64_t n = 0; n < sets; ++n)
      out.push_back(make_hull(oracle::make_points(HullFamily::digits_6, n).points));
  };
  std::vector<std::thread> threads;
  for (std::size_t t = 1; t < hulls.size(); ++t) threads.emplace_back(make, std::ref(hulls[t]));
  make(hulls[0]);
  for (std::thread& thread : threads) thread.join();
  for (std::size_t n = 0; n < sets; ++n)
    EXPECT_TRUE(are_same(hulls[0][n], hulls[1][n]) && are_same(hulls[0][n], hulls[2][n])) << n;
}

TEST(AwkwardHulls, QhullSaysNothingToTheUser) {
  // At first Qhull fails on this set, with a page of text.
  const auto set = oracle::make_points(HullFamily::clusters, 1530);
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  make_hull(set.points);
  EXPECT_EQ(testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace scree
