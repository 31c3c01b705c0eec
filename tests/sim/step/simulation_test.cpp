// Tests of the whole step: of what must not depend on how it is computed, and of laws that hold for any
// scene.
#include "sim/step/simulation.hpp"

#include "core/error.hpp"
#include "core/tolerances.hpp"
#include "sim/model/model.hpp"
#include "tests/sim/step/simulations.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace scree {
namespace {

const std::string heap = R"(
gravity: [0, 0, -9.81]
time: {end: 0.5, step: 0.005}
materials: {a: {density: 1000, restitution: 0.3, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {sphere: {radius: 0.06}, at: [0, 0, 0.1], repeat: {count: [5, 5, 4], spacing: [0.13, 0.13, 0.13], jitter: 0.004}, material: a}
  - {box: {size: [0.1, 0.12, 0.14]}, at: [0, 0, 0.7], repeat: {count: [4, 4, 3], spacing: [0.17, 0.17, 0.17], jitter: 0.004}, material: a}
)";

std::uint64_t hash_after(const Scene& scene, int steps, const SimulationOptions& options = {}) {
  Simulation simulation(scene, options);
  for (int k = 0; k < steps && !simulation.finished(); ++k) simulation.step();
  return simulation.state_hash();
}

BodyTable state_after(const Scene& scene, int steps) {
  Simulation simulation(scene, one_thread);
  for (int k = 0; k < steps && !simulation.finished(); ++k) simulation.step();
  Snapshot snapshot;
  simulation.snapshot(snapshot);
  return snapshot.bodies;
}

TEST(Simulation, SameBitsForAnyNumberOfThreads) {
  const Scene scene = scene_of(heap);
  const std::uint64_t one = hash_after(scene, 50, one_thread);
  EXPECT_EQ(one, hash_after(scene, 50, {SpaceChoice::host, 2}));
  EXPECT_EQ(one, hash_after(scene, 50, {SpaceChoice::host, 4}));
  EXPECT_EQ(one, hash_after(scene, 50, one_thread));
}

TEST(Simulation, SameBitsForAnyNumberOfThreadsWhereIslandsAreSolvedDirectly) {
  const Scene scene = scene_of(R"(
gravity: [0, 0, -9.81]
time: {end: 0.1, step: 0.005}
response: {mode: accurate}
materials: {a: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: 0.1}, at: [0, 0, 0.05], repeat: {count: [4, 4, 5], spacing: [0.2, 0.2, 0.1]}, material: a}
  - {box: {size: 0.1}, at: [0, 0, 0.55], mass: 5000, repeat: {count: [4, 4, 1], spacing: [0.2, 0.2, 0.1]}, material: a}
)");
  Simulation one(scene, one_thread);
  run_to_end(one);
  EXPECT_GT(one.observe().counters.direct, 0);
  for (const int threads : {2, 4, 1}) {
    EXPECT_EQ(one.state_hash(), hash_after(scene, 1000, {SpaceChoice::host, threads})) << threads;
  }
}

TEST(Simulation, WhatSlidesSticksAtItsInstantWhateverTheStep) {
  // A cube at 2 m/s with mu = 0.4 stops after v^2 / (2 mu g).
  for (const double step : {0.05, 0.02, 0.003}) {
    Simulation simulation = simulation_of(fmt::format(R"(
gravity: [0, 0, -9.81]
time: {{end: 0.6, step: {}}}
response: {{mode: accurate}}
materials: {{a: {{density: 1000, friction: 0.4}}}}
bodies:
  - {{plane: {{normal: [0, 0, 1], offset: 0}}, material: a}}
  - {{box: {{size: 1}}, at: [0, 0, 0.5], velocity: [1.6, 1.2, 0], material: a}}
)",
                                                      step));
    run_to_end(simulation);
    const Vec3 end = simulation.body(1).position - Vec3(0, 0, 0.5);
    EXPECT_LT((end - 4 / (2 * 0.4 * 9.81) * Vec3(0.8, 0.6, 0)).norm(), 1e-13) << step;
    EXPECT_GE(simulation.observe().counters.cuts, 1);
    EXPECT_LE(simulation.observe().counters.cuts, 3);
  }
}

