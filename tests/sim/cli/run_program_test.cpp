// `scree run`, end to end: exit statuses, and what is and is not written.
#include "tests/sim/cli/falling_ball.hpp"

#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace scree {
namespace {

TEST_F(ProgramTest, RunWritesTheRunFolder) {
  const Finished run = run_scene(falling_ball(no_pictures + good_check));
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.error, "");
  EXPECT_EQ(files_below(folder_ / "output/fall"),
            (std::vector<std::string>{"final.csv", "log.txt", "manifest.json", "metrics.csv", "report.html",
                                      "scene.yaml", "timing.csv"}));
  EXPECT_EQ(text_of(folder_ / "output/fall/log.txt"), run.out);
  EXPECT_TRUE(contains(run.out, "1 passed, 0 failed")) << run.out;

  const Json manifest = manifest_in(folder_ / "output/fall");
  EXPECT_EQ(manifest["status"], "done");
  EXPECT_EQ(manifest["steps"], 10);
  EXPECT_EQ(manifest["steps_total"], 10);
  EXPECT_EQ(manifest["time"], 0.1);
  EXPECT_EQ(manifest["checks"][0]["verdict"], "passed");
  EXPECT_TRUE(contains(run.out, manifest["state_hash"].get<std::string>()));

  const std::string metrics = text_of(folder_ / "output/fall/metrics.csv");
  EXPECT_EQ(std::ranges::count(metrics, '\n'), 7) << "a header, and rows at 0, 0.02, ..., 0.1";
}

TEST_F(ProgramTest, LastStepIsShorterWhereTheEndIsNoMultiple) {
  const Finished run = run_scene(falling_ball(no_pictures), {"--set", "time.step=0.03"});
  EXPECT_EQ(run.status, 0) << run.error;
  const Json manifest = manifest_in(folder_ / "output/fall");
  EXPECT_EQ(manifest["steps"], 4);
  EXPECT_EQ(manifest["steps_total"], 4);
  EXPECT_EQ(manifest["time"], 0.1);
}

TEST_F(ProgramTest, MetricsAreTheSameBytesForAnyNumberOfThreads) {
  EXPECT_EQ(run_scene(falling_ball(no_pictures), {"-o", "one", "--threads", "1"}).status, 0);
  EXPECT_EQ(run_scene(falling_ball(no_pictures), {"-o", "two", "--threads", "2"}).status, 0);
  EXPECT_EQ(text_of(folder_ / "one/metrics.csv"), text_of(folder_ / "two/metrics.csv"));
  EXPECT_EQ(manifest_in(folder_ / "one")["state_hash"], manifest_in(folder_ / "two")["state_hash"]);
}

TEST_F(ProgramTest, DrawsFramesAndAMovie) {
  const Finished run = run_scene(falling_ball("render: {size: [64, 48], fps: 50}\n"));
  ASSERT_EQ(run.status, 0) << run.error;
  const Json manifest = manifest_in(folder_ / "output/fall");
  if (!manifest["warnings"].empty()) GTEST_SKIP() << "no pictures on this machine: " << manifest["warnings"];
  EXPECT_EQ(manifest["frames"], 6);
  EXPECT_EQ(manifest["movie"], "movie.mp4");
  const auto files = files_below(folder_ / "output/fall");
  EXPECT_EQ(std::ranges::count(files, "movie.mp4"), 1);
  EXPECT_EQ(std::ranges::count(files, "frames/00005.png"), 1);
  EXPECT_TRUE(std::ranges::none_of(files, [](const std::string& file) { return file.ends_with(".part"); }));
}

TEST_F(ProgramTest, FramesAreTheSameBytesInEveryRun) {
  const std::string scene =
      falling_ball("render: {size: [320, 240], fps: 50, color: force, overlay: [forces, grid]}\n");
  ASSERT_EQ(run_scene(scene, {"-o", "one"}).status, 0);
  ASSERT_EQ(run_scene(scene, {"-o", "two"}).status, 0);
  for (const char* frame : {"frames/00000.png", "frames/00003.png", "frames/00005.png"}) {
    EXPECT_EQ(text_of(folder_ / "one" / frame), text_of(folder_ / "two" / frame));
  }
}

