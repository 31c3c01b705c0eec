#include "render/camera_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree::render {
namespace {

CameraPath way() {
  return CameraPath({{0, {{4, 0, 1}, {0, 0, 0}, Vec3::UnitZ(), 40}},
                     {1, {{0, 4, 2}, {0, 1, 0}, Vec3::UnitZ(), 20}},
                     {4, {{-4, 0, 1}, {1, 1, 1}, Vec3::UnitZ(), 60}}});
}

TEST(Orbit, GoesRoundTheTarget) {
  const Camera start{{3, 1, 2}, {1, 1, 0}, {0, 0, 2}, 40};
  const Camera quarter = orbited(start, pi / 2);
  EXPECT_LT((quarter.from - Vec3(1, 3, 2)).norm(), 1e-14);
  EXPECT_EQ(quarter.to, start.to);
  EXPECT_LT((orbited(start, 2 * pi).from - start.from).norm(), 1e-14);
}

TEST(CameraPath, PassesThroughItsKeysAndRestsOutside) {
  const CameraPath path = way();
  for (const auto& [t, from, fov] :
       {std::tuple(-1.0, Vec3(4, 0, 1), 40.0), std::tuple(0.0, Vec3(4, 0, 1), 40.0),
        std::tuple(1.0, Vec3(0, 4, 2), 20.0), std::tuple(4.0, Vec3(-4, 0, 1), 60.0),
        std::tuple(9.0, Vec3(-4, 0, 1), 60.0)}) {
    EXPECT_LT((path.at(t).from - from).norm(), 1e-13) << t;
    EXPECT_NEAR(path.at(t).fov, fov, 1e-12) << t;
  }
}

TEST(CameraPath, HasNoJumpInVelocity) {
  const CameraPath path = way();
  const double h = 1e-6;
  // One-sided differences err by h/2 times the second derivatives, which are about 20 m/s^2 and
  // 240 degrees/s^2.
  for (const double t : {0.0, 1.0, 4.0}) {
    const Vec3 before = (path.at(t).from - path.at(t - h).from) / h;
    const Vec3 after = (path.at(t + h).from - path.at(t).from) / h;
    EXPECT_LT((after - before).norm(), 1e-4) << t;
    EXPECT_NEAR((path.at(t + h).fov - path.at(t - h).fov) / h, 0, 1e-3) << t;
  }
  // The velocity at the inner key is the tangent of Catmull and Rom.
  const Vec3 velocity = (path.at(1 + h).from - path.at(1 - h).from) / (2 * h);
  EXPECT_LT((velocity - Vec3(-2, 0, 0)).norm(), 1e-5);
}

TEST(CameraPath, TwoKeysGoStraight) {
  const CameraPath path(
      {{0, {{2, 0, 0}, {0, 0, 0}, Vec3::UnitZ(), 40}}, {2, {{4, 0, 0}, {0, 0, 0}, Vec3::UnitZ(), 40}}});
  EXPECT_LT((path.at(1).from - Vec3(3, 0, 0)).norm(), 1e-14);
  EXPECT_LT((path.at(0.5).from - Vec3(2 + 2 * (3 * 0.0625 - 2 * 0.015625), 0, 0)).norm(), 1e-14);
}

}  // namespace
}  // namespace scree::render
