// End to end, through the program: exit statuses, and what is and is not written.
#include "tests/sim/cli/program.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <thread>

namespace scree {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::Test;

/// A ball in free fall from 10 m for 0.1 s; `tail` may add keys.
std::string falling_ball(const std::string& tail = "") {
  return R"(format: 1
gravity: [0, 0, -10]
time: {end: 0.1, step: 0.01}
materials:
  stone: {density: 1000}
bodies:
  - {sphere: {radius: 0.1}, name: ball, at: [0, 0, 10], material: stone}
record: {metrics_every: 0.02}
)" + tail;
}
const std::string no_pictures = "render: false\n";
// Free flight is exact: z = 10 - 5 t^2.
const std::string good_check = "checks: [{measure: ball.position.z, expect: 9.95, tolerance: 1.0e-12}]\n";
const std::string bad_check = "checks: [{measure: ball.position.z, expect: 9, tolerance: 0.1}]\n";

/// Every file below a folder, but for the run's lock.
std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != ".lock") {
      files.push_back(fs::relative(entry.path(), folder).string());
    }
  }
  std::ranges::sort(files);
  return files;
}

Json manifest_in(const fs::path& run) { return Json::parse(text_of(run / "manifest.json")); }

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class ProgramTest : public Test {
 protected:
  Finished run_scene(const std::string& text, std::vector<std::string> more = {}) {
    write_text(folder_ / "fall.yaml", text);
    more.insert(more.begin(), {"run", "fall.yaml"});
    return scree_in(folder_, more);
  }
  TemporaryFolder folder_;
};

TEST_F(ProgramTest, RunWritesTheRunFolder) {
  const Finished run = run_scene(falling_ball(no_pictures + good_check));
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(run.error, "");
  EXPECT_EQ(files_below(folder_ / "output/fall"),
            (std::vector<std::string>{"final.csv", "log.txt", "manifest.json", "metrics.csv", "scene.yaml",
                                      "timing.csv"}));
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
  EXPECT_TRUE(contains(run.out, "the run stopped before that")) << run.out;
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["status"], "done");
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["steps"], 5);
}

TEST_F(ProgramTest, ARunThatCannotGoOnExitsWith3AndSavesWhatItHas) {
  // After one step the ball is farther away than a float can say.
  const Finished run =
      run_scene(falling_ball(no_pictures + good_check), {"--set", "bodies[0].velocity=[1e150, 0, 0]"});
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(run.error.starts_with("scree: step 1 (t = 0 s): ")) << run.error;
  const Json manifest = manifest_in(folder_ / "output/fall");
  EXPECT_EQ(manifest["status"], "failed");
  EXPECT_EQ("scree: " + manifest["error"].get<std::string>() + "\n", run.error);
  EXPECT_EQ(manifest["steps"], 0);
  EXPECT_EQ(manifest["checks"][0]["verdict"], "not evaluated");
  const std::string metrics = text_of(folder_ / "output/fall/metrics.csv");
  EXPECT_EQ(std::ranges::count(metrics, '\n'), 2) << "the row of the last good state";
}

TEST_F(ProgramTest, ARunWhoseStartCannotBeObservedStillLeavesAManifest) {
  // The kinetic energy overflows.
  const Finished run = run_scene(falling_ball(no_pictures), {"--set", "bodies[0].velocity=[1e200, 0, 0]"});
  EXPECT_EQ(run.status, 3);
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["status"], "failed");
  EXPECT_EQ(
      files_below(folder_ / "output/fall"),
      (std::vector<std::string>{"log.txt", "manifest.json", "metrics.csv", "scene.yaml", "timing.csv"}));
}

TEST_F(ProgramTest, AnInterruptExitsWith130AndSavesWhatItHas) {
  write_text(folder_ / "long.yaml", falling_ball(no_pictures));
  const Program run(folder_,
                    {"run", "long.yaml", "-o", "run", "--set", "time.end=1e6", "--set", "time.step=1e-4"});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(folder_ / "run/metrics.csv.part") && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
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
            (std::vector<std::string>{checkpoint, "log.txt", "manifest.json", "metrics.csv", "scene.yaml",
                                      "timing.csv"}));
}

