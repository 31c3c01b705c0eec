// Trajectories end to end: they are written, gone on with, drawn again and exported.
#include "tests/sim/cli/falling_ball.hpp"

namespace scree {
namespace {

class TrajectoryProgramTest : public ProgramTest {
 protected:
  const std::string pictures_ = "render: {size: [64, 48], fps: 50}\n";
  const std::string trajectory_ = "--set=record.trajectory={precision: double}";
};

TEST_F(TrajectoryProgramTest, NoneUnlessTheSceneAsks) {
  ASSERT_EQ(run_scene(falling_ball(no_pictures)).status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "output/fall/trajectory.vtkhdf"));
  EXPECT_EQ(manifest_in(folder_ / "output/fall").count("trajectory_frames"), 0);
}

TEST_F(TrajectoryProgramTest, HasAFrameForEachPicture) {
  ASSERT_EQ(run_scene(falling_ball(pictures_), {trajectory_}).status, 0);
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["trajectory_frames"], 6);
  EXPECT_EQ(files_below(folder_ / "output/fall").back(), "trajectory.vtkhdf") << "and no journal";
}

TEST_F(TrajectoryProgramTest, OrAsManyAsTheSceneAsks) {
  ASSERT_EQ(
      run_scene(falling_ball(no_pictures), {"--set", "record.trajectory={every: 0.01, velocity: false}"})
          .status,
      0);
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["trajectory_frames"], 11);
}

TEST_F(TrajectoryProgramTest, GoneOnWithItHasTheSameBytes) {
  const std::string scene = falling_ball(pictures_);
  ASSERT_EQ(run_scene(scene, {"-o", "whole", trajectory_}).status, 0);
  ASSERT_EQ(run_scene(scene, {"-o", "parts", "--until", "0.05", trajectory_}).status, 0);
  ASSERT_TRUE(fs::exists(folder_ / "parts/trajectory.vtkhdf")) << "of what there is";
  ASSERT_EQ(run_scene(scene, {"-o", "parts", "--resume", trajectory_}).status, 0);
  EXPECT_TRUE(text_of(folder_ / "whole/trajectory.vtkhdf") == text_of(folder_ / "parts/trajectory.vtkhdf"));
  EXPECT_EQ(files_below(folder_ / "whole"), files_below(folder_ / "parts"));
}

TEST_F(TrajectoryProgramTest, IsDrawnAgainAsTheRunDrewIt) {
  const std::string scene = falling_ball("render: {size: [64, 48], fps: 50, color: speed}\n");
  ASSERT_EQ(run_scene(scene, {trajectory_}).status, 0);
  if (manifest_in(folder_ / "output/fall")["frames"] == 0) GTEST_SKIP() << "no pictures on this machine";
  const Finished again = scree_in(folder_, {"render", "output/fall/"});
  ASSERT_EQ(again.status, 0) << again.error;
  for (const char* frame : {"frames/00000.png", "frames/00003.png", "frames/00005.png"})
    EXPECT_EQ(text_of(folder_ / "output/fall" / frame), text_of(folder_ / "output/fall-render" / frame))
        << frame;
  EXPECT_FALSE(fs::exists(folder_ / "output/fall-render/frames/00006.png"));
}

TEST_F(TrajectoryProgramTest, IsDrawnFromElsewhere) {
  ASSERT_EQ(run_scene(falling_ball(pictures_), {trajectory_}).status, 0);
  if (manifest_in(folder_ / "output/fall")["frames"] == 0) GTEST_SKIP() << "no pictures on this machine";
  const std::vector<std::string> again = {"render", "output/fall",
                                          "-o",     "side",
                                          "--set",  "render.camera.from=[3, 0, 10]",
                                          "--set",  "render.camera.to=[0, 0, 10]"};
  ASSERT_EQ(scree_in(folder_, again).status, 0);
  EXPECT_NE(text_of(folder_ / "output/fall/frames/00000.png"), text_of(folder_ / "side/frames/00000.png"));
  EXPECT_EQ(scree_in(folder_, again).status, 2) << "pictures are there";
}