/// Balls that roll against couples are not solved by Newton's method, and one sweep does not solve them. The
/// cube still stops where it must.
TEST(Simulation, WhatSlidesSticksAtItsInstantBesideImpulsesThatHaveNotConverged) {
  Simulation simulation = simulation_of(R"(
gravity: [0, 0, -9.81]
time: {end: 0.6, step: 0.05}
response: {mode: accurate, iterations: 1}
materials:
  a: {density: 1000, friction: 0.4}
  r: {density: 1000, friction: 0.8, rolling_friction: 0.02}
contacts:
  - {between: [a, r], friction: 0.8, rolling_friction: 0.02}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: 1}, at: [0, 0, 0.5], velocity: [1.6, 1.2, 0], material: a}
  - {sphere: {radius: 0.1}, at: [0, -4, 0.1], velocity: [1, 0, 0], material: r}
  - {sphere: {radius: 0.1}, at: [0.21, -4, 0.1], velocity: [0.9, 0, 0], material: r}
  - {sphere: {radius: 0.1}, at: [0.105, -4, 0.271], velocity: [0.95, 0, 0], material: r}
)");
  run_to_end(simulation);
  const Vec3 end = simulation.body(1).position - Vec3(0, 0, 0.5);
  EXPECT_LT((end - 4 / (2 * 0.4 * 9.81) * Vec3(0.8, 0.6, 0)).norm(), 1e-13);
  EXPECT_GT(simulation.observe().counters.unconverged, 0);
}

TEST(Simulation, SameBitsForAnyBroadPhase) {
  const std::uint64_t grid = hash_after(scene_of(heap), 50, one_thread);
  for (const char* method : {"alternative_grid", "uniform_grid", "sweep_and_prune", "lbvh", "brute_force"}) {
    const Scene scene = scene_of(heap + "broadphase: {method: " + method + "}\n");
    EXPECT_EQ(grid, hash_after(scene, 50, one_thread)) << method;
  }
}

TEST(Simulation, LedgerExplainsTheEnergyAndNothingIsCreated) {
  Simulation simulation(scene_of(heap), one_thread);
  while (!simulation.finished()) {
    simulation.step();
    const Observation& o = simulation.observe();
    ASSERT_LT(o.unexplained, 1e-12) << "t = " << o.time;
  }
  const Observation& o = simulation.observe();
  EXPECT_GT(o.ledger.restitution, 0);
  EXPECT_GT(o.ledger.friction, 0);
  EXPECT_GT(o.contacts, 50);
}

TEST(Simulation, MomentumIsConservedWithoutGravityAndWalls) {
  Scene scene = scene_of(R"(
gravity: [0, 0, 0]
time: {end: 1, step: 0.005}
materials: {a: {density: 1000, restitution: 0.5, friction: 0.4}}
bodies:
  - {sphere: {radius: 0.1}, at: [-1, 0.05, 0], velocity: [3, 0, 0.1], spin: [0, 5, 9], material: a}
  - {box: {size: [0.3, 0.2, 0.4]}, at: [0, 0, 0], spin: [1, 0.5, 0], material: a}
  - {box: {size: [0.2, 0.2, 0.4]}, at: [0.5, 0.1, 0.1], velocity: [-1, 0, 0], material: a}
)");
  Simulation simulation(scene, one_thread);
  const Vec3 p0 = simulation.observe().momentum;
  const Vec3 l0 = simulation.observe().angular_momentum;
  run_to_end(simulation);
  const Observation& o = simulation.observe();
  EXPECT_GT(o.ledger.restitution, 0) << "nothing met";
  EXPECT_LT((o.momentum - p0).norm(), 1e-13 * p0.norm());
  // The motion by position correction is accounted.
  EXPECT_LT((o.angular_momentum - o.ledger.angular_correction - l0).norm(), 1e-12 * l0.norm());
}