TEST_F(ProgramTest, ReproduceRunsAgainAndComparesTheStates) {
  ASSERT_EQ(run_scene(falling_ball(no_pictures)).status, 0);
  const fs::path manifest = folder_ / "output/fall/manifest.json";
  const Finished same = scree_in(folder_, {"run", "--reproduce", manifest.string()});
  EXPECT_EQ(same.status, 0) << same.error;
  EXPECT_TRUE(contains(same.out, "12 states, 0 different")) << same.out;
  Json changed = manifest_in(folder_ / "output/fall");
  changed["states"][3]["hash"] = "0123456789abcdef";
  write_text(manifest, changed.dump());
  const Finished other = scree_in(folder_, {"run", "--reproduce", manifest.string()});
  EXPECT_EQ(other.status, 1);
  EXPECT_TRUE(contains(other.out, "DIFFERENT")) << other.out;
  EXPECT_TRUE(contains(other.out, "12 states, 1 different")) << other.out;
  write_text(folder_ / "output/fall/scene.yaml", falling_ball(no_pictures + "seed: 3\n"));
  EXPECT_EQ(scree_in(folder_, {"run", "--reproduce", manifest.string()}).status, 2);
  write_text(manifest, "{}");
  EXPECT_EQ(scree_in(folder_, {"run", "--reproduce", manifest.string()}).status, 2);
}

TEST_F(ProgramTest, CompareSaysHowFarTwoRunsDiffer) {
  const std::string scene = falling_ball(no_pictures);
  ASSERT_EQ(run_scene(scene, {"-o", "one"}).status, 0);
  ASSERT_EQ(run_scene(scene, {"-o", "two"}).status, 0);
  ASSERT_EQ(run_scene(scene, {"-o", "three", "--set", "gravity=[0, 0, -10.001]"}).status, 0);
  EXPECT_EQ(scree_in(folder_, {"compare", "one", "two"}).status, 0);
  const Finished apart = scree_in(folder_, {"compare", "one", "three"});
  EXPECT_EQ(apart.status, 1);
  EXPECT_TRUE(contains(apart.out, "final.csv vz")) << apart.out;
  EXPECT_EQ(scree_in(folder_, {"compare", "one", "three", "--tolerance", "1e-3"}).status, 1)
      << "what is rounding differs by all of itself";
  EXPECT_EQ(
      scree_in(folder_, {"compare", "one", "three", "--tolerance", "1e-3", "--absolute", "1e-12"}).status, 0);
  EXPECT_EQ(scree_in(folder_, {"compare", "one", "nowhere"}).status, 2);
}

class ResumeTest : public ProgramTest {
 protected:
  /// What must be the same whether a run was stopped or not.
  void expect_same(const std::string& a, const std::string& b) const {
    for (const char* file : {"metrics.csv", "final.csv", "frames/00000.png", "frames/00005.png"})
      EXPECT_EQ(text_of(folder_ / a / file), text_of(folder_ / b / file)) << file;
    for (const char* key :
         {"status", "state_hash", "states", "steps", "checks", "observation", "counters", "frames"})
      EXPECT_EQ(manifest_in(folder_ / a)[key], manifest_in(folder_ / b)[key]) << key;
    EXPECT_EQ(files_below(folder_ / a), files_below(folder_ / b));
  }
  const std::string scene_ = falling_ball("render: {size: [64, 48], fps: 50}\n" + good_check);
};

TEST_F(ResumeTest, GoesOnAsIfTheRunHadNeverStopped) {
  ASSERT_EQ(run_scene(scene_, {"-o", "whole"}).status, 0);
  // The check is of the end.
  ASSERT_EQ(run_scene(scene_, {"-o", "parts", "--until", "0.03"}).status, 1);
  ASSERT_EQ(run_scene(scene_, {"-o", "parts", "--until", "0.05", "--resume"}).status, 1);
  EXPECT_EQ(run_scene(scene_, {"-o", "parts"}).status, 2) << "an earlier run is there";
  const Finished last = run_scene(scene_, {"-o", "parts", "--resume"});
  EXPECT_EQ(last.status, 0) << last.error;
  EXPECT_TRUE(contains(last.out, "resumed at t = 0.05 s, step 5")) << last.out;
  expect_same("whole", "parts");
  EXPECT_EQ(manifest_in(folder_ / "parts")["resumed_at"], Json({3, 5}));
  EXPECT_FALSE(fs::exists(folder_ / "parts/checkpoint")) << "nobody will go on from there";
  EXPECT_TRUE(contains(text_of(folder_ / "parts/log.txt"), "resumed at t = 0.03 s"));
}

