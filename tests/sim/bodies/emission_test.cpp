// Tests of emitters and of the regions that remove bodies, in each way to take a step.
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

namespace scree {
namespace {

const std::string head = R"(
gravity: [0, 0, -10]
materials: {stone: {density: 1000, restitution: 0.2, friction: 0.5}}
)";

class EmissionTest : public testing::TestWithParam<SimulationOptions> {
 protected:
  void SetUp() override {
    if (const std::string why = why_not(GetParam()); !why.empty()) GTEST_SKIP() << why;
  }
  static Simulation simulate(const std::string& text) {
    return Simulation(scene_of(head + text), GetParam());
  }
};

TEST_P(EmissionTest, ABodyThatFindsNoRoomWaitsAndIsNotLost) {
  // The first body rests where it appears, so that no other one can follow.
  Simulation run = simulate(R"(
time: {end: 1, step: 0.01}
bodies:
  - {plane: {normal: [0, 0, 1], offset: -0.1}, material: stone}
  - {sphere: {radius: 0.1}, emit: {count: 10, rate: 20, from: [0, 0, 0], to: [0, 0, 0]}, material: stone}
)");
  EXPECT_EQ(run.observe().emitted, 1) << "the first at t = 0";
  while (!run.finished()) run.step();
  EXPECT_EQ(run.observe().requested, 10);
  EXPECT_EQ(run.observe().emitted, 1);
  EXPECT_EQ(run.observe().bodies, 2);
  EXPECT_LT(run.observe().unexplained, 1e-12);
}

TEST_P(EmissionTest, ThoseThatWaitComeWhenThereIsRoom) {
  Simulation run = simulate(R"(
time: {end: 1, step: 0.01}
bodies:
  - {box: {size: [1, 1, 0.1]}, fixed: true, until: 0.5, material: stone}
  - {sphere: {radius: 0.1}, emit: {count: 3, rate: 1000, from: [0, 0, 0], to: [0, 0, 0]}, from: 0.2, material: stone}
)");
  while (run.steps() < 19) run.step();
  EXPECT_EQ(run.observe().requested, 0);
  while (run.steps() < 49) run.step();
  EXPECT_EQ(run.observe().requested, 3);
  EXPECT_EQ(run.observe().emitted, 0);
  EXPECT_TRUE(std::isnan(run.body(1).position.x()));
  run.step();
  EXPECT_EQ(run.observe().emitted, 1);
  // A ball leaves room for the next one once it has fallen by 0.2 m, which takes 0.2 s.
  while (run.steps() < 69) run.step();
  EXPECT_EQ(run.observe().emitted, 1);
  while (run.steps() < 71) run.step();
  EXPECT_EQ(run.observe().emitted, 2);
  run_to_end(run);
  EXPECT_EQ(run.observe().emitted, 3);
  EXPECT_LT(run.observe().unexplained, 1e-12);
}

/// A scene of emitted bodies of all sizes, more than the box can hold.
const std::string pouring = R"(
time: {end: 1.8, step: 0.005}
regions:
  sink: {from: [-9, -9, -9], to: [9, 9, -0.5], removes: true}
bodies:
  - {box: {size: [0.4, 0.4, 0.1]}, at: [0, 0, 0.2], fixed: true, material: stone}
  - {sphere: {radius: {uniform: [0.02, 0.06]}}, emit: {count: 150, rate: 300, from: [-0.2, -0.2, 0.8], to: [0.2, 0.2, 1]}, velocity: [0, 0, -2], material: stone}
  - {box: {size: {uniform: [[0.03, 0.03, 0.03], [0.1, 0.1, 0.1]]}}, emit: {count: 50, rate: 100, from: [-0.2, -0.2, 0.8], to: [0.2, 0.2, 1]}, spin: [1, 2, 3], from: 0.1, material: stone}
)";

TEST_P(EmissionTest, NoneAppearsInAnother) {
  Simulation run = simulate(pouring);
  std::int64_t appeared = 0;
  std::vector<bool> there(201, false);
  Snapshot all;
  while (!run.finished()) {
    run.step();
    run.snapshot(all);
    const auto is_there = [&](std::size_t body) { return all.bodies.mobility[body] != Mobility::absent; };
    const auto size = [&](std::size_t body) {
      return all.bodies.shape[body] == Shape::sphere ? all.bodies.size[body].x()
                                                     : all.bodies.size[body].minCoeff();
    };
    for (std::size_t k = 1; k < 201; ++k) {
      if (is_there(k) && !there[k]) {
        ++appeared;
        // The new body has not moved yet. Its gap to every other body is tested by their inscribed spheres.
        for (std::size_t other = 1; other < 201; ++other) {
          if (other == k || !is_there(other)) continue;
          ASSERT_GE((all.bodies.position[other] - all.bodies.position[k]).norm(), size(k) + size(other)) << k;
        }
      }
      there[k] = is_there(k);
    }
    const Observation& o = run.observe();
    ASSERT_LT(o.unexplained, 1e-9) << o.time;
    ASSERT_EQ(o.emitted - o.regions[0].removed.count, o.bodies - 1);
    ASSERT_LE(o.emitted, o.requested);
  }
  EXPECT_EQ(run.observe().requested, 200);
  EXPECT_GT(appeared, 150);
  EXPECT_GT(run.observe().regions[0].removed.count, 20);
}

TEST_P(EmissionTest, TheMassThatEndsIsThatOfTheBodies) {
  Simulation run = simulate(pouring);
  double mass = 0;
  const Scene scene = scene_of(head + pouring);
  run_to_end(run);
  std::int64_t gone = 0;
  for (std::int32_t k = 1; k < 201; ++k)
    if (std::isnan(run.body(k).position.x())) {
      mass += 1 / scene.bodies.inverse_mass[static_cast<std::size_t>(k)];
      ++gone;
    }
  const Observation& o = run.observe();
  ASSERT_EQ(o.emitted, 200);
  EXPECT_EQ(gone, o.regions[0].removed.count);
  EXPECT_NEAR(o.regions[0].removed.mass, mass, 1e-12 * mass);
}

INSTANTIATE_TEST_SUITE_P(Ways, EmissionTest,
                         testing::Values(SimulationOptions{SpaceChoice::host, 1},
                                         SimulationOptions{SpaceChoice::cuda, 1}),
                         [](const auto& way) {
                           return std::string(way.param.space == SpaceChoice::cuda ? "device" : "host");
                         });

}  // namespace
}  // namespace scree