TEST(Simulation, WorkOfAPrescribedBodyIsBooked) {
  Simulation simulation = simulation_of(R"(
gravity: [0, 0, -9.81]
time: {end: 2, step: 0.005}
materials: {a: {density: 1000, restitution: 0.2, friction: 0.5}}
bodies:
  - {box: {size: [1, 1, 0.1]}, at: [0, 0, 0], motion: {velocity: [0.1, 0, 0.5], spin: [0, 0, 0.6]}, material: a}
  - {sphere: {radius: 0.1}, name: ball, at: [0.2, 0, 0.15], material: a}
  - {box: {size: [0.2, 0.2, 0.2]}, at: [-0.2, 0, 0.15], material: a}
)");
  const double first = simulation.observe().total();
  while (!simulation.finished()) {
    simulation.step();
    ASSERT_LT(simulation.observe().unexplained, 1e-12);
  }
  // The prescribed body carried the others up by 1 m. The rest of its work was lost in the landing and in
  // carrying them along.
  const Observation& o = simulation.observe();
  EXPECT_GT(o.total() - first, 100);
  EXPECT_GT(o.ledger.work, o.total() - first);
}

TEST(Simulation, StepsAreCutFinerWhileOverlapsAreLarge) {
  // Two balls overlap by a fifth of their radius.
  const std::string balls = R"(
materials: {a: {density: 1000}}
bodies:
  - {sphere: {radius: 0.05}, material: a}
  - {sphere: {radius: 0.05}, at: [0.09, 0, 0], material: a}
)";
  Simulation cut = simulation_of("time: {end: 1, step: 0.01}" + balls);
  for (int k = 0; k < 10; ++k) cut.step();
  const std::int64_t substeps = cut.observe().counters.substeps;
  EXPECT_GT(substeps, 10);
  for (int k = 0; k < 10; ++k) cut.step();
  EXPECT_EQ(cut.observe().counters.substeps, substeps + 10);  // they are apart

  Simulation fixed = simulation_of("time: {end: 1, step: 0.01, substeps: 1}" + balls);
  for (int k = 0; k < 10; ++k) fixed.step();
  EXPECT_EQ(fixed.observe().counters.substeps, 10);
}

TEST(Simulation, ABodyThatOutrunsItsBoxInsideAStepStillMeetsWhatItShould) {
  // The first ball strikes the second, which was at rest when the pairs of the step were found. The second
  // strikes the third, which is farther away than the bodies that the second was paired with.
  Simulation simulation = simulation_of(R"(
time: {end: 0.1, step: 0.1, substeps: 100}
materials: {a: {density: 1000, restitution: 1}}
bodies:
  - {sphere: {radius: 0.05}, at: [-0.6, 0, 0], velocity: [50, 0, 0], material: a}
  - {sphere: {radius: 0.05}, material: a}
  - {sphere: {radius: 0.05}, at: [4.5, 0, 0], material: a}
)");
  simulation.step();
  EXPECT_GT(simulation.observe().counters.pcs_made, 1);
  EXPECT_NEAR(simulation.body(2).velocity.x(), 50, 1e-12);
  EXPECT_NEAR(simulation.body(2).position.x(), 4.5 + 50 * (0.1 - 0.098), 1e-12);
}

TEST(Simulation, PairsLastWhileNobodyLeavesTheirBox) {
  Simulation simulation = simulation_of(R"(
gravity: [0, 0, -9.81]
time: {end: 2, step: 0.01}
materials: {a: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: a}
  - {box: {size: 1}, at: [0, 0, 0.5], repeat: {count: [1, 1, 3], spacing: [1, 1, 1]}, material: a}
)");
  run_to_end(simulation);
  EXPECT_EQ(simulation.observe().counters.pcs_made, 4);  // as often as the bodies are sorted
}

