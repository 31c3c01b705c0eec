// Tests of gravity that turns, servos, and floors that shake, against closed forms, by each way of taking
// steps.
#include "sim/scene/motion_bounds.hpp"
#include "tests/sim/ways.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace scree {
namespace {

class MotionAndForces : public WayTest {};

void expect_explained(Simulation& run) {
  while (!run.finished()) {
    run.step();
    ASSERT_LT(run.observe().unexplained, 1e-9) << run.time();
  }
}

/// The exact path is x = g / W^2 (W t - sin W t), z = -g / W^2 (1 - cos W t). The error is of second order in
/// the length of the substeps.
TEST_P(MotionAndForces, ABallFallsAsGravityTurns) {
  const auto error = [this](const char* time) {
    Simulation run =
        simulate(std::string("gravity: {vector: [0, 0, -10], spin: [0, -2, 0]}\ntime: ") + time +
                 "\nmaterials: {a: {}}\nbodies: [{sphere: {radius: 0.1}, at: [5, 0, 7], material: a}]\n");
    expect_explained(run);
    const Vec3 exact = Vec3(5, 0, 7) + 2.5 * Vec3(2 - std::sin(2.0), 0, -(1 - std::cos(2.0)));
    EXPECT_LT(run.body(0).force.norm(), 1e-8) << "by contacts, of which there are none";
    return (run.body(0).position - exact).norm();
  };
  const double coarse = error("{end: 1, step: 0.02}");
  EXPECT_LT(coarse, 6e-4);
  EXPECT_NEAR(coarse / error("{end: 1, step: 0.01}"), 4, 0.1);
  EXPECT_NEAR(coarse / error("{end: 1, step: 0.02, substeps: 2}"), 4, 0.1);
}

/// As gravity changes, so does potential energy at fixed places: the energy that a heap at rest gains is
/// work, and nothing else.
TEST_P(MotionAndForces, TheWorkOfGravityThatChangesIsBooked) {
  Simulation run = simulate(R"(
gravity: {keyframes: [{at: 0.1, vector: [0, 0, -10]}, {at: 0.3, vector: [0, 0, -4]}]}
time: {end: 0.4, step: 0.01}
materials: {a: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1]}, name: floor, material: a}
  - {box: {size: 0.2}, at: [0, 0, 0.1], material: a}
  - {box: {size: 0.2}, at: [0, 0, 0.3], from: 0.2, material: a}
checks:
  - {measure: floor.force.z, below: 1}
)");
  expect_explained(run);
  // Gravity falls to 4 m/s^2: for the first box (8 kg, at 0.1 m) from 10 m/s^2, and for the second (at 0.3 m)
  // from the 7 m/s^2 of the step in which it comes, or of the substep before that.
  const double change = 0.01 * 30;
  EXPECT_NEAR(run.observe().ledger.work, -8 * (0.1 * 6 + 0.3 * 3), 8 * 0.3 * change);
  EXPECT_NEAR(run.observe().potential, 8 * 4 * 0.4, 1e-3);
  EXPECT_NEAR(run.body(0).force.z(), -16 * 4, 1e-3);
}

/// A ball that lies on a floor that shakes by less than g stays on it; the floor does work, and gravity takes
/// it.
TEST_P(MotionAndForces, WhatLiesOnAFloorThatShakesGentlyStays) {
  Simulation run = simulate(R"(
gravity: [0, 0, -9.81]
time: {end: 1, step: 0.001}
materials: {a: {density: 1000, friction: 0.3}}
bodies:
  - {box: {size: [1, 1, 0.2]}, motion: {oscillate: {displacement: [0.02, 0, 0.03], frequency: 2.5}}, material: a}
  - {sphere: {radius: 0.05}, at: [0, 0, 0.15], material: a}
  - {box: {size: 0.1}, at: [0.3, 0, 0.15], material: a}
)");
  while (!run.finished()) {
    run.step();
    ASSERT_LT(run.observe().unexplained, 1e-9) << run.time();
    const double floor = run.body(0).position.z() + 0.1;
    ASSERT_NEAR(run.body(1).position.z(), floor + 0.05, 2e-5) << run.time();
    ASSERT_NEAR(run.body(2).position.z(), floor + 0.05, 2e-5) << run.time();
  }
  EXPECT_GT(std::abs(run.observe().ledger.work), 1e-3);
}