TEST_F(ResumeTest, OfAFinishedRunSaysSo) {
  ASSERT_EQ(run_scene(scene_).status, 0);
  const std::string manifest = text_of(folder_ / "output/fall/manifest.json");
  const Finished again = run_scene(scene_, {"--resume"});
  EXPECT_EQ(again.status, 0);
  EXPECT_EQ(again.out, "output/fall: done, there is nothing to resume\n");
  EXPECT_EQ(text_of(folder_ / "output/fall/manifest.json"), manifest);
}

TEST_F(ResumeTest, WithoutACheckpointStartsFromTheBeginning) {
  ASSERT_EQ(run_scene(scene_, {"-o", "whole"}).status, 0);
  const Finished fresh = run_scene(scene_, {"-o", "fresh", "--resume"});
  EXPECT_EQ(fresh.status, 0) << fresh.error;
  EXPECT_TRUE(contains(fresh.out, "no checkpoint: from the beginning")) << fresh.out;
  expect_same("whole", "fresh");
}

TEST_F(ResumeTest, OfAnotherRunIsRefusedByName) {
  ASSERT_EQ(run_scene(scene_, {"--until", "0.05"}).status, 1);
  const std::string manifest = text_of(folder_ / "output/fall/manifest.json");
  const auto expect_refused = [&](const std::vector<std::string>& more, const std::string& words) {
    std::vector<std::string> arguments = {"--resume"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished run = run_scene(scene_, arguments);
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(run.error.starts_with("scree: --resume: the checkpoint is of ")) << run.error;
    EXPECT_TRUE(contains(run.error, words)) << run.error;
    EXPECT_EQ(text_of(folder_ / "output/fall/manifest.json"), manifest) << "nothing was written";
  };
  expect_refused({"--set", "gravity=[0, 0, -1.62]"}, "here `gravity: [0, 0, -1.62]`");
  expect_refused({"--set", "precision=mixed"}, "there `precision: double`, here `precision: mixed`");
  expect_refused({"--no-render"}, "without --no-render");
}

TEST_F(ResumeTest, ADamagedCheckpointIsPassedOver) {
  ASSERT_EQ(run_scene(scene_, {"-o", "whole"}).status, 0);
  ASSERT_EQ(run_scene(scene_, {"-o", "parts", "--until", "0.03"}).status, 1);
  ASSERT_EQ(run_scene(scene_, {"-o", "parts", "--until", "0.07", "--resume"}).status, 1);
  const fs::path newest = folder_ / "parts/checkpoint/000000000007.h5";
  std::string bytes = text_of(newest);
  bytes[bytes.size() / 2] ^= 1;
  write_text(newest, bytes);
  const Finished run = run_scene(scene_, {"-o", "parts", "--resume"});
  EXPECT_EQ(run.status, 0);
  EXPECT_TRUE(contains(run.error, "000000000007.h5: is damaged")) << run.error;
  EXPECT_TRUE(contains(run.out, "resumed at t = 0.03 s, step 3")) << run.out;
  expect_same("whole", "parts");
}

TEST_F(ResumeTest, WithoutTheRowsThatWereWrittenIsAnErrorWithTheNumbers) {
  ASSERT_EQ(run_scene(scene_, {"--until", "0.05"}).status, 1);
  fs::remove(folder_ / "output/fall/log.txt");
  fs::remove(folder_ / "output/fall/metrics.csv");
  const Finished run = run_scene(scene_, {"--resume"});
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(contains(run.error, "metrics.csv.part: 0 bytes of ")) << run.error;
}

TEST_F(ResumeTest, MaxHoursStopsWithACheckpoint) {
  const Finished run = run_scene(falling_ball(no_pictures), {"--max-hours", "0.00003", "--set",
                                                             "time.end=1e6", "--set", "time.step=1e-4"});
  EXPECT_EQ(run.status, 130);
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["status"], "interrupted");
  EXPECT_TRUE(fs::exists(folder_ / "output/fall/checkpoint"));
}

class VerifyTest : public ProgramTest {
 protected:
  Finished verify(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"verify", "scenes", "--json", "table.json"});
    return scree_in(folder_, more);
  }
  void add(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / "scenes" / name).parent_path());
    write_text(folder_ / "scenes" / name, text);
  }
  Json table() { return Json::parse(text_of(folder_ / "table.json")); }
};

