#include "sim/cli/film_look.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree::cli {
namespace {

Scene scene_with(const std::string& render) {
  return parse_scene(
      "format: 1\n"
      "gravity: [0, 0, -10]\n"
      "time: {end: 4, step: 0.01}\n"
      "materials: {a: {density: 1000}, b: {density: 500}}\n"
      "bodies:\n"
      "  - {plane: {normal: [0, 0, 1]}, material: a}\n"
      "  - {sphere: {radius: 0.1}, at: [0, 0, 0.0999], material: a}\n"
      "  - {sphere: {radius: 0.1}, at: [0, 0, 0.2997], material: b}\n"
      "render: " +
          render + "\n",
      "test.yaml");
}

TEST(FilmLook, OrbitTurnsOverTheRun) {
  const FilmLook look =
      look_of(scene_with("{camera: {from: [2, 0, 1], to: [0, 0, 1], orbit: {degrees: 360}}}"));
  EXPECT_LT((look.camera(1).from - Vec3(0, 2, 1)).norm(), 1e-12);
  EXPECT_LT((look.camera(4).from - look.camera(0).from).norm(), 1e-12);
  const FilmLook slow = look_of(scene_with("{camera: {orbit: {degrees_per_second: 45}}}"));
  const Vec3 start = slow.camera(0).from - slow.camera(0).to,
             turned = slow.camera(2).from - slow.camera(2).to;
  EXPECT_NEAR(start.x(), turned.y(), 1e-12);
  EXPECT_NEAR(start.y(), -turned.x(), 1e-12);
}

TEST(FilmLook, AnnotatesWhereThereIsRoom) {
  EXPECT_TRUE(look_of(scene_with("{size: [320, 240]}")).annotation.legend);
  EXPECT_FALSE(look_of(scene_with("{size: [320, 200]}")).annotation.time_stamp);
  EXPECT_TRUE(look_of(scene_with("{size: [320, 200], time_stamp: on}")).annotation.time_stamp);
  EXPECT_FALSE(look_of(scene_with("{legend: off}")).annotation.legend);
}

TEST(FilmLook, RangeIsTheScenesOrAGuess) {
  EXPECT_EQ(look_of(scene_with("{color: speed, range: [1, 3]}")).style.range, (std::array<double, 2>{1, 3}));
  // A fall through 0.2 m at 10 m/s^2 ends at 2 m/s.
  EXPECT_EQ(look_of(scene_with("{color: speed}")).style.range, (std::array<double, 2>{0, 2}));
}

TEST(FilmLook, FramesHoldTheForcesAndCellsOfTheStep) {
  const Scene scene = scene_with("{color: force, overlay: [forces, pairs, grid]}");
  Simulation simulation(scene);
  for (int k = 0; k < 200; ++k) simulation.step();
  const render::Frame frame = frame_of(scene, look_of(scene), simulation);
  const double mass = 4.0 / 3 * pi * 1e-3 * 1000;  // of the lower sphere; the upper one has half of it
  ASSERT_EQ(frame.force.size(), 3u);
  EXPECT_NEAR(frame.force[2], 0.5 * mass * 10, 0.01 * mass * 10);
  EXPECT_NEAR(frame.force[1], 2 * mass * 10, 0.01 * mass * 10);
  EXPECT_NEAR(frame.force[0], 1.5 * mass * 10, 0.01 * mass * 10);
  const GridOccupancy grid = simulation.grid_occupancy();
  ASSERT_FALSE(grid.cells.empty());
  // Twelve edges each, one pair of spheres, two contacts.
  EXPECT_EQ(frame.lines.size(), 12 * grid.cells.size() + 1 + 2);
  for (const std::size_t body : {1u, 2u}) {
    const Vec3 centre = frame.snapshot.bodies.position[body];
    EXPECT_TRUE(std::any_of(grid.cells.begin(), grid.cells.end(), [&](const OccupiedCell& cell) {
      return cell.level == grid.level[body] && ((centre - cell.low).array() >= -1e-3 * cell.width).all() &&
             ((centre - cell.low).array() <= 1.001 * cell.width).all();
    }));
  }
}

/// Two balls that touch through the end of a cell, given in other images.
TEST(FilmLook, APeriodicSpaceIsItsCellAndWhatSticksOutAtBothEnds) {
  const Scene scene = parse_scene(
      "format: 1\n"
      "time: {end: 4, step: 0.01}\n"
      "materials: {a: {density: 1000}}\n"
      "periodic: {x: [0, 1], y: [1, 2]}\n"
      "bodies:\n"
      "  - {plane: {normal: [0, 0, 1], offset: -1}, material: a}\n"
      "  - {sphere: {radius: 0.1}, name: a, at: [0.95, 5.5, 0], material: a}\n"
      "  - {sphere: {radius: 0.1}, name: b, at: [-4.851, 1.5, 0], material: a}\n"
      "  - {sphere: {radius: 0.1}, name: c, at: [0.96, 1.03, 0], fixed: true, material: a}\n"
      "forces: [{on: a, force: [100, 0, 0]}, {on: b, force: [-100, 0, 0]}]\n"
      "render: {color: force, overlay: [forces, pairs]}\n",
      "test.yaml");
  Simulation simulation(scene);
  for (int k = 0; k < 3; ++k) simulation.step();
  const render::Frame frame = frame_of(scene, look_of(scene), simulation);
  // Of the first ball one image, of the second none, of the fixed one three.
  const std::vector<Vec3> expected = {{0.95, 1.5, 0},   {0.149, 1.5, 0}, {0.96, 1.03, 0}, {-0.05, 1.5, 0},
                                      {-0.04, 1.03, 0}, {0.96, 2.03, 0}, {-0.04, 2.03, 0}};
  const std::vector<Vec3>& position = frame.snapshot.bodies.position;
  ASSERT_EQ(position.size(), expected.size() + 1);
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_LT((position[k + 1] - expected[k]).norm(), 1e-3) << k;
  ASSERT_EQ(frame.force.size(), position.size());
  EXPECT_NEAR(frame.force[4], 100, 1e-4) << "an image bears what its body bears";
  ASSERT_EQ(frame.lines.size(), 2u) << "a pair, and its force";
  for (const render::Line& line : frame.lines) EXPECT_NEAR((line.to - line.from).norm(), 0.2, 2e-3);
}

}  // namespace
}  // namespace scree::cli