TEST_F(ProgramTest, TroubleWithTheMovieDoesNotCostTheNumbers) {
  const char* path = std::getenv("PATH");
  const std::string saved = path == nullptr ? "" : path;
  setenv("PATH", "/nowhere", 1);
  const Finished run = run_scene(falling_ball("render: {size: [64, 48], fps: 50}\n" + good_check));
  setenv("PATH", saved.c_str(), 1);
  EXPECT_EQ(run.status, 0);
  EXPECT_TRUE(contains(run.error, "scree: warning: no ")) << run.error;
  const Json manifest = manifest_in(folder_ / "output/fall");
  EXPECT_EQ(manifest["status"], "done");
  EXPECT_EQ(manifest["warnings"].size(), 1U);
  EXPECT_FALSE(manifest.contains("movie"));
}

TEST_F(ProgramTest, AFrameThatCannotBeWrittenEndsTheRunAndKeepsTheNumbers) {
  // The one folder that refuses files to root, too.
  fs::create_directories(folder_ / "output/fall");
  fs::create_directory_symlink("/proc", folder_ / "output/fall/frames");
  const Finished run =
      run_scene(falling_ball("render: {size: [64, 48], fps: 50}\n" + good_check), {"--overwrite"});
  const Json manifest = manifest_in(folder_ / "output/fall");
  if (!manifest["warnings"].empty()) GTEST_SKIP() << "no pictures on this machine: " << manifest["warnings"];
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(run.error.starts_with("scree: cannot write output/fall/frames/00000.png: ")) << run.error;
  EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << "said once: " << run.error;
  EXPECT_EQ(manifest["status"], "failed");
  EXPECT_EQ("scree: " + manifest["error"].get<std::string>() + "\n", run.error);
  EXPECT_EQ(manifest["frames"], 0);
  EXPECT_FALSE(manifest.contains("movie"));
  // Up to the step that the run came to.
  const std::string metrics = text_of(folder_ / "output/fall/metrics.csv");
  const std::string last = metrics.substr(metrics.rfind('\n', metrics.size() - 2) + 1);
  EXPECT_TRUE(metrics.ends_with('\n'));
  EXPECT_TRUE(contains(last, ',' + manifest["steps"].dump() + ',')) << last;
}

TEST_F(ProgramTest, BadInputExitsWith2AndWritesNothing) {
  for (const auto& [scene, more] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {falling_ball("gravitty: [0, 0, 1]\n"), {}},
           {falling_ball(), {"--set", "time.step=-1"}},
           {falling_ball(), {"--set", "nonsense"}},
           {falling_ball(), {"--device", "tpu"}},
           {falling_ball(), {"--threads", "0"}}}) {
    const Finished run = run_scene(scene, more);
    EXPECT_EQ(run.status, 2) << run.error;
    EXPECT_TRUE(run.error.starts_with("scree: ")) << run.error;
    EXPECT_EQ(run.out, "");
    EXPECT_FALSE(fs::exists(folder_ / "output"));
  }
  EXPECT_TRUE(contains(run_scene(falling_ball("gravitty: [0, 0, 1]\n")).error, "fall.yaml:9:"));
  EXPECT_EQ(scree_in(folder_, {"run", "missing.yaml"}).status, 2);
  EXPECT_EQ(scree_in(folder_, {}).status, 2);
  EXPECT_EQ(scree_in(folder_, {"walk"}).status, 2);
}

TEST_F(ProgramTest, AFailedCheckExitsWith1AndKeepsTheRun) {
  const Finished run = run_scene(falling_ball(no_pictures + bad_check));
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.out, "FAIL")) << run.out;
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["checks"][0]["verdict"], "failed");
}

