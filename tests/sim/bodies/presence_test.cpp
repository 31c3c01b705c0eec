// Tests of bodies that come and go, against closed forms and the energy accounts.
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace scree {
namespace {

const std::string head = R"(
gravity: [0, 0, -10]
materials: {a: {density: 1000, restitution: 0.3, friction: 0.5}}
)";

Simulation run(const std::string& text) { return simulation_of(head + text); }

TEST(Presence, ABallFallsFreelyOnceItsGateIsGone) {
  Simulation simulation = run(R"(
time: {end: 1, step: 0.01}
bodies:
  - {box: {size: [1, 1, 0.1]}, fixed: true, at: [0, 0, 0.95], until: 0.5, material: a}
  - {sphere: {radius: 0.1}, at: [0, 0, 1.1], material: a}
)");
  while (simulation.steps() < 50) {
    simulation.step();
    ASSERT_NEAR(simulation.body(1).position.z(), 1.1, 1e-3 * 0.1) << "it rests, to a share of its radius";
  }
  EXPECT_EQ(simulation.observe().bodies, 1);
  EXPECT_EQ(simulation.observe().pairs, 0);
  EXPECT_EQ(simulation.observe().exchange.energy, 0) << "a fixed body has no energy";
  const double height = simulation.body(1).position.z();
  run_to_end(simulation);
  EXPECT_NEAR(simulation.body(1).position.z(), height - 5 * 0.5 * 0.5, 1e-12);
}

TEST(Presence, ABodyAppearsInItsStateAndIsBooked) {
  Simulation simulation = run(R"(
time: {end: 1, step: 0.01}
bodies:
  - {sphere: {radius: 0.1}, at: [5, 0, 2], material: a}
  - {sphere: {radius: 0.1}, at: [0, 0, 1], velocity: [3, 0, 4], spin: [0, 7, 0], mass: 2, from: 0.304, until: 0.6, material: a}
)");
  const double energy = 0.5 * 2 * 25 + 0.5 * 0.4 * 2 * 0.01 * 49 + 2 * 10 * 1.0;
  const double first = simulation.observe().total();
  EXPECT_EQ(simulation.observe().bodies, 1);
  EXPECT_TRUE(std::isnan(simulation.body(1).position.x()));
  while (!simulation.finished()) {
    simulation.step();
    const Observation& o = simulation.observe();
    ASSERT_LT(o.unexplained, 1e-13) << o.time;
    const bool there = o.step >= 30 && o.step < 60;  // 0.304 is nearest to 0.30
    ASSERT_EQ(o.bodies, there ? 2 : 1);
    if (!there) {
      ASSERT_TRUE(std::isnan(simulation.body(1).velocity.z()));
      continue;
    }
    const double t = simulation.time() - 0.3;
    const BodyState ball = simulation.body(1);
    ASSERT_LT((ball.position - Vec3(3 * t, 0, 1 + 4 * t - 5 * t * t)).norm(), 1e-13);
    ASSERT_LT(ball.force.norm(), 1e-12);  // rounding of m (dv / h - g)
    ASSERT_NEAR(o.exchange.energy, energy, 1e-12);
    ASSERT_NEAR(o.total(), first + energy, 1e-11);
    ASSERT_LT((o.exchange.momentum - 2 * Vec3(3, 0, 4)).norm(), 1e-14);
  }
  // The body took away as much as it had brought, except the momentum that gravity gave it.
  EXPECT_NEAR(simulation.observe().exchange.energy, 0, 1e-12);
  EXPECT_LT((simulation.observe().exchange.momentum - Vec3(0, 0, 2 * 10 * 0.3)).norm(), 1e-12);
}

TEST(Presence, AbsentBodiesTouchNothing) {
  // The wall, the plane and the second ball in the way of the ball come too late.
  Simulation simulation = run(R"(
time: {end: 1, step: 0.01}
bodies:
  - {sphere: {radius: 0.1}, velocity: [1, 0, 10], material: a}
  - {box: {size: 1}, fixed: true, at: [0, 0, 1], from: 0.9, material: a}
  - {plane: {normal: [0, 0, -1], offset: -0.3}, from: 0.9, material: a}
  - {sphere: {radius: 0.2}, at: [0.05, 0, 0.2], from: 0.99, until: 3, material: a}
)");
  while (simulation.steps() < 89) {
    simulation.step();
    const double t = simulation.time();
    ASSERT_LT((simulation.body(0).position - Vec3(t, 0, 10 * t - 5 * t * t)).norm(), 1e-13);
    ASSERT_EQ(simulation.observe().penetration.max, 0);
    ASSERT_EQ(simulation.observe().pairs, 0);
  }
}

const std::string coming_and_going = R"(
time: {end: 0.6, step: 0.005, substeps: 2}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: [2, 2, 0.1]}, fixed: true, at: [0.2, 0.2, 0.3], until: 0.3, material: a}
  - {box: {size: [0.4, 0.05, 0.1]}, at: [0.2, 0.2, 0.4], motion: {spin: [0, 0, 5], about: [0, 0.2, 0]}, from: 0.1, until: 0.5, material: a}
  - {sphere: {radius: 0.05}, at: [0, 0, 0.4], repeat: {count: [4, 4, 2], spacing: [0.11, 0.11, 0.11], jitter: 0.004}, until: 0.45, material: a}
  - {box: {size: [0.1, 0.08, 0.06]}, at: [0, 0, 0.7], spin: [3, 2, 1], repeat: {count: [3, 3, 2], spacing: [0.13, 0.13, 0.13], jitter: 0.004}, from: 0.15, material: a}
)";

