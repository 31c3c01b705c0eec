// Tests of prescribed motion against its closed form.
#include "sim/bodies/prescribed.hpp"

#include "sim/bodies/motion.hpp"
#include "sim/pairs/fat_boxes.hpp"
#include "sim/scene/motion_bounds.hpp"
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace scree {
namespace {

const std::string materials = "materials: {a: {density: 1000, friction: 0.5}}\n";

// A turn about z has the closed form x = p + V t + r (cos, sin); here 1000 turns take 7000 steps, which
// divide no turn.
TEST(Prescribed, ABodyTurnsAboutAPointForThousandsOfStepsWithoutDrift) {
  Simulation simulation = simulation_of(materials + R"(
time: {end: 1000, step: 0.143, substeps: 3}
bodies:
  - box: {size: [0.4, 0.2, 0.1]}
    at: [3, 1, 5]
    motion: {velocity: [0.01, -0.02, 0.005], spin: [0, 0, 6.283185307179586], about: [1, 1, 0]}
    material: a
)");
  const double w = 2 * pi;
  // The rounding error of angles of up to 6283 rad is 1e-12.
  while (!simulation.finished()) {
    simulation.step();
    const double t = simulation.time();
    const BodyState body = simulation.body(0);
    const Vec3 line = Vec3(0.01, -0.02, 0.005) * t;
    const Vec3 arm(2 * std::cos(w * t), 2 * std::sin(w * t), 5);
    ASSERT_LT((body.position - (Vec3(1, 1, 0) + line + arm)).norm(), 1e-11) << t;
    ASSERT_LT((body.velocity - Vec3(0.01, -0.02, 0.005) - Vec3(-w * arm.y(), w * arm.x(), 0)).norm(), 1e-10);
    ASSERT_EQ(body.spin, Vec3(0, 0, w));
    const Vec3 axis = body.orientation * Vec3::UnitX();
    ASSERT_LT((axis - Vec3(std::cos(w * t), std::sin(w * t), 0)).norm(), 1e-11);
    ASSERT_NEAR((body.position - line - Vec3(1, 1, 5)).norm(), 2, 1e-13);
  }
}

TEST(Prescribed, TheSceneSaysTheVelocityAtTheStart) {
  const Scene scene = scene_of(materials + R"(
time: {end: 1, step: 0.1}
bodies:
  - {sphere: {radius: 0.1}, at: [2, 0, 0], motion: {velocity: [0, 0, 1], spin: [0, 0, 3], about: [0, 0, 0]}, material: a}
  - {sphere: {radius: 0.1}, at: [9, 0, 0], motion: {velocity: [0, 0, 1], spin: [0, 0, 3]}, material: a}
  - {sphere: {radius: 0.1}, at: [2, 2, 0], repeat: {count: [2, 1, 1], spacing: [1, 0, 0]}, motion: {spin: [0, 0, 3], about: [0, 2, 0]}, material: a}
)");
  EXPECT_EQ(scene.bodies.velocity[0], Vec3(0, 6, 1));
  EXPECT_EQ(scene.bodies.velocity[1], Vec3(0, 0, 1));
  EXPECT_EQ(scene.bodies.velocity[2], Vec3(0, 6, 0));
  EXPECT_EQ(scene.bodies.velocity[3], Vec3(0, 9, 0));
  Simulation simulation(scene, one_thread);
  simulation.step();
  EXPECT_NEAR(simulation.body(0).velocity.x(), -6 * std::sin(0.3), 1e-14);
}

// At the top speed of its turn, a smooth wall on a long arm strikes a ball that rests in its way. The contact
// is solved at the midpoint with the wall's velocity there, and the work that it does is accounted to
// rounding.
TEST(Prescribed, APaddleOnAnArmDrivesABallAtItsOwnSpeed) {
  Simulation simulation = simulation_of(materials + R"(
time: {end: 0.3, step: 0.002}
model: {friction: off}
bodies:
  - {box: {size: [0.2, 0.02, 0.4]}, at: [1, -0.2, 0], motion: {spin: [0, 0, 2], about: [0, -0.2, 0]}, material: a}
  - {sphere: {radius: 0.05}, at: [1, 0, 0], material: a}
)");
  double fastest = 0;
  while (!simulation.finished()) {
    simulation.step();
    ASSERT_LT(simulation.observe().unexplained, 1e-12) << simulation.time();
    fastest = std::max(fastest, simulation.body(1).velocity.norm());
  }
  EXPECT_GT(fastest, 1.9);
  EXPECT_LT(fastest, 2.4);
  EXPECT_GT(simulation.observe().ledger.work, 0);
}

/// Returns where the prescribed motions of a scene are at a time, by the text of its bodies.
BodyTable placed(const Scene& scene, double time) {
  Bodies<Host> bodies;
  copy_bodies(bodies, scene.bodies);
  place_prescribed(PrescribedPaths<Host>(prescribed_paths(scene)), time, bodies);
  BodyTable table;
  copy_bodies(table, bodies);
  return table;
}

/// Compares velocities and spins with the differences of places and orientations at two near times.
void expect_derivatives(const Scene& scene, double from, double to) {
  constexpr double h = 1e-5;
  const double bound = 1e-7;
  for (double t = from; t < to; t += 0.0371) {
    const BodyTable before = placed(scene, t - h);
    const BodyTable now = placed(scene, t);
    const BodyTable after = placed(scene, t + h);
    for (std::size_t k = 0; k < now.position.size(); ++k) {
      const Vec3 velocity = (after.position[k] - before.position[k]) / (2 * h);
      Quat turn = after.orientation[k] * before.orientation[k].conjugate();
      if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
      ASSERT_LT((now.velocity[k] - velocity).norm(), bound * (1 + velocity.norm())) << k << " at " << t;
      ASSERT_LT((now.spin[k] - turn.vec() / h).norm(), bound * (1 + now.spin[k].norm())) << k << " at " << t;
    }
  }
}

TEST(Prescribed, WhatOscillatesIsWhereItsSineSays) {
  const Scene scene = scene_of(materials + R"(
time: {end: 1, step: 0.1}
bodies:
  - {box: {size: 1}, at: [3, 0, 0], motion: {velocity: [1, 2, 3], spin: [0, 0, 2], about: [1, 0, 0], oscillate: {displacement: [0, 0, 0.5], angle: [0, 0, -0.7], frequency: 1.5, phase: 0.3}}, material: a}
  - {box: {size: 1}, at: [0, 9, 0], rotate: {axis: [1, 1, 0], degrees: 30}, motion: {oscillate: {angle: [0.1, 0.2, -0.3], frequency: 0.25}}, material: a}
)");
  EXPECT_EQ(placed(scene, 0).position[0], scene.bodies.position[0]);
  EXPECT_LT((placed(scene, 0).velocity[0] - scene.bodies.velocity[0]).norm(), 1e-13);
  const double t = 1.23;
  const double share = std::sin(3 * pi * t + 0.3) - std::sin(0.3);
  const double angle = 2 * t - 0.7 * share;
  const Vec3 place = Vec3(1, 0, 0) + Vec3(1, 2, 3) * t + Vec3(0, 0, 0.5) * share +
                     2 * Vec3(std::cos(angle), std::sin(angle), 0);
  EXPECT_LT((placed(scene, t).position[0] - place).norm(), 1e-13);
  expect_derivatives(scene, 0, 3);
}

/// The keys are at irregular times: at one the motion goes on, at one it turns round, at one it stays; the
/// turns are about different axes.
TEST(Prescribed, KeyframesArePassedSmoothlyAndNeverOvershot) {
  const Scene scene = scene_of(materials + R"(
time: {end: 1, step: 0.1}
bodies:
  - box: {size: 1}
    motion:
      keyframes:
        - {at: 0.5, position: [0, 0, 0], orientation: [1, 0, 0, 0]}
        - {at: 1.5, position: [1, 2, 0], rotate: {axis: [0, 0, 1], degrees: 80}}
        - {at: 1.9, position: [4, 1, 0], rotate: {axis: [0, 1, 1], degrees: 120}}
        - {at: 3.0, position: [5, 1, 0], rotate: {axis: [1, 2, 3], degrees: -170}}
        - {at: 3.2, position: [9, 5, -1], rotate: {axis: [1, 0, 0], degrees: 10}}
    material: a
)");
  const std::vector<MotionKey>& keys = scene.motions[0].keyframes;
  for (const MotionKey& key : keys) {
    const BodyTable at = placed(scene, key.at);
    EXPECT_LT((at.position[0] - key.position).norm(), 1e-14);
    EXPECT_LT(at.orientation[0].angularDistance(*key.orientation), 1e-7);
    // The velocity and the spin are continuous at the key.
    EXPECT_LT((placed(scene, key.at + 1e-9).velocity[0] - placed(scene, key.at - 1e-9).velocity[0]).norm(),
              1e-5);
    EXPECT_LT((placed(scene, key.at + 1e-9).spin[0] - placed(scene, key.at - 1e-9).spin[0]).norm(), 1e-5);
  }
  const MotionBounds bounds = bounds_of(scene.motions[0]);
  for (std::size_t k = 1; k < keys.size(); ++k) {
    for (double u = 0; u <= 1; u += 0.01) {
      const BodyTable at = placed(scene, keys[k - 1].at + u * (keys[k].at - keys[k - 1].at));
      const Vec3 low = keys[k - 1].position.cwiseMin(keys[k].position);
      const Vec3 high = keys[k - 1].position.cwiseMax(keys[k].position);
      ASSERT_GT((at.position[0] - low).minCoeff(), -1e-13);
      ASSERT_GT((high - at.position[0]).minCoeff(), -1e-13);
      ASSERT_LE(at.velocity[0].norm(), bounds.speed);
      ASSERT_LE(at.spin[0].norm(), bounds.spin);
    }
  }
  expect_derivatives(scene, 0.6, 3.15);
  for (const double outside : {0.0, 0.4999, 3.2001, 99.0}) {
    EXPECT_EQ(placed(scene, outside).velocity[0], Vec3(0, 0, 0));
    EXPECT_EQ(placed(scene, outside).spin[0], Vec3(0, 0, 0));
  }
}

/// Turns about one axis follow Hermite's cubic of the angle, whose rates at the keys are harmonic means.
TEST(Prescribed, TurnsAboutOneAxisFollowTheCubicOfTheirAngle) {
  const Scene scene = scene_of(materials + R"(
time: {end: 1, step: 0.1}
bodies:
  - box: {size: 1}
    motion: {keyframes: [{at: 0, position: [0, 0, 0], rotate: {axis: [0, 0, 1], degrees: 0}},
                         {at: 1, position: [90, 0, 0], rotate: {axis: [0, 0, 1], degrees: 90}},
                         {at: 3, position: [120, 0, 0], rotate: {axis: [0, 0, 1], degrees: 120}}]}
    material: a
)");
  // The rate at the key is the harmonic mean with weight (1 + 2 . 2) / (3 . 3) for the rate before it, and
  // the rest for the rate after it.
  EXPECT_NEAR(placed(scene, 1).velocity[0].x(), 1 / ((5.0 / 9) / 90 + (4.0 / 9) / 15), 1e-12);
  for (const double t : {0.3, 0.8, 1.0, 1.7, 2.9}) {
    const BodyTable at = placed(scene, t);
    EXPECT_NEAR(at.spin[0].z(), at.velocity[0].x() * pi / 180, 1e-13);
    EXPECT_NEAR(2 * std::atan2(at.orientation[0].z(), at.orientation[0].w()), at.position[0].x() * pi / 180,
                1e-13);
  }
}

/// The margins of prescribed bodies hold their travel in a step, also from rest.
TEST(Prescribed, MarginsKnowHowFastTheyGetFaster) {
  const Scene scene = scene_of(materials + R"(
time: {end: 1, step: 0.02}
bodies:
  - {box: {size: 0.1}, motion: {oscillate: {displacement: [0, 0, 1], frequency: 2, phase: 1.5707963267948966}}, material: a}
  - {box: {size: [2, 0.1, 0.1]}, motion: {oscillate: {angle: [0, 0, 1], frequency: 2, phase: 1.5707963267948966}}, material: a}
)");
  Bodies<Host> bodies;
  copy_bodies(bodies, scene.bodies);
  ResponseParameters parameters;
  parameters.prescribed_acceleration = prescribed_acceleration(scene);
  Array<double, Host> margin;
  contact_margins<Host>(bodies, 0.02, 0, parameters, {}, margin);
  const double share = 1 - std::cos(4 * pi * 0.02);
  EXPECT_GT(std::as_const(margin).view()[0], share);
  EXPECT_GT(std::as_const(margin).view()[1], 2 * std::sin(share / 2));
  EXPECT_LT(std::as_const(margin).view()[0], 10 * share);
}

}  // namespace
}  // namespace scree
