// Tests of bodies that leave the world, in each way to take a step.
#include "sim/step/step_failure.hpp"
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace scree {
namespace {

/// Returns a bed of balls and boxes that rests and falls, and three balls and a box that leave the world, two
/// of them at once.
std::string scene_text(const std::string& more) {
  return "time: {end: 0.6, step: 0.005}\ngravity: [0, 0, -9.81]\n"
         "materials: {stone: {density: 1000, restitution: 0.3, friction: 0.4}}\n"
         "bodies:\n"
         "  - {plane: {normal: [0, 0, 1]}, material: stone}\n"
         "  - {sphere: {radius: 0.1}, name: a, at: [-3, 0, 1], velocity: [-6, 0, 0], material: stone}\n"
         "  - {sphere: {radius: 0.1}, name: b, at: [-3, 1, 1], velocity: [-6, 0, 0], material: stone}\n"
         "  - {box: {size: 0.2}, name: c, at: [3, 0, 1], velocity: [9, 0, 0], spin: [1, 2, 3], material: "
         "stone}\n"
         "  - {sphere: {radius: 0.1}, name: d, at: [3, 1, 1], velocity: [7, 0, 0], until: 0.5, material: "
         "stone}\n"
         "  - {sphere: {radius: 0.1}, at: [-0.5, -0.5, 0.15], repeat: {count: [3, 3, 2], spacing: [0.21, "
         "0.21, 0.21], jitter: 0.004}, material: stone}\n"
         "  - {box: {size: 0.2}, at: [-0.5, -0.5, 0.9], repeat: {count: [2, 2, 1], spacing: [0.3, 0.3, "
         "0.3]}, material: stone}\n" +
         more;
}

const std::string world = "world: {from: [-5, -5, -1], to: [5, 5, 5], leaving: ";

class WorldTest : public testing::TestWithParam<SimulationOptions> {
 protected:
  void SetUp() override {
    if (const std::string why = why_not(GetParam()); !why.empty()) GTEST_SKIP() << why;
  }
  Simulation simulate(const std::string& more) const {
    return Simulation(scene_of(scene_text(more)), GetParam());
  }
};

TEST_P(WorldTest, ThoseThatLeaveAreTakenOutAndCountedAndTheLedgerKnows) {
  const Scene scene = scene_of(scene_text(""));
  Simulation run = simulate(world + "remove}\n");
  Simulation whole = simulate("");
  std::int64_t most_at_once = 0;
  while (!run.finished()) {
    const std::int64_t before = run.observe(false).left;
    run.step();
    whole.step();
    const Observation& now = run.observe(false);
    most_at_once = std::max(most_at_once, now.left - before);
    EXPECT_LT(now.unexplained, 1e-12) << run.time();
  }
  EXPECT_EQ(most_at_once, 2);
  EXPECT_EQ(run.observe(false).left, 4);
  EXPECT_EQ(run.observe().bodies, scene.bodies.count() - 4);
  EXPECT_EQ(whole.observe().bodies, scene.bodies.count() - 1) << "d goes at its time";
  EXPECT_NE(run.observe().exchange.energy, 0);
  EXPECT_TRUE(std::isnan(run.body(scene.body_names.at("a")).position.x()));
  EXPECT_FALSE(std::isnan(whole.body(scene.body_names.at("a")).position.x()));
  // The bodies left in free flight.
  const double ball = 4.0 / 3 * pi * 0.001 * 1000, box = 8;
  EXPECT_NEAR(run.observe().exchange.momentum.x(), -((7 - 6 - 6) * ball + 9 * box), 1e-9);
  // The other bodies go on as if nothing had been there; contacts are solved together, so they do not agree
  // to the bit.
  for (std::int32_t k = scene.body_names.at("d") + 1; k < scene.bodies.count(); ++k)
    EXPECT_LT((run.body(k).position - whole.body(k).position).norm(), 1e-3) << k;
}

TEST_P(WorldTest, AWorldThatNobodyLeavesChangesNothing) {
  std::vector<std::uint64_t> hashes;
  for (const char* more : {"", "world: {from: [-99, -99, -99], to: [99, 99, 99], leaving: stop}\n",
                           "world: {from: [-99, -99, -99], to: [99, 99, 99], leaving: remove}\n",
                           "world: {from: [8, 8, 8], to: [9, 9, 9], leaving: ignore}\n"}) {
    Simulation run = simulate(more);
    run_to_end(run);
    hashes.push_back(run.state_hash());
    EXPECT_EQ(run.observe(false).left, 0);
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST_P(WorldTest, ItStopsBeforeTheStepThatLeads) {
  Simulation run = simulate(world + "stop}\n");
  std::uint64_t last = 0;
  std::vector<std::int32_t> left;
  while (left.empty() && !run.finished()) {
    last = run.state_hash();
    try {
      run.step();
    } catch (const StepFailure& failure) {
      left = failure.bodies();
    }
  }
  EXPECT_EQ(left, std::vector<std::int32_t>{3}) << "c is the fastest";
  EXPECT_EQ(run.state_hash(), last);
  EXPECT_LE(run.body(3).position.x(), 5);
  EXPECT_LT(run.observe().unexplained, 1e-12);
  EXPECT_THROW(run.step(), StepFailure) << "and again, if asked";
}

INSTANTIATE_TEST_SUITE_P(Ways, WorldTest,
                         testing::Values(SimulationOptions{SpaceChoice::host, 1},
                                         SimulationOptions{SpaceChoice::cuda}),
                         [](const auto& way) {
                           return std::string(way.param.space == SpaceChoice::cuda ? "cuda" : "host");
                         });

}  // namespace
}  // namespace scree