TEST_F(ProgramTest, AnEarlierRunIsKeptUnlessToldToOverwriteIt) {
  const std::string scene = falling_ball(no_pictures);
  ASSERT_EQ(run_scene(scene).status, 0);
  const std::string manifest = text_of(folder_ / "output/fall/manifest.json");
  const Finished again = run_scene(scene);
  EXPECT_EQ(again.status, 2);
  EXPECT_TRUE(contains(again.error, "--overwrite")) << again.error;
  EXPECT_EQ(text_of(folder_ / "output/fall/manifest.json"), manifest);
  EXPECT_EQ(run_scene(scene, {"--overwrite"}).status, 0);
}

TEST_F(ProgramTest, UntilStopsEarlyAndChecksBeyondItDoNotPass) {
  const Finished run = run_scene(falling_ball(no_pictures + good_check), {"--until", "0.05"});
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.out, "fall: done at t = 0.05 s of 0.1 s, 5 steps in ")) << run.out;
  EXPECT_TRUE(contains(run.out, "  -      ball.position.z at the end")) << run.out;
  EXPECT_TRUE(contains(run.out, "the run stopped before that")) << run.out;
  EXPECT_TRUE(contains(run.out, "0 passed, 0 failed, 1 not reached\n")) << run.out;
  EXPECT_TRUE(contains(run.out, "to continue: the same command with --resume and without --until\n"))
      << run.out;
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["checks"][0]["verdict"], "not reached");
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["status"], "done");
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["steps"], 5);
}

TEST_F(ProgramTest, ARunThatCannotGoOnExitsWith3AndSavesWhatItHas) {
  // After one step the ball is farther away than a float can say.
  const Finished run =
      run_scene(falling_ball(no_pictures + good_check), {"--set", "bodies[0].velocity=[1e150, 0, 0]"});
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(
      run.error.starts_with("scree: step 1 at t = 0 s failed, also when it was taken again in 4 substeps: "))
      << run.error;
  const Json manifest = manifest_in(folder_ / "output/fall");
  EXPECT_EQ(manifest["status"], "failed");
  EXPECT_EQ("scree: " + manifest["error"].get<std::string>() + "\n", run.error);
  EXPECT_EQ(manifest["steps"], 0);
  EXPECT_EQ(manifest["checks"][0]["verdict"], "not reached");
  EXPECT_TRUE(contains(run.out, "picture:  the bodies named, before the step that failed: ") ||
              contains(run.error, "there is no picture of the bodies that failed: "))
      << run.out << run.error;
  const std::string metrics = text_of(folder_ / "output/fall/metrics.csv");
  EXPECT_EQ(std::ranges::count(metrics, '\n'), 2) << "the row of the last good state";
  ASSERT_EQ(manifest["failed_bodies"].size(), 1u);
  EXPECT_EQ(manifest["failed_bodies"][0]["name"], "ball (body 0)");
  EXPECT_EQ(manifest["failed_bodies"][0]["velocity"][0], 1e150) << "as it was before the step";
}

TEST_F(ProgramTest, ABodyThatLeavesTheWorldIsShownWhereItWas) {
  const std::string world = "world: {from: [-1, -1, 9.97], to: [1, 1, 11]}\n";
  const Finished stopped = run_scene(falling_ball(no_pictures + world));
  EXPECT_EQ(stopped.status, 3);
  EXPECT_TRUE(contains(stopped.error, "ball (body 0): outside of the world")) << stopped.error;
  EXPECT_GT(fs::file_size(folder_ / "output/fall/failure.png"), 500u);
  EXPECT_FALSE(fs::is_empty(folder_ / "output/fall/checkpoint"));
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["observation"]["contacts"], nullptr)
      << "they are those of the step that was undone";
  const Finished counted =
      run_scene(falling_ball(no_pictures + world), {"--overwrite", "--set", "world.leaving=remove"});
  EXPECT_EQ(counted.status, 0);
  EXPECT_TRUE(contains(counted.out,
                       "warning: bodies that left the world and were taken out: 1; later measurements do not "
                       "include them. To have fewer: a larger box in world.from and world.to."))
      << counted.out;
  EXPECT_FALSE(fs::exists(folder_ / "output/fall/failure.png"));
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["guards"]["left"]["count"], 1);
}

