// Prescribed motion against its closed form.
#include "sim/dynamics/prescribed.hpp"

#include "tests/sim/dynamics/simulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace scree {
namespace {

const std::string materials = "materials: {a: {density: 1000, friction: 0.5}}\n";

// A turn about z: x = p + V t + r (cos, sin), 1000 turns in 7000 steps that divide no turn.
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
  // Angles of up to 6283 rad are rounded by 1e-12.
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

// A smooth wall on a long arm strikes a ball that rests in its way, at the top speed of its turn: the contact
// is solved at the midpoint with the wall's velocity there, and the work it does is booked to rounding.
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

}  // namespace
}  // namespace scree
