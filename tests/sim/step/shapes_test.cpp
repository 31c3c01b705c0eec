// Tests of runs with general shapes: against equal shapes of another kind, and with the same bits whatever
// the number of threads and after a stop.
#include "core/error.hpp"
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <string>

namespace scree {
namespace {

const std::string head = R"(
gravity: [0, 0, -9.81]
materials: {stone: {density: 1000, restitution: 0.4, friction: 0.5}}
)";
const std::string floor_file = SCREE_SOURCE_DIR "/configs/meshes/floor.obj";

/// Returns the largest distance between the bodies called `it` in two runs side by side (m).
double largest_difference(const std::string& first, const std::string& second, int steps) {
  const Scene scenes[2] = {scene_of(head + first), scene_of(head + second)};
  Simulation runs[2] = {Simulation(scenes[0], one_thread), Simulation(scenes[1], one_thread)};
  double largest = 0;
  for (int k = 0; k < steps; ++k) {
    Vec3 at[2];
    for (int r = 0; r < 2; ++r) {
      runs[r].step();
      at[r] = runs[r].body(scenes[r].body_names.at("it")).position;
    }
    largest = std::max(largest, (at[0] - at[1]).norm());
  }
  return largest;
}

constexpr const char* cube =
    "polyhedron: {points: [[0, 0, 0], [0.2, 0, 0], [0, 0.3, 0], [0.2, 0.3, 0], [0, 0, 0.1], [0.2, 0, 0.1], "
    "[0, 0.3, 0.1], [0.2, 0.3, 0.1]]}";

TEST(Shapes, AHullOfABoxMovesAsTheBox) {
  const std::string scene = R"(
time: {end: 1, step: 0.002}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone}
  - {)";
  // `at` places the frame of the points, whose origin is a corner of the box here.
  const std::string motion =
      ", name: it, velocity: [0.5, 0.2, 0], spin: [3, 1, 2], rotate: {axis: [1, 2, 0], degrees: 30}, "
      "material: stone";
  const Quat turn(Eigen::AngleAxisd(pi / 6, Vec3(1, 2, 0).normalized()));
  const Vec3 corner = Vec3(0, 0, 0.5) - turn * Vec3(0.1, 0.15, 0.05);
  const std::string at = ", at: [" + std::to_string(corner.x()) + ", " + std::to_string(corner.y()) + ", " +
                         std::to_string(corner.z()) + "]}\n";
  const std::string box = scene + "box: {size: [0.2, 0.3, 0.1]}" + motion + ", at: [0, 0, 0.5]}\n";
  // The two agree in free flight to the rounding of the written numbers, and stay close through the first
  // bounces.
  EXPECT_LT(largest_difference(box, scene + cube + motion + at, 100), 2e-6);
  EXPECT_LT(largest_difference(box, scene + cube + motion + at, 250), 1e-4);
}

TEST(Shapes, ABallRollsOverAMeshAsOverAPlane) {
  const std::string ball =
      "  - {sphere: {radius: 0.1}, name: it, at: [-8, 0.3, 0.5], velocity: [3, 0.4, 0], spin: [5, -3, 2], "
      "material: stone}\n";
  const std::string time = "time: {end: 3, step: 0.004}\nbodies:\n";
  const std::string plane = "  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone}\n";
  const std::string mesh = "  - {mesh: {file: " + floor_file + "}, fixed: true, material: stone}\n";
  // The restitution is 0, since slow approaches to a mesh bounce a little less (FlightStage::slowest_bounce).
  const std::string law = "contacts: [{between: [stone, stone], restitution: 0, friction: 0.5}]\n";
  EXPECT_LT(largest_difference(law + time + plane + ball, law + time + mesh + ball, 750), 1e-9);
}