/// A servo pushes the uppermost cube of a tower down and aside along an oblique axis, without friction and
/// with it. The guide bears the forces across the axis, and the servo does not move sideways. Without
/// friction the normal force N obeys n.a N = F.
TEST_P(MotionAndForces, AServoHoldsItsForceAndItsGuideTheRest) {
  if (std::string(GetParam().settings).find("mixed") != std::string::npos) GTEST_SKIP() << "is refused";
  for (const double friction : {0.0, 0.4}) {
    Simulation run = simulate(R"(
gravity: [0, 0, -9.81]
time: {end: 0.6, step: 0.002}
materials: {a: {density: 1000, friction: )" +
                              std::to_string(friction) +
                              R"(}}
bodies:
  - {plane: {normal: [0, 0, 1]}, name: floor, material: a}
  - {box: {size: 0.2}, at: [0, 0, 0.1], repeat: {count: [1, 1, 6], spacing: [0, 0, 0.2]}, material: a}
  - {box: {size: 0.2}, name: press, mass: 0.5, at: [0, 0, 1.3], servo: {axis: [0.28, 0, -0.96], force: 96}, material: a}
  - {sphere: {radius: 0.05}, at: [0, 0, 3], velocity: [0, 0, -2], material: a}
checks:
  - {measure: floor.force.z, below: 1}
)");
    const Vec3 axis(0.28, 0, -0.96);
    for (int step = 0; step < 100; ++step) {
      run.step();
      ASSERT_LT(run.observe().unexplained, 1e-9);
      ASSERT_LT(run.body(7).position.cross(axis).norm() - 1.3 * 0.28, 1e-12) << "stays on its line";
      ASSERT_EQ(run.body(7).spin, Vec3(0, 0, 0));
    }
    if (friction == 0) {
      EXPECT_NEAR(run.body(0).force.z(), -(100 + 48 * 9.81), 1e-4);
    }
    EXPECT_NEAR(run.body(7).force.dot(axis), -96, 1e-5);
    expect_explained(run);
    EXPECT_LT(run.body(7).velocity.cross(axis).norm(), 1e-13);
  }
}

/// In an impact the piston counts with its mass along the axis alone, whatever the normal is: against a wall
/// with the slope n, u+ = -e u- makes v+ = -e v-. Friction there stops more of the motion, and never adds to
/// it.
TEST_P(MotionAndForces, AServoBouncesAlongItsAxis) {
  if (std::string(GetParam().settings).find("mixed") != std::string::npos) GTEST_SKIP() << "is refused";
  const auto speed_after = [this](const std::string& law) {
    Simulation run = simulate(
        "gravity: [0, 0, -9.81]\ntime: {end: 0.55, step: 0.001}\nmaterials: {a: {density: 1000, " + law +
        R"(}}
bodies:
  - {box: {size: 0.1}, mass: 2, servo: {axis: [0.6, 0, -0.8], force: 8}, material: a}
  - {box: {size: [1, 1, 0.1]}, at: [0.3, 0, -0.5], fixed: true, material: a}
)");
    expect_explained(run);
    EXPECT_LT(run.body(0).position.cross(Vec3(0.6, 0, -0.8)).norm(), 1e-12);
    return run.body(0).velocity.dot(Vec3(0.6, 0, -0.8));
  };
  // The piston strikes after 0.5 m, at 0.5 s, with 2 m/s; then it has 0.05 s more at 4 m/s^2.
  EXPECT_NEAR(speed_after("restitution: 1"), -2 + 0.2, 1e-9);
  EXPECT_NEAR(speed_after("restitution: 0.5"), -1 + 0.2, 1e-9);
  EXPECT_GT(speed_after("restitution: 0.5, friction: 0.3"), -1 + 0.2 - 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Ways, MotionAndForces, testing::ValuesIn(double_ways()), way_name);

TEST(GravityTurn, GravityGoesStraightBetweenKeyframesAndRestsOutside) {
  const GravityTurn turn{.keyframes = {{1, Vec3(0, 0, -2)}, {3, Vec3(4, 0, 0)}, {4, Vec3(0, 0, 0)}}};
  EXPECT_EQ(gravity_at(turn, Vec3(9, 9, 9), 0), Vec3(0, 0, -2));
  EXPECT_EQ(gravity_at(turn, Vec3(9, 9, 9), 1.5), Vec3(1, 0, -1.5));
  EXPECT_EQ(gravity_at(turn, Vec3(9, 9, 9), 3), Vec3(4, 0, 0));
  EXPECT_EQ(gravity_at(turn, Vec3(9, 9, 9), 5), Vec3(0, 0, 0));
  const GravityTurn spin{.spin = Vec3(0, 0, pi)};
  EXPECT_LT((gravity_at(spin, Vec3(1, 0, -3), 0.5) - Vec3(0, 1, -3)).norm(), 1e-15);
}

}  // namespace
}  // namespace scree