TEST_F(ProgramTest, AGuardThatDoesNotMatterIsInTheReportAlone) {
  // One sweep is not enough for two balls on top of each other, which hardly overlap all the same.
  const std::string stack = R"(format: 1
gravity: [0, 0, -10]
time: {end: 0.1, step: 0.01}
materials: {stone: {density: 1000}}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {sphere: {radius: 0.1}, name: low, at: [0, 0, 0.1], material: stone}
  - {sphere: {radius: 0.1}, name: high, at: [0, 0, 0.3], material: stone}
response: {iterations: 1, warm_start: false}
render: false
)";
  const Finished run = run_scene(stack);
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_FALSE(contains(run.out, "warning:")) << run.out;
  const Json guard = manifest_in(folder_ / "output/fall")["guards"]["sweeps"];
  EXPECT_GT(guard["count"], 0);
  EXPECT_EQ(guard["matters"], false);
  EXPECT_TRUE(contains(guard["effect"].get<std::string>(), "the deepest overlap was")) << guard;
  const std::string report = text_of(folder_ / "output/fall/report.html");
  EXPECT_TRUE(contains(report, "substeps that used all their sweeps"));
  EXPECT_TRUE(contains(report, guard["effect"].get<std::string>()));
}

TEST_F(ProgramTest, AJsonSceneEndsInTheSameState) {
  ASSERT_EQ(run_scene(falling_ball(no_pictures)).status, 0);
  write_text(
      folder_ / "fall.json",
      R"({"format": 1, "gravity": [0, 0, -10], "time": {"end": 0.1, "step": 1e-2}, "materials": {"stone":
{"density": 1000}}, "bodies": [{"sphere": {"radius": 0.1}, "name": "ball", "at": [0, 0, 10], "material": "stone",
"fixed": false}], "record": {"metrics_every": 0.02}, "response": {"mode": "default"}, "precision": "double",
"render": false})");
  ASSERT_EQ(scree_in(folder_, {"run", "fall.json", "-o", "json"}).status, 0);
  EXPECT_EQ(manifest_in(folder_ / "json")["state_hash"], manifest_in(folder_ / "output/fall")["state_hash"]);
  EXPECT_EQ(text_of(folder_ / "json/scene.yaml"), text_of(folder_ / "output/fall/scene.yaml"));
}

TEST_F(ProgramTest, WhatATableHasBesidesIsSaidOnceByEachCommand) {
  write_text(folder_ / "bed.csv", "id;radius;x;y;z\n7;0.1;0;0;10\n");
  const std::string scene =
      "format: 1\ntime: {end: 0.1, step: 0.01}\nmaterials: {stone: {}}\nbodies: [{file: bed.csv, name: b, "
      "material: "
      "stone}]\nrender: false\nchecks: [{measure: \"b[0].position.z\", expect: 10, tolerance: 1.0e-9}]\n";
  const auto times = [](const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  };
  const Finished run = run_scene(scene);
  EXPECT_EQ(run.status, 0);
  for (const Finished& said :
       {run, scree_in(folder_, {"plan", "fall.yaml"}), scree_in(folder_, {"verify", "fall.yaml"})}) {
    EXPECT_EQ(times(said.out + said.error, "are ignored: id"), 1) << said.out << said.error;
    EXPECT_EQ(times(said.out + said.error, "by its sizes each body is a sphere"), 1)
        << said.out << said.error;
  }
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["warnings"].size(), 2u);
}

TEST_F(ProgramTest, ARunWhoseStartCannotBeObservedStillLeavesAManifest) {
  // The kinetic energy overflows.
  const Finished run = run_scene(falling_ball(no_pictures), {"--set", "bodies[0].velocity=[1e200, 0, 0]"});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["status"], "failed");
  EXPECT_EQ(files_below(folder_ / "output/fall"),
            (std::vector<std::string>{"log.txt", "manifest.json", "metrics.csv", "report.html", "scene.yaml",
                                      "timing.csv"}));
}