const std::string all_shapes = head + R"(
seed: 3
time: {end: 0.6, step: 0.004}
bodies:
  - {mesh: {file: )" + floor_file +
                               R"(}, name: floor, motion: {velocity: [0.2, 0, 0]}, material: stone}
  - {capsule: {radius: 0.06, length: 0.1}, scatter: {count: 12, from: [-0.7, -0.7, 0.2], to: [0.7, 0.7, 1.4]}, material: stone}
  - {cylinder: {radius: 0.08, length: 0.1}, scatter: {count: 12, from: [-0.7, -0.7, 0.2], to: [0.7, 0.7, 1.4]}, material: stone}
  - {polyhedron: {points: [[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2], [0.12, 0.12, 0.1]]}, scatter: {count: 12, from: [-0.7, -0.7, 0.2], to: [0.7, 0.7, 1.4]}, material: stone}
  - {box: {size: [0.1, 0.12, 0.14]}, scatter: {count: 12, from: [-0.7, -0.7, 0.2], to: [0.7, 0.7, 1.4]}, material: stone}
  - {sphere: {radius: 0.07}, scatter: {count: 12, from: [-0.7, -0.7, 0.2], to: [0.7, 0.7, 1.4]}, material: stone}
)";

TEST(Shapes, GiveTheSameBitsForAnyNumberOfThreadsAndAfterAStop) {
  const Scene scene = scene_of(all_shapes);
  Simulation one(scene, one_thread), many(scene, {SpaceChoice::host, 3});
  SavedState state;
  while (one.steps() < 140) {
    one.step();
    many.step();
    ASSERT_EQ(one.state_hash(), many.state_hash()) << one.steps();
    if (one.steps() == 100) {
      Archive archive = Archive::saving(state);
      one.archive(archive);
    }
  }
  EXPECT_GT(one.observe().contacts, 20);
  EXPECT_LT(std::abs(one.observe().unexplained), 1e-9 * one.observe().energy_scale);
  Simulation resumed(scene, one_thread);
  Archive archive = Archive::loading(state);
  resumed.archive(archive);
  while (resumed.steps() < 140) resumed.step();
  EXPECT_EQ(resumed.state_hash(), one.state_hash());
}

// The way to find contacts changes a heap no more than its chaos does, and the default way changes nothing.
TEST(Shapes, MoveAlikeWithContactsByLibccd) {
  const auto with = [](const std::string& way) {
    return scene_of(all_shapes + "narrowphase: {convex: " + way + ", crosscheck: 0.5}\n");
  };
  Simulation plain(scene_of(all_shapes), one_thread), axes(with("axes"), one_thread);
  while (plain.steps() < 140) plain.step(), axes.step();
  EXPECT_EQ(plain.state_hash(), axes.state_hash());
  EXPECT_EQ(axes.observe().counters.narrowphase.ccd_calls, 0);
  EXPECT_GT(axes.observe().counters.narrowphase.crosscheck.asked, 100);
  for (const char* way : {"ccd_gjk", "ccd_mpr"}) {
    Simulation one(with(way), one_thread), many(with(way), {SpaceChoice::host, 3});
    while (one.steps() < 140) one.step(), many.step();
    EXPECT_EQ(one.state_hash(), many.state_hash());
    const Observation now = one.observe();
    EXPECT_GT(now.counters.narrowphase.ccd_calls, 100);
    EXPECT_LT(now.counters.narrowphase.ccd_rejected, now.counters.narrowphase.ccd_calls);
    EXPECT_LT(now.unexplained, 1e-9);
    EXPECT_NEAR(now.total(), plain.observe().total(), 0.05 * now.energy_scale);
  }
}

TEST(Shapes, StepsAreHostsInDouble) {
  EXPECT_THROW(Simulation(scene_of(all_shapes + "precision: mixed\n"), one_thread), InputError);
}

TEST(Shapes, ARegionKnowsTheVolumeOfAHull) {
  Simulation run = simulation_of(head + R"(
time: {end: 0.01, step: 0.01}
regions: {all: {from: [-1, -1, -1], to: [1, 1, 1]}}
bodies:
  - {polyhedron: {points: [[0, 0, 0], [0.6, 0, 0], [0, 0.6, 0], [0, 0, 0.6]]}, material: stone}
)");
  EXPECT_NEAR(run.observe().regions.front().fraction, 0.6 * 0.6 * 0.6 / 6 / 8, 1e-12);
}

}  // namespace
}  // namespace scree