TEST_F(VerifyTest, ShowsEveryCheckAndWritesNoRunFolder) {
  add("a.yaml", falling_ball(good_check));
  add("deeper/b.yaml", falling_ball("checks: [{measure: speed.max, above: 0.5, below: 2}]\n"));
  add("c.yaml", falling_ball());
  const Finished run = verify();
  EXPECT_EQ(run.status, 0) << run.out << run.error;
  EXPECT_TRUE(contains(run.out, "pass   ball.position.z at the end")) << run.out;
  EXPECT_TRUE(contains(run.out, "above 0.5, below 2")) << run.out;
  EXPECT_TRUE(contains(run.out, "c.yaml  left out: has no checks")) << run.out;
  EXPECT_TRUE(contains(run.out, "2 passed, 0 failed")) << run.out;
  EXPECT_EQ(table()["passed"], 2);
  EXPECT_NEAR(table()["scenes"][0]["checks"][0]["measured"].get<double>(), 9.95, 1e-12);
  EXPECT_FALSE(fs::exists(folder_ / "output"));
}

TEST_F(VerifyTest, TheWorstStatusWins) {
  add("a.yaml", falling_ball(good_check));
  add("b.yaml", falling_ball(bad_check));
  EXPECT_EQ(verify().status, 1);
  add("c.yaml", falling_ball("gravitty: 1\n"));
  EXPECT_EQ(verify().status, 2);
  const std::string bodies = "at: [0, 0, 10], ";
  std::string overflow = falling_ball(good_check);
  overflow.insert(overflow.find(bodies), "velocity: [1e200, 0, 0], ");
  add("d.yaml", overflow);
  const Finished run = verify();
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(contains(run.out, "1 passed, 3 failed")) << run.out;
}

TEST_F(VerifyTest, LongScenesAreLeftOutUnlessAsked) {
  add("a.yaml", falling_ball(good_check));
  add("b.yaml", falling_ball("label: long\n" + bad_check));
  const Finished usual = verify();
  EXPECT_EQ(usual.status, 0);
  EXPECT_TRUE(contains(usual.out, "scenes left out: 1")) << usual.out;
  EXPECT_EQ(verify({"--label", "long"}).status, 1);
  EXPECT_EQ(table()["passed"], 0);
  EXPECT_EQ(verify({"--all"}).status, 1);
  EXPECT_EQ(table()["passed"], 1);
}

/// Balls thrown to random places: their centre is 5 m high, give or take 5 / sqrt(3 * 20) m, and of 12 seeds
/// the mean a twelfth of that squared; so the interval is some 0.8 m wide.
TEST_F(VerifyTest, JudgesEnsemblesByTheirMeanAndRunsOfOneSeedNot) {
  const auto ensemble = [](const std::string& tolerance) {
    return "format: 1\nseeds: 12\ntime: {end: 0.01, step: 0.01}\nmaterials: {glass: {}}\nrender: "
           "false\nbodies:\n"
           "  - {sphere: {radius: 0.01}, scatter: {count: 20, from: [0, 0, 0], to: [10, 10, 10]}, material: "
           "glass}\n"
           "checks:\n  - {measure: centre.z, at: 0, expect: 5, tolerance: " +
           tolerance + ", confidence: 0.95}\n  - {measure: bodies.count, expect: 20, tolerance: 0}\n";
  };
  add("a.yaml", ensemble("1.5"));
  const Finished run = verify();
  EXPECT_EQ(run.status, 0) << run.out;
  EXPECT_TRUE(contains(run.out, "+-")) << run.out;
  EXPECT_TRUE(contains(run.out, "2 passed, 0 failed")) << run.out;
  add("a.yaml", ensemble("0.1"));
  EXPECT_EQ(verify().status, 1) << "so few seeds do not tell so much";
  const Finished one = scree_in(folder_, {"run", "scenes/a.yaml"});
  EXPECT_EQ(one.status, 0) << one.out;
  EXPECT_TRUE(contains(one.out, "1 passed, 0 failed, 1 told by many seeds alone")) << one.out;
}

TEST_F(VerifyTest, VariesSettingsAndCountsThemApart) {
  add("a.yaml", falling_ball(good_check));
  add("b.yaml", falling_ball("checks: [{measure: energy.total, below: -1e9, in_default_mode: 1e9}]\n"));
  const Finished run = verify({"--vary", "response.mode=default,accurate", "--vary", "time.substeps=1,2"});
  EXPECT_EQ(run.status, 1);
  EXPECT_TRUE(contains(run.out, "6 passed, 2 failed")) << run.out;
  EXPECT_TRUE(contains(run.out, "response.mode=default time.substeps=2\n")) << run.out;
  ASSERT_EQ(table()["scenes"].size(), 8u);
  EXPECT_EQ(table()["scenes"][7]["settings"], "response.mode=accurate time.substeps=2");
  EXPECT_EQ(table()["scenes"][7]["status"], 1);
  EXPECT_EQ(table()["scenes"][5]["status"], 0);
  EXPECT_EQ(verify({"--vary", "time.step"}).status, 2);
}

