#include "render/camera.hpp"

#include "core/rng.hpp"
#include "tests/render/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scree::render {
namespace {

// Returns the largest angle between the view direction and the far side of a ball as a multiple of the
// frustum's half angle, over both axes of the picture; at 1 the ball touches the edge. The test works with
// angles, whereas frame_all works with planes.
double reach_in_picture(const Camera& camera, double aspect, const Vec3& center, double radius) {
  const Mat3 axes = axes_of(camera);
  const Vec3 p = axes.transpose() * (center - camera.from);
  const double tan_y = std::tan(0.5 * camera.fov * pi / 180);
  double reach = 0;
  for (int axis = 0; axis < 2; ++axis) {
    const double half = std::atan(axis == 0 ? tan_y * aspect : tan_y);
    const double in_plane = std::hypot(p[axis], p.z());
    reach = std::max(reach, (std::atan2(std::abs(p[axis]), p.z()) + std::asin(radius / in_plane)) / half);
  }
  return reach;
}

TEST(Camera, AxesAreOrthonormalAndLookAtTheTarget) {
  for (const Vec3& up : {Vec3(0, 0, 1), Vec3(0, 2, 0), Vec3(1, 2, -1)}) {
    const Camera camera{{3, -4, 2}, {1, 1, -1}, up, 40};
    const Mat3 axes = axes_of(camera);
    EXPECT_NEAR((axes.transpose() * axes - Mat3::Identity()).norm(), 0, 1e-14);
    EXPECT_NEAR((axes.col(2) - (camera.to - camera.from).normalized()).norm(), 0, 1e-14);
    EXPECT_GT(axes.col(1).dot(up), 0);
    EXPECT_NEAR(axes.col(0).cross(axes.col(1)).dot(-axes.col(2)), 1, 1e-14);
  }
}

TEST(Camera, MayLookAlongUp) {
  const Mat3 axes = axes_of({{0, 0, 5}, {0, 0, 0}, {0, 0, 1}, 40});
  EXPECT_NEAR((axes.transpose() * axes - Mat3::Identity()).norm(), 0, 1e-14);
}

TEST(Camera, FrameAllSeesEveryBallAndIsTight) {
  for (int seed = 0; seed < 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 0);
    Snapshot snapshot;
    const double scale = std::pow(10.0, random.uniform(-3, 3));
    const Vec3 far(1e5 * scale, -3e4 * scale, 2e5 * scale);
    for (int k = 0; k < 50; ++k) {
      const Vec3 place(random.uniform(-1, 1), random.uniform(-3, 3), random.uniform(0, 2));
      add_sphere(snapshot, far + scale * place, scale * random.uniform(0.01, 0.5));
    }
    const double aspect = seed % 2 == 0 ? 16.0 / 9 : 0.5;
    const Camera camera = frame_all(snapshot, {0, 0, -9.81}, aspect);
    double reach = 0;
    for (std::size_t k = 0; k < 50; ++k) {
      reach = std::max(
          reach, reach_in_picture(camera, aspect, snapshot.bodies.position[k], snapshot.bodies.size[k].x()));
    }
    EXPECT_LT(reach, 1);
    EXPECT_GT(reach, 0.85);
  }
}

TEST(Camera, FrameAllSeesWhereBodiesLand) {
  Snapshot snapshot;
  add_plane(snapshot, Vec3::UnitZ(), 0);
  add_sphere(snapshot, {1, 0, 10}, 0.5);
  const Camera camera = frame_all(snapshot, {0, 0, -9.81}, 1.5);
  EXPECT_LT(reach_in_picture(camera, 1.5, {1, 0, 0.5}, 0.5), 1);
  EXPECT_LT(reach_in_picture(camera, 1.5, {1, 0, 10}, 0.5), 1);
}

TEST(Camera, FrameAllIsNotLedAwayByAHugeFixedBox) {
  Snapshot snapshot;
  add_sphere(snapshot, {0, 0, 1}, 0.5);
  add_body(snapshot, Shape::box, {0, 0, -1}, {500, 500, 1}, Mobility::fixed);
  const Camera camera = frame_all(snapshot, {0, 0, -9.81}, 1.5);
  EXPECT_LT((camera.from - camera.to).norm(), 10);
}

TEST(Camera, FrameAllOfNothingIsACamera) {
  const Camera camera = frame_all({}, Vec3::Zero(), 1.5);
  EXPECT_GT((camera.from - camera.to).norm(), 0);
  EXPECT_TRUE(camera.from.allFinite());
}

}  // namespace
}  // namespace scree::render