TEST(Simulation, BallsWithoutFrictionNeverTurn) {
  Simulation simulation = simulation_of(R"(
seed: 3
time: {end: 2, step: 0.01}
materials: {ideal: {density: 1000, restitution: 1}}
model: {rotation: on, friction: on}
bodies:
  - {plane: {normal: [1, 0, 0], offset: 0}, material: ideal}
  - {plane: {normal: [-1, 0, 0], offset: -0.5}, material: ideal}
  - {plane: {normal: [0, 1, 0], offset: 0}, material: ideal}
  - {plane: {normal: [0, -1, 0], offset: -0.5}, material: ideal}
  - {plane: {normal: [0, 0, 1], offset: 0}, material: ideal}
  - {plane: {normal: [0, 0, -1], offset: -0.5}, material: ideal}
  - {sphere: {radius: 0.03}, scatter: {count: 50, from: [0, 0, 0], to: [0.5, 0.5, 0.5]}, velocity: [1, 0.5, -1], material: ideal}
  - {sphere: {radius: 0.03}, scatter: {count: 50, from: [0, 0, 0], to: [0.5, 0.5, 0.5]}, velocity: [-1, 0.5, 1], material: ideal}
)");
  const double energy = simulation.observe().kinetic();
  run_to_end(simulation);
  const Observation& end = simulation.observe();
  EXPECT_GT(end.counters.impacts, 500);
  EXPECT_EQ(end.counters.unfinished_impacts, 0);
  EXPECT_LT(end.kinetic_angular, 1e-20 * energy);
  EXPECT_NEAR(end.kinetic(), energy, 1e-12 * energy);
}

TEST(Simulation, TheKurtosisOfSpeedsIsNoNumberAtRest) {
  const auto kurtosis = [](const std::string& velocity) {
    Simulation simulation = simulation_of(R"(
time: {end: 1, step: 0.1}
materials: {a: {density: 1000}}
bodies:
  - {sphere: {radius: 1}, at: [0, 0, 0], material: a}
  - {sphere: {radius: 1}, at: [9, 0, 0], material: a, velocity: )" +
                                          velocity + "}\n");
    simulation.step();
    return simulation.observe().speed_kurtosis;
  };
  EXPECT_DOUBLE_EQ(kurtosis("[3, 0, 0]"), 2);
  const double at_rest = kurtosis("[0, 0, 0]");
  EXPECT_TRUE(std::isnan(at_rest));
  EXPECT_FALSE(std::signbit(at_rest));
}

TEST(Simulation, AppliedForcesAndTorquesDoTheirWork) {
  // A cube on ice is pulled for a while and turned all the time; another one is left alone.
  const Scene scene = scene_of(R"(
gravity: [0, 0, -10]
time: {end: 1, step: 0.01}
materials: {ice: {density: 1000}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: ice}
  - {box: {size: 1}, name: pulled, at: [0, 0, 0.5], material: ice}
  - {box: {size: 1}, name: left, at: [0, 5, 0.5], material: ice}
forces:
  - {on: pulled, force: [2000, 0, 0], from: 0.2, until: 0.7}
  - {on: pulled, torque: [0, 0, 50]}
)");
  Simulation simulation(scene, one_thread);
  run_to_end(simulation);
  const BodyState pulled = simulation.body(scene.body_names.at("pulled"));
  EXPECT_NEAR(pulled.velocity.x(), 2 * 0.5, 1e-12);
  EXPECT_NEAR(pulled.position.x(), 0.5 * 2 * 0.5 * 0.5 + 1.0 * 0.3, 1e-12);
  const double moment = 1000.0 / 6;
  EXPECT_NEAR(pulled.spin.z(), 50 / moment, 1e-13);
  EXPECT_NEAR(pulled.force.z(), 1e4, 1e4 * tolerance::response_change);
  EXPECT_EQ(simulation.body(scene.body_names.at("left")).velocity.x(), 0);
  const Observation& end = simulation.observe();
  EXPECT_NEAR(end.ledger.work, 0.5 * 1000 * 1 + 0.5 * moment * std::pow(50 / moment, 2), 1e-10);
  EXPECT_LT(end.unexplained, 1e-12);
}

TEST(Simulation, AppliedForcesAndBouncesAddUp) {
  // Gravity and a force together push a ball twice as hard as gravity alone: it bounces as under twice that
  // gravity.
  const std::string ball = R"(
time: {end: 3, step: 0.013}
materials: {a: {density: 1000, restitution: 1}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: a}
  - {sphere: {radius: 0.1}, name: ball, mass: 2, at: [0, 0, 1], material: a}
)";
  Simulation pushed = simulation_of(ball + "gravity: [0, 0, -5]\nforces: [{on: ball, force: [0, 0, -10]}]\n");
  Simulation heavy = simulation_of(ball + "gravity: [0, 0, -10]\n");
  while (!pushed.finished()) {
    pushed.step();
    heavy.step();
  }
  EXPECT_NEAR(pushed.body(1).position.z(), heavy.body(1).position.z(), 1e-12);
  EXPECT_LT(pushed.observe().unexplained, 1e-13);
}