/// A run of a million seconds, which has begun to write.
Program long_run(const TemporaryFolder& folder) {
  write_text(folder / "long.yaml", falling_ball(no_pictures));
  Program run(folder, {"run", "long.yaml", "-o", "run", "--set", "time.end=1e6", "--set", "time.step=1e-4"});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(folder / "run/metrics.csv.part") && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return run;
}

TEST_F(ProgramTest, AClosedTerminalStopsARunAsAnInterruptDoes) {
  const Program run = long_run(folder_);
  run.send(SIGHUP);
  EXPECT_EQ(run.wait().status, 130);
  EXPECT_EQ(manifest_in(folder_ / "run")["status"], "interrupted");
}

TEST_F(ProgramTest, AnInterruptExitsWith130AndSavesWhatItHas) {
  const Program run = long_run(folder_);
  {
    const TemporaryFolder elsewhere;
    write_text(elsewhere / "long.yaml", falling_ball(no_pictures));
    const Finished second =
        scree_in(elsewhere, {"run", "long.yaml", "-o", (folder_ / "run").string(), "--overwrite"});
    EXPECT_EQ(second.status, 2);
    EXPECT_TRUE(contains(second.error, "another run is writing here")) << second.error;
  }
  run.send(SIGINT);
  EXPECT_EQ(run.wait().status, 130);
  EXPECT_EQ(manifest_in(folder_ / "run")["status"], "interrupted");
  const std::string checkpoint =
      fmt::format("checkpoint/{:012}.h5", manifest_in(folder_ / "run")["steps"].get<std::int64_t>());
  EXPECT_EQ(files_below(folder_ / "run"),
            (std::vector<std::string>{checkpoint, "log.txt", "manifest.json", "metrics.csv", "report.html",
                                      "scene.yaml", "timing.csv"}));
}

TEST_F(ProgramTest, ReproduceRunsAgainAndComparesTheStates) {
  ASSERT_EQ(run_scene(falling_ball(no_pictures)).status, 0);
  const fs::path manifest = folder_ / "output/fall/manifest.json";
  const Finished same = scree_in(folder_, {"run", "--reproduce", manifest.string()});
  EXPECT_EQ(same.status, 0) << same.error;
  EXPECT_TRUE(contains(same.out, "11 states, 0 different: every state is the same to the last bit\n"))
      << same.out;
  Json changed = manifest_in(folder_ / "output/fall");
  changed["states"][3]["hash"] = "0123456789abcdef";
  write_text(manifest, changed.dump());
  const Finished other = scree_in(folder_, {"run", "--reproduce", manifest.string()});
  EXPECT_EQ(other.status, 1);
  EXPECT_TRUE(contains(other.out, "DIFFERENT")) << other.out;
  EXPECT_TRUE(contains(other.out, "11 states, 1 different\n")) << other.out;
  write_text(folder_ / "output/fall/scene.yaml", falling_ball(no_pictures + "seed: 3\n"));
  EXPECT_EQ(scree_in(folder_, {"run", "--reproduce", manifest.string()}).status, 2);
  write_text(manifest, "{}");
  EXPECT_EQ(scree_in(folder_, {"run", "--reproduce", manifest.string()}).status, 2);
}

TEST_F(ProgramTest, ARunStartsFromWhereAnotherEnded) {
  ASSERT_EQ(run_scene(falling_ball(no_pictures)).status, 0);
  const std::string next = R"(format: 1
gravity: [0, 0, -10]
time: {end: 0.1, step: 0.01}
materials:
  clay: {density: 2000}
  stone: {density: 1000}
bodies:
  - {file: output/fall, name: ball}
checks:
  - {measure: "ball[0].position.z", at: 0, expect: 9.95, tolerance: 1.0e-12}
  - {measure: "ball[0].position.z", expect: 9.8, tolerance: 1.0e-12}
)" + no_pictures;
  write_text(folder_ / "next.yaml", next);
  const Finished run = scree_in(folder_, {"run", "next.yaml"});
  EXPECT_EQ(run.status, 0) << run.out << run.error;
  EXPECT_TRUE(contains(run.out, "2 passed, 0 failed")) << run.out;
}