TEST_F(TrajectoryProgramTest, WhatItDoesNotHaveIsNotDrawn) {
  ASSERT_EQ(run_scene(falling_ball(no_pictures), {"--set", "record.trajectory={velocity: false}"}).status, 0);
  const auto expect_refused = [&](const std::string& setting, const std::string& words) {
    const Finished run = scree_in(folder_, {"render", "output/fall", "--set", setting});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(contains(run.error, words)) << run.error;
    EXPECT_FALSE(fs::exists(folder_ / "output/fall-render"));
  };
  expect_refused("render={color: speed}", "no velocity");
  expect_refused("render={color: speed}", "or run the scene again with record.trajectory.velocity=true");
  expect_refused("render={color: force}", "no contacts");
  expect_refused("render={color: force}", "or run the scene again with record.trajectory.contacts=true");
  expect_refused("render={overlay: [pairs]}", "no pairs");
  expect_refused("render={overlay: [pairs]}", "only scree run can draw these");
  expect_refused("gravity=[0, 0, -1]", "only keys of `render` can change for a run that is done");
}

/// Balls on a floor and on one another.
const std::string heap = R"(format: 1
gravity: [0, 0, -10]
name: heap
time: {end: 0.1, step: 0.01}
materials: {stone: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {sphere: {radius: 0.1}, at: [0, 0, 0.1], repeat: {count: [2, 2, 2], spacing: [0.2, 0.2, 0.2]}, material: stone}
render: {size: [64, 48], fps: 50, color: force, overlay: [forces]}
)";

TEST_F(TrajectoryProgramTest, ContactsAreKeptDrawnAgainAndExported) {
  const std::string contacts = "--set=record.trajectory={precision: double, contacts: true}";
  ASSERT_EQ(run_scene(heap, {contacts}).status, 0);
  const Finished table = scree_in(folder_, {"export", "output/heap", "--to", "csv"});
  EXPECT_TRUE(contains(table.out, "contacts:  output/heap-csv/contacts")) << table.out;
  EXPECT_GT(text_of(folder_ / "output/heap-csv/contacts/00005.csv").size(), 200u) << "there are some";

  ASSERT_EQ(run_scene(heap, {"-o", "parts", "--until", "0.05", contacts}).status, 0);
  ASSERT_EQ(run_scene(heap, {"-o", "parts", "--resume", contacts}).status, 0);
  EXPECT_TRUE(text_of(folder_ / "output/heap/contacts.vtkhdf") == text_of(folder_ / "parts/contacts.vtkhdf"));

  if (manifest_in(folder_ / "output/heap")["frames"] == 0) GTEST_SKIP() << "no pictures on this machine";
  const Finished again = scree_in(folder_, {"render", "output/heap"});
  ASSERT_EQ(again.status, 0) << again.error;
  EXPECT_EQ(text_of(folder_ / "output/heap/frames/00005.png"),
            text_of(folder_ / "output/heap-render/frames/00005.png"));
}

TEST_F(TrajectoryProgramTest, AnotherColourGoesWithoutTheRangeOfTheRun) {
  const std::string scene = falling_ball("render: {size: [64, 48], fps: 50, color: speed, range: [0, 3]}\n");
  ASSERT_EQ(run_scene(scene, {trajectory_}).status, 0);
  if (manifest_in(folder_ / "output/fall")["frames"] == 0) GTEST_SKIP() << "no pictures on this machine";
  const std::vector<std::string> material = {"render", "output/fall", "-o",
                                             "new",    "--set",       "render.color=material"};
  const Finished drawn = scree_in(folder_, material);
  EXPECT_EQ(drawn.status, 0) << drawn.error;
  std::vector<std::string> with_range = material;
  with_range.insert(with_range.end(), {"--overwrite", "--set", "render.range=[0, 1]"});
  EXPECT_EQ(scree_in(folder_, with_range).status, 2) << "a range that is given is not left out";
  const Finished again = scree_in(folder_, material);
  EXPECT_EQ(again.status, 2);
  EXPECT_EQ(again.error,
            "scree: new: holds earlier results; --overwrite replaces them, -o DIR writes elsewhere\n");
}

