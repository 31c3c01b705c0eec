// Runs that were stopped, end to end: they go on as if they had never been, or are refused by name.
#include "tests/sim/cli/falling_ball.hpp"

#include <string_view>
#include <utility>

namespace scree {
namespace {

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

TEST_F(ResumeTest, OfAFinishedRunOfAnotherSceneIsRefused) {
  ASSERT_EQ(run_scene(scene_).status, 0);
  const std::string manifest = text_of(folder_ / "output/fall/manifest.json");
  for (const char* setting : {"gravity=[0, 0, -1.62]", "time.end=0.2"}) {
    const Finished other = run_scene(scene_, {"--resume", "--set", setting});
    EXPECT_EQ(other.status, 2) << setting;
    EXPECT_EQ(
        other.error,
        "scree: --resume: the run in output/fall is finished, and its scene is another one; use -o DIR, or "
        "--overwrite\n");
    EXPECT_EQ(text_of(folder_ / "output/fall/manifest.json"), manifest) << "nothing was written";
    EXPECT_TRUE(fs::exists(folder_ / "output/fall/final.csv"));
  }
}

TEST_F(ResumeTest, WithoutACheckpointStartsFromTheBeginning) {
  ASSERT_EQ(run_scene(scene_, {"-o", "whole"}).status, 0);
  const Finished fresh = run_scene(scene_, {"-o", "fresh", "--resume"});
  EXPECT_EQ(fresh.status, 0) << fresh.error;
  EXPECT_TRUE(contains(
      fresh.out,
      "there is no checkpoint: the run starts from the beginning and replaces the files in the folder"))
      << fresh.out;
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
  expect_refused({"--set", "gravity=[0, 0, -1.62]"}, "this one `gravity: [0, 0, -1.62]`");
  expect_refused({"--set", "precision=mixed"}, "it has `precision: double`, this one `precision: mixed`");
  expect_refused({"--no-render"}, "without --no-render; leave out --no-render to continue it, or give ");
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

TEST_F(ResumeTest, WhereNoCheckpointCanBeReadTheRunIsKept) {
  ASSERT_EQ(run_scene(scene_, {"--until", "0.05"}).status, 1);
  const fs::path only = folder_ / "output/fall/checkpoint/000000000005.h5";
  const std::string whole = text_of(only);
  std::string of_another_version = whole, damaged = whole;
  of_another_version[std::string_view("scree checkpoint ").size()] = '5';
  damaged[damaged.size() / 2] ^= 1;
  const auto run_folder = [this] { return files_below(folder_ / "output/fall"); };
  const std::vector<std::string> before = run_folder();
  for (const auto& [bytes, words] :
       {std::pair(of_another_version, "is no checkpoint of this version of scree"),
        std::pair(damaged, "is damaged: its checksum is wrong")}) {
    write_text(only, bytes);
    const Finished run = run_scene(scene_, {"--resume"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(run.error.starts_with("scree: --resume: no checkpoint can be read: ")) << run.error;
    EXPECT_TRUE(contains(run.error, words)) << run.error;
    EXPECT_TRUE(contains(run.error, "; --overwrite starts from the beginning\n")) << run.error;
    EXPECT_EQ(run_folder(), before) << "nothing was removed";
  }
  write_text(only, whole);
  EXPECT_EQ(run_scene(scene_, {"--resume"}).status, 0);
}

TEST_F(ResumeTest, WithoutTheRowsThatWereWrittenIsAnErrorWithTheNumbers) {
  ASSERT_EQ(run_scene(scene_, {"--until", "0.05"}).status, 1);
  fs::remove(folder_ / "output/fall/log.txt");
  fs::remove(folder_ / "output/fall/metrics.csv");
  const Finished run = run_scene(scene_, {"--resume"});
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(contains(run.error, "metrics.csv.part: 0 bytes of ")) << run.error;
  EXPECT_TRUE(contains(run.error, " are left, so the run cannot be continued; --overwrite ")) << run.error;
}

TEST_F(ResumeTest, MaxHoursStopsWithACheckpoint) {
  const Finished run = run_scene(falling_ball(no_pictures), {"--max-hours", "0.00003", "--set",
                                                             "time.end=1e6", "--set", "time.step=1e-4"});
  EXPECT_EQ(run.status, 130);
  EXPECT_EQ(manifest_in(folder_ / "output/fall")["status"], "interrupted");
  EXPECT_TRUE(contains(run.out, " s of 1e+06 s, ")) << run.out;
  EXPECT_TRUE(contains(run.out, "to continue: the same command with --resume\n")) << run.out;
  EXPECT_TRUE(fs::exists(folder_ / "output/fall/checkpoint"));
}

}  // namespace
}  // namespace scree