TEST(Simulation, ABallBouncesInATubeMoreThanOnceInAStep) {
  // The ball goes along the sides of a square, one chord in each second: at the midpoint of a step it would
  // be far outside without the bounces.
  Simulation simulation = simulation_of(R"(
time: {end: 100, step: 2.5}
materials: {a: {density: 1000, restitution: 1}}
bodies:
  - {tube: {radius: 1.1, length: 1}, rotate: {axis: [1, 0, 0], degrees: 90}, fixed: true, material: a}
  - {sphere: {radius: 0.1}, at: [0, 0, -0.7071067811865476], velocity: [1.4142135623730951, 0, 0], material: a}
)");
  run_to_end(simulation);
  // The rounding error of each of a hundred bounces turns all later chords.
  EXPECT_LT((simulation.body(1).position - Vec3(0, 0, -std::sqrt(0.5))).norm(), 1e-11);
  EXPECT_LT((simulation.body(1).velocity - Vec3(std::sqrt(2.0), 0, 0)).norm(), 1e-11);
  EXPECT_EQ(simulation.observe().counters.impacts, 100);
}

TEST(Simulation, ATurningDrumHoldsWhatIsInIt) {
  // The drum turns fast, end over end and about its axis at once; now and then it wedges a box between wall
  // and cap.
  Simulation simulation = simulation_of(R"(
gravity: [0, 0, -9.81]
time: {end: 3, step: 0.002}
materials: {a: {density: 1000, restitution: 0.4, friction: 0.5}}
bodies:
  - {tube: {radius: 0.5, length: 0.8}, rotate: {axis: [1, 0, 0], degrees: 70}, motion: {spin: [3, 5, 0]}, material: a}
  - {sphere: {radius: 0.08}, at: [-0.2, -0.2, -0.2], repeat: {count: [3, 3, 2], spacing: [0.17, 0.17, 0.17]}, material: a}
  - {box: {size: [0.1, 0.15, 0.2]}, at: [-0.15, -0.15, 0.15], repeat: {count: [2, 2, 1], spacing: [0.26, 0.26, 0]}, material: a}
)");
  Snapshot now;
  while (!simulation.finished()) {
    simulation.step();
    ASSERT_LT(simulation.observe().unexplained, 1e-12);
    simulation.snapshot(now);
    for (std::size_t k = 1; k < now.bodies.position.size(); ++k) {
      const Vec3 at = now.bodies.orientation[0].conjugate() * now.bodies.position[k];
      ASSERT_LT(std::hypot(at.x(), at.y()), 0.5) << "body " << k << " at " << simulation.time();
      ASSERT_LT(std::abs(at.z()), 0.4) << "body " << k << " at " << simulation.time();
    }
  }
  EXPECT_GT(simulation.observe().ledger.work, 0);
}

TEST(Simulation, TheLastStepEndsAtTheEnd) {
  Simulation simulation = simulation_of(R"(
time: {end: 1, step: 0.3}
materials: {a: {density: 1000}}
bodies:
  - {sphere: {radius: 0.1}, velocity: [1, 0, 0], material: a}
)");
  EXPECT_EQ(simulation.steps_total(), 4);
  run_to_end(simulation);
  EXPECT_EQ(simulation.time(), 1.0);
  EXPECT_NEAR(simulation.body(0).position.x(), 1.0, 1e-15);
}

TEST(Simulation, AStateThatStopsBeingFiniteFailsWithTheBodyAndTheLastGoodState) {
  Scene scene = scene_of(R"(
time: {end: 1, step: 0.1}
materials: {a: {density: 1000}}
bodies:
  - {sphere: {radius: 0.1}, material: a}
  - {sphere: {radius: 0.1}, at: [1, 0, 0], material: a}
)");
  scene.bodies.velocity[1] = Vec3(1e308, 0, 0);
  Simulation simulation(scene, one_thread);
  const std::uint64_t before = simulation.state_hash();
  try {
    simulation.step();
    FAIL() << "no error";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("step 1"), std::string::npos) << error.what();
  }
  EXPECT_EQ(simulation.state_hash(), before);
}