TEST_F(VerifyTest, NoScenesAreAnErrorNotAPass) {
  fs::create_directories(folder_ / "scenes");
  EXPECT_EQ(verify().status, 2);
  EXPECT_EQ(scree_in(folder_, {"verify", "nowhere"}).status, 2);
}

TEST_F(ProgramTest, PlanSaysWhatWillBeModelledAndRunsNothing) {
  write_text(folder_ / "fall.yaml", falling_ball(good_check));
  const Finished plan = scree_in(folder_, {"plan", "fall.yaml"});
  EXPECT_EQ(plan.status, 0) << plan.error;
  EXPECT_TRUE(contains(plan.out, "free spheres: 1")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "friction     off")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "in 10 steps")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "6 rows of metrics, 4 frames of 1280 x 720")) << plan.out;
  EXPECT_FALSE(fs::exists(folder_ / "output"));
  EXPECT_TRUE(Json::accept(scree_in(folder_, {"plan", "--schema"}).out));
  EXPECT_TRUE(contains(scree_in(folder_, {"plan", "--reference"}).out, "restitution"));
  EXPECT_EQ(scree_in(folder_, {"plan"}).status, 2);
}

TEST_F(ProgramTest, PlanSaysWhatIsHardInWordsForNewcomers) {
  write_text(folder_ / "fall.yaml", falling_ball());
  Finished plan = scree_in(folder_, {"plan", "fall.yaml", "--set", "bodies[0].velocity=[1, 0, 0]"});
  EXPECT_TRUE(contains(plan.out, "v dt / smallest size = 0.1: contacts are met in time")) << plan.out;
  EXPECT_TRUE(contains(plan.out, "this machine has ")) << plan.out;
  plan = scree_in(folder_, {"plan", "fall.yaml", "--set", "bodies[0].velocity=[80, 0, 0]"});
  EXPECT_TRUE(contains(plan.out, "bodies may pass through each other; try step <= 0.0012")) << plan.out;
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

TEST_F(ProgramTest, StudyTriesEveryCombinationAndDrawsIt) {
  // With substeps of a third of the step the ball falls as exactly; without gravity it is off.
  write_text(folder_ / "fall.yaml", falling_ball(good_check));
  const std::vector<std::string> command = {
      "study", "fall.yaml", "--vary", "time.substeps=1,3", "--vary", "gravity=[[0, 0, -10], [0, 0, 0]]"};
  const Finished run = scree_in(folder_, command);
  EXPECT_EQ(run.status, 0) << run.out << run.error;
  EXPECT_TRUE(contains(run.out, "4 combinations")) << run.out;
  EXPECT_TRUE(contains(run.out, "time to reach")) << run.out;
  const std::vector<std::string> files = files_below(folder_ / "output/fall-study");
  EXPECT_EQ(std::vector<std::string>(files.begin(), files.begin() + 3),
            (std::vector<std::string>{"error_1.gp", "error_1.png", "error_1.svg"}));
  const Json study = Json::parse(text_of(folder_ / "output/fall-study/study.json"));
  ASSERT_EQ(study["points"].size(), 4u);
  EXPECT_GT(study["points"][1]["checks"][0]["error"].get<double>(), 0.01);
  EXPECT_GT(study["points"][3]["wall_s_per_simulated_s"].get<double>(), 0);
  EXPECT_EQ(scree_in(folder_, command).status, 2);  // an earlier study is there
  EXPECT_EQ(scree_in(folder_, {"study", "fall.yaml"}).status, 2);
  EXPECT_EQ(scree_in(folder_, {"study", "fall.yaml", "--vary", "gravitty=1"}).status, 2);
}

TEST_F(ProgramTest, InfoAndHelp) {
  const Finished info = scree_in(folder_, {"info"});
  EXPECT_EQ(info.status, 0);
  EXPECT_TRUE(contains(info.out, "commit")) << info.out;
  for (const char* command : {"run", "verify", "study", "plan", "info"}) {
    const Finished help = scree_in(folder_, {command, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_TRUE(help.out.size() > 50) << help.out;
  }
}

}  // namespace
}  // namespace scree