TEST(Presence, BooksBalanceInAHeapThatComesAndGoes) {
  Simulation simulation = run(coming_and_going);
  std::int64_t fewest = simulation.observe().bodies;
  while (!simulation.finished()) {
    simulation.step();
    ASSERT_LT(simulation.observe().unexplained, 1e-12) << simulation.time();
    fewest = std::min(fewest, simulation.observe().bodies);
  }
  EXPECT_EQ(fewest, 1 + 18);
  EXPECT_NE(simulation.observe().exchange.energy, 0);
}

TEST(Presence, SameBitsForAnyBroadPhase) {
  const auto hash = [](const std::string& more) {
    Simulation simulation = run(coming_and_going + more);
    run_to_end(simulation);
    return simulation.state_hash();
  };
  const std::uint64_t grid = hash("");
  EXPECT_EQ(grid, hash("broadphase: {method: brute_force}\n"));
  EXPECT_EQ(grid, hash("broadphase: {method: alternative_grid}\n"));
  EXPECT_EQ(grid, hash("broadphase: {method: uniform_grid}\n"));
  EXPECT_EQ(grid, hash("broadphase: {method: sweep_and_prune}\n"));
  EXPECT_EQ(grid, hash("broadphase: {method: lbvh}\n"));
}

TEST(Presence, MotionStartsWhenTheBodyAppears) {
  Simulation simulation = run(R"(
time: {end: 1, step: 0.01}
bodies:
  - {sphere: {radius: 0.1}, at: [2, 0, 0], motion: {velocity: [0, 0, 1], spin: [0, 0, 3], about: [1, 0, 0]}, from: 0.4, material: a}
)");
  while (simulation.steps() < 40) simulation.step();
  EXPECT_EQ(simulation.body(0).position, Vec3(2, 0, 0));
  run_to_end(simulation);
  const double t = 0.6;
  EXPECT_LT((simulation.body(0).position - Vec3(1 + std::cos(3 * t), std::sin(3 * t), t)).norm(), 1e-14);
}

TEST(Presence, LayersThatComeOneAfterTheOtherMayShareTheirPlace) {
  // Each layer fills its region so far that a second one would not fit beside it.
  const Scene scene = scene_of(head + R"(
time: {end: 1, step: 0.01}
bodies:
  - {sphere: {radius: 0.1}, scatter: {count: 40, from: [0, 0, 0], to: [0.8, 0.8, 0.8]}, material: a}
  - {sphere: {radius: 0.1}, scatter: {count: 40, from: [0, 0, 0], to: [0.8, 0.8, 0.8]}, from: 0.5, material: a}
)");
  const auto least_distance = [&](std::size_t first, std::size_t last) {
    double least = HUGE_VAL;
    for (std::size_t i = first; i < last; ++i)
      for (std::size_t j = first; j < i; ++j)
        least = std::min(least, (scene.bodies.position[i] - scene.bodies.position[j]).norm());
    return least;
  };
  EXPECT_GE(least_distance(0, 40), 0.2);
  EXPECT_GE(least_distance(40, 80), 0.2);
  EXPECT_LT(least_distance(0, 80), 0.2);
}

}  // namespace
}  // namespace scree
