// Tests of rolling friction by each way of taking steps: what it must keep, and what it must do.
#include "tests/sim/ways.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace scree {
namespace {

class RollingFriction : public WayTest {};

/// Two clouds of spinning balls of several sizes meet without weight, one with a body of hundreds of times
/// their mass in it. Couples must act on both bodies equally, in impacts, in groups of them, and in contacts.
TEST_P(RollingFriction, KeepsMomentaAndExplainsEnergy) {
  const auto cloud = [](const char* place, const char* velocity) {
    return std::string("  - {sphere: {radius: {uniform: [0.03, 0.06]}}, at: ") + place +
           ", repeat: {count: [4, 4, 4], spacing: [0.13, 0.13, 0.13], jitter: 0.004}, velocity: " + velocity +
           ", spin: [20, -30, 10], material: stone}\n";
  };
  const std::string scene =
      "time: {end: 0.5, step: 0.002}\n"
      "materials: {stone: {density: 1000, restitution: 0.3, friction: 0.4, rolling_friction: 0.3}}\n"
      "bodies:\n"
      "  - {sphere: {radius: 0.3}, at: [0, 0.2, 0.2], spin: [0, 0, -15], material: stone}\n" +
      cloud("[-1.1, 0, 0]", "[3, 0, 0]") + cloud("[0.7, 0, 0]", "[-3, 0, 0]");
  Simulation run = simulate(scene);
  const Observation start = run.observe();
  double most_kinetic = start.kinetic();
  const double most_unexplained = is_mixed() ? 1e-5 : 1e-10;
  while (!run.finished()) {
    run.step();
    const Observation& o = run.observe();
    ASSERT_LT(o.unexplained, most_unexplained) << o.time;
    ASSERT_LE(o.kinetic(), most_kinetic * (1 + most_unexplained)) << o.time;
    most_kinetic = o.kinetic();
  }
  const Observation& end = run.observe();
  EXPECT_GT(end.counters.impacts, 300);
  EXPECT_GT(end.ledger.friction, 0.1 * start.kinetic());
  const double size = std::sqrt(2 * start.kinetic() * start.kinetic());
  EXPECT_LT((end.momentum - start.momentum).norm(), (is_mixed() ? 1e-5 : 1e-12) * size);
  const Vec3 turned = end.angular_momentum - start.angular_momentum - end.ledger.angular_correction;
  EXPECT_LT(turned.norm(), (is_mixed() ? 1e-5 : 1e-11) * size);
}

/// Returns the height of the middle of a column of balls that has slumped, above its floor.
double height_after_slump(Simulation run) {
  double highest = 0;
  while (!run.finished()) run.step();
  for (std::int32_t k = 1; k < 121; ++k) highest = std::max(highest, run.body(k).position.z());
  EXPECT_LT(run.observe().unexplained, 1e-6);
  return highest;
}

/// This is why users want rolling friction: balls that may not roll stay where they are put.
TEST_P(RollingFriction, AColumnStandsSteeper) {
  if (std::string(GetParam().name) == "host_accurate") GTEST_SKIP() << "a heap is not for the accurate mode";
  const auto column = [](const char* rolling) {
    return std::string(
               "gravity: [0, 0, -9.81]\ntime: {end: 1.5, step: 0.005}\nmaterials: {stone: {density: 1000, "
               "friction: 0.6, rolling_friction: ") +
           rolling +
           "}}\nbodies:\n  - {plane: {normal: [0, 0, 1]}, material: stone}\n"
           "  - {sphere: {radius: 0.05}, at: [-0.1, -0.1, 0.05], repeat: {count: [2, 2, 30], spacing: "
           "[0.101, 0.101, 0.101], jitter: 0.004}, material: stone}\n";
  };
  EXPECT_GT(height_after_slump(simulate(column("0.4"))), 1.5 * height_after_slump(simulate(column("0"))));
}

/// Any number of threads, with SIMD lanes, gives the same bits.
TEST_P(RollingFriction, AnyNumberOfThreadsGivesTheSameBits) {
  if (GetParam().options.space == SpaceChoice::cuda) GTEST_SKIP() << "of Host's threads";
  const std::string text =
      "gravity: [0, 0, -9.81]\ntime: {end: 0.3, step: 0.005}\nmaterials: {stone: {density: 1000, friction: "
      "0.6, restitution: 0.2, rolling_friction: 0.2}}\nbodies:\n"
      "  - {plane: {normal: [0, 0, 1]}, material: stone}\n"
      "  - {box: {size: 0.3}, at: [0, 0, 0.15], material: stone}\n"
      "  - {sphere: {radius: 0.03}, at: [-0.3, -0.3, 0.35], repeat: {count: [10, 10, 4], spacing: [0.065, "
      "0.065, "
      "0.065], jitter: 0.002}, material: stone}\n" +
      std::string(GetParam().settings) + "\n";
  std::uint64_t hash[2];
  for (const int threads : {1, 3}) {
    SimulationOptions options = GetParam().options;
    options.threads = threads;
    Simulation run(scene_of(text), options);
    run_to_end(run);
    hash[threads / 2] = run.state_hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

INSTANTIATE_TEST_SUITE_P(Ways, RollingFriction, testing::ValuesIn(all_ways()), way_name);

/// The natural residual of the accurate mode counts couples too. On this slope the balls are held, so that
/// both friction and a couple stick.
TEST(RollingFrictionAccurate, SolvesCouplesToTheTolerance) {
  Simulation run = simulation_of(R"(
gravity: [1, 0, -9.81]
time: {end: 0.1, step: 0.005}
response: {mode: accurate}
materials: {stone: {density: 1000, friction: 0.6, rolling_friction: 0.2}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {sphere: {radius: 0.1}, at: [0, 0, 0.1], material: stone}
  - {sphere: {radius: 0.05}, at: [1, 0, 0.05], material: stone}
)");
  run_to_end(run);
  const Observation& o = run.observe();
  EXPECT_LT(o.counters.residual, 1e-9);
  EXPECT_LT(run.body(1).spin.norm(), 1e-9);
  EXPECT_LT(run.body(2).spin.norm(), 1e-9);
}

}  // namespace
}  // namespace scree