TEST(Simulation, MillimetresAndMetresGiveTheSameMotion) {
  const auto scene = [](double unit) {
    const auto n = [unit](double x) { return fmt::format("{}", x * unit); };
    return scene_of("gravity: [0, 0, " + n(-9.81) + R"(]
time: {end: 1, step: 0.004}
materials: {a: {density: 1000, restitution: 0.4, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: [)" +
                    n(1) + ", " + n(1) + ", " + n(0.5) + R"(]}, at: [0, 0, )" + n(0.75) +
                    R"(], rotate: {axis: [1, 2, 0], degrees: 20}, material: a}
  - {sphere: {radius: )" +
                    n(0.25) + "}, at: [" + n(0.125) + ", 0, " + n(2) + R"(], material: a}
)");
  };
  Simulation metres(scene(1), one_thread);
  // The scale is a power of four: neither scaling nor square roots round.
  Simulation small(scene(0.00390625), one_thread);
  while (!metres.finished()) {
    metres.step();
    small.step();
  }
  for (const int body : {1, 2}) {
    EXPECT_EQ(metres.body(body).position, small.body(body).position / 0.00390625) << "body " << body;
  }
}

/// Returns bodies that fall on a floor, meet, slide and roll, in this order or reversed.
Scene few_bodies(bool reversed = false) {
  std::vector<std::string> bodies = {
      "{plane: {normal: [0, 0, 1], offset: 0}, material: a}",
      "{box: {size: [1, 0.8, 0.5]}, at: [0, 0, 0.75], rotate: {axis: [1, 2, 0], degrees: 20}, material: a}",
      "{sphere: {radius: 0.25}, at: [0.125, 0, 2], spin: [0, 6, 1], material: a}",
      "{box: {size: [0.4, 0.4, 0.4]}, at: [2, 0.1, 0.2], velocity: [-3, 0, 0], material: a}",
      "{sphere: {radius: 0.2}, at: [-2, 0.3, 0.2], velocity: [2, 0.2, 0], material: a}"};
  if (reversed) std::reverse(bodies.begin(), bodies.end());
  std::string text = R"(
gravity: [0, 0, -9.81]
time: {end: 0.8, step: 0.004}
materials: {a: {density: 1000, restitution: 0.4, friction: 0.5}}
bodies:
)";
  for (const std::string& body : bodies) text += "  - " + body + "\n";
  return scene_of(text);
}

TEST(Simulation, ATurnedAndShiftedFrameGivesTheSameMotion) {
  const Scene scene = few_bodies();
  const Quat turn = rotation_of(Vec3(0.4, -1.1, 2.3));
  const Vec3 shift(3, -20, 7);
  Scene turned = scene;
  turned.gravity = turn * scene.gravity;
  for (std::size_t k = 0; k < scene.bodies.position.size(); ++k) {
    turned.bodies.position[k] = turn * scene.bodies.position[k] + shift;
    turned.bodies.orientation[k] = turn * scene.bodies.orientation[k];
    turned.bodies.velocity[k] = turn * scene.bodies.velocity[k];
    turned.bodies.spin[k] = turn * scene.bodies.spin[k];
  }
  const BodyTable here = state_after(scene, 1000);
  const BodyTable there = state_after(turned, 1000);
  for (std::size_t k = 1; k < here.position.size(); ++k) {
    EXPECT_LT((turn * here.position[k] + shift - there.position[k]).norm(), 1e-9) << "body " << k;
    EXPECT_LT((turn * here.orientation[k]).angularDistance(there.orientation[k]), 1e-8) << "body " << k;
  }
}

TEST(Simulation, TheOrderOfBodiesGivesTheSameMotion) {
  const BodyTable one = state_after(few_bodies(), 1000);
  const BodyTable other = state_after(few_bodies(true), 1000);
  const std::size_t last = one.position.size() - 1;
  for (std::size_t k = 1; k <= last; ++k) {
    EXPECT_LT((one.position[k] - other.position[last - k]).norm(), 1e-7) << "body " << k;
  }
}

}  // namespace
}  // namespace scree