// The hulls are in the run's folder, which belongs to the run: it is refused, and replaced, like any other.
TEST_F(ProgramTest, ARunStartsFromThePolyhedraAndServosOfAnother) {
  const std::string head =
      "format: 1\ntime: {end: 0.1, step: 0.01}\nmaterials: {stone: {density: 1000}}\nrender: false\n";
  const std::string first =
      head +
      "name: first\nbodies:\n"
      "  - {polyhedron: {points: [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]]}, velocity: [1, "
      "0, 0], material: stone}\n"
      "  - {box: {size: 1}, at: [0, 5, 0], servo: {axis: [0, 1, 0], force: 10}, material: "
      "stone}\n";
  ASSERT_EQ(run_scene(first).status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "output/first/hulls/0.obj"));
  EXPECT_EQ(run_scene(first).status, 2) << "there is a run";
  ASSERT_EQ(run_scene(first, {"--overwrite"}).status, 0);
  // Free flight, and 10 N on 1000 kg, for twice the time.
  const std::string second = head +
                             "name: second\nbodies: [{file: output/first, name: b}]\nchecks:\n"
                             "  - {measure: \"b[0].position.x\", expect: 0.45, tolerance: 1.0e-12}\n"
                             "  - {measure: \"b[1].position.y\", expect: 5.0002, tolerance: 1.0e-12}\n"
                             "  - {measure: \"b[1].velocity.y\", expect: 0.002, tolerance: 1.0e-12}\n";
  const Finished run = run_scene(second);
  EXPECT_EQ(run.status, 0) << run.out << run.error;
}

/// Returns a scene of two balls, of which the first is fixed and the second is at the place `at`.
std::string two_balls(const std::string& at) {
  return "format: 1\ntime: {end: 0.01, step: 0.01}\nmaterials: {stone: {}}\nrender: false\nname: "
         "two\nbodies:\n"
         "  - {sphere: {radius: 0.1}, name: a, fixed: true, material: stone}\n"
         "  - {sphere: {radius: 0.1}, at: " +
         at + ", material: stone}\n";
}

TEST_F(ProgramTest, ALargeOverlapIsAWarning) {
  const std::string words =
      "the deepest overlap was 150 % of the smaller body's radius or half edge, between a (body 0) and body "
      "1, at "
      "t = 0 s: the scene places these bodies into each other; move them apart in the scene";
  const Finished deep = run_scene(two_balls("[0.05, 0, 0]"));
  EXPECT_EQ(deep.status, 0);
  EXPECT_TRUE(contains(deep.error, "scree: warning: " + words + "\n")) << deep.error;
  EXPECT_EQ(manifest_in(folder_ / "output/two")["warnings"], Json({words}));
  EXPECT_TRUE(contains(text_of(folder_ / "output/two/report.html"), "the deepest overlap was 150 %"));
  const Finished slight = run_scene(two_balls("[0.199, 0, 0]"), {"--overwrite"});
  EXPECT_EQ(slight.status, 0);
  EXPECT_EQ(slight.error, "");
  EXPECT_TRUE(
      contains(text_of(folder_ / "output/two/report.html"), "no limit was reached that changes the result."));
}

TEST_F(ProgramTest, EmittersWithoutRoomAreInTheSummary) {
  const Finished run = run_scene(
      "format: 1\ntime: {end: 0.1, step: 0.01}\nmaterials: {stone: {}}\nrender: false\nbodies:\n"
      "  - {sphere: {radius: 0.1}, emit: {count: 5, rate: 100, from: [0, 0, 0], to: [0.01, 0.01, 0.01]}, "
      "material: stone}\n");
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_TRUE(contains(run.out, "emitters: 1 of 5 bodies found room; the others waited until the end\n"))
      << run.out;
}

}  // namespace
}  // namespace scree