TEST_F(TrajectoryProgramTest, IsExported) {
  ASSERT_EQ(run_scene(falling_ball(no_pictures), {"--set", "record.trajectory=true"}).status, 0);
  for (const char* format : {"vtp", "xyz", "lammps", "csv"}) {
    const Finished run = scree_in(folder_, {"export", "output/fall", "--to", format});
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_TRUE(run.out.starts_with("4 frames: output/fall-" + std::string(format) + "/")) << run.out;
  }
  EXPECT_EQ(scree_in(folder_, {"export", "output/fall", "--to", "obj"}).status, 2);
  ASSERT_EQ(run_scene(falling_ball(no_pictures), {"-o", "bare"}).status, 0);
  const Finished none = scree_in(folder_, {"export", "bare", "--to", "xyz"});
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(contains(none.error, "bare/trajectory.vtkhdf: there is none; run the scene with "))
      << none.error;
}

// The hulls and the period are those of scene.yaml in the run's folder.
TEST_F(TrajectoryProgramTest, ShapesAndPeriodsAreExported) {
  const std::string gem =
      "format: 1\nname: gem\ntime: {end: 0.1, step: 0.1}\nperiodic: {x: [-2, 2]}\n"
      "materials: {stone: {density: 1000}}\nrecord: {trajectory: true}\nbodies:\n"
      "  - {plane: {normal: [0, 0, 1], offset: -1}, material: stone}\n"
      "  - {polyhedron: {points: [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]], scale: 0.2}, material: "
      "stone}\n";
  ASSERT_EQ(run_scene(gem, {"--no-render"}).status, 0);
  const Finished vtp = scree_in(folder_, {"export", "output/gem", "--to", "vtp"});
  EXPECT_EQ(vtp.status, 0) << vtp.error;
  EXPECT_TRUE(contains(vtp.out, "surfaces:  output/gem-vtp/surfaces.pvd")) << vtp.out;
  EXPECT_FALSE(contains(vtp.out, "axes")) << vtp.out;
  EXPECT_TRUE(contains(text_of(folder_ / "output/gem-vtp/surfaces/moving00000.vtp"), "NumberOfPolys=\"4\""));
  const Finished xyz = scree_in(folder_, {"export", "output/gem", "--to", "xyz"});
  EXPECT_TRUE(contains(xyz.out, "left out:  1 plane,")) << xyz.out << xyz.error;
  EXPECT_TRUE(contains(text_of(folder_ / "output/gem-xyz/trajectory.xyz"), "pbc=\"T F F\""));

  const std::string scene = text_of(folder_ / "output/gem/scene.yaml");
  write_text(folder_ / "output/gem/scene.yaml",
             scene.substr(0, scene.find("bodies:")) + "bodies: [{sphere: {radius: 1}, material: stone}]\n");
  const Finished other = scree_in(folder_, {"export", "output/gem", "--to", "vtp"});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.error, "of other bodies than output/gem/scene.yaml")) << other.error;
  fs::remove(folder_ / "output/gem/scene.yaml");
  for (const char* format : {"vtp", "xyz", "lammps"}) {
    const Finished none = scree_in(folder_, {"export", "output/gem", "-o", "none", "--to", format});
    EXPECT_EQ(none.status, 2) << format;
    EXPECT_TRUE(contains(none.error, "output/gem/scene.yaml: cannot be read")) << none.error;
    EXPECT_FALSE(fs::exists(folder_ / "none")) << "nothing is written";
  }
}

}  // namespace
}  // namespace scree
