// The program, end to end: its arguments, its help, and `scree compare`.
#include "tests/sim/cli/falling_ball.hpp"

namespace scree {
namespace {

TEST_F(ProgramTest, ArgumentsThatAreWrongAreToldInTheWordsOfTheHelp) {
  write_text(folder_ / "fall.yaml", falling_ball(no_pictures));
  for (const auto& [words, message] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"run", "fall.yaml", "--until", "-1"},
            "--until: must be a number >= 0, not -1; see scree run --help"},
           {{"run", "fall.yaml", "--until", "inf"},
            "--until: must be a number >= 0, not inf; see scree run --help"},
           {{"run", "fall.yaml", "--threads", "two"},
            "--threads: must be a whole number > 0, not two; see scree run --help"},
           {{"run", "fall.yaml", "--threads", "1.5"},
            "--threads: must be a whole number > 0, not 1.5; see scree run --help"},
           {{"run", "fall.yaml", "--until"}, "--until: needs a value, T; see scree run --help"},
           {{"run", "fall.yaml", "--device", "tpu"},
            "--device: must be one of auto, cuda, host, not tpu; see scree run --help"},
           {{"export", "output/fall", "--to", "foo"},
            "--to: must be one of csv, lammps, vtp, xyz, not foo; see scree export --help"},
           {{"compare", "one"}, "DIR_B is required; see scree compare --help"},
           {{"verify"}, "PATH is required; see scree verify --help"},
           {{"new", "--from", "minimal"}, "--from needs NAME; see scree new --help"},
           {{"run", "fall.yaml", "--reproduce", "m.json"},
            "give SCENE or --reproduce, not both; see scree run --help"},
           {{"run", "--reproduce", "m.json", "-o", "x"},
            "give --reproduce or --output, not both; see scree run --help"},
           {{"run", "--reproduce", "m.json", "--until", "1"},
            "give --reproduce or --until, not both; see scree run --help"},
           {{"run", "fall.yaml", "--overwrite", "--resume"},
            "give --resume or --overwrite, not both; see scree run --help"},
           {{"verify", "fall.yaml", "--label", "long", "--all"},
            "give --label or --all, not both; see scree verify --help"}}) {
    const Finished run = scree_in(folder_, words);
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.error, "scree: " + message + "\n");
    EXPECT_EQ(run.out, "");
  }
  EXPECT_TRUE(scree_in(folder_, {"--nonsense"}).error.ends_with("; see scree --help\n"));
  EXPECT_FALSE(fs::exists(folder_ / "output"));
}

TEST_F(ProgramTest, AFolderWithoutARunIsToldByItsName) {
  fs::create_directory(folder_ / "empty");
  for (const auto& [words, message] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"report", "empty"}, "empty/manifest.json: there is no such file; is empty a run folder?"},
           {{"run", "--reproduce", "empty/manifest.json"},
            "empty/manifest.json: there is no such file; is empty a run folder?"},
           {{"export", "empty", "--to", "xyz"},
            "empty/trajectory.vtkhdf: there is none; run the scene with record.trajectory: true to have one"},
           {{"export", "nowhere", "--to", "xyz"}, "nowhere: there is no such folder"}}) {
    const Finished run = scree_in(folder_, words);
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.error, "scree: " + message + "\n");
  }
  write_text(folder_ / "empty/manifest.json", "{");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"report", "empty"}, {"run", "--reproduce", "empty/manifest.json"}}) {
    const Finished run = scree_in(folder_, words);
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.error, "scree: empty/manifest.json: is not the manifest of a run\n");
  }
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

TEST_F(ProgramTest, CompareSaysHowFarTwoRunsDiffer) {
  const std::string scene = falling_ball(no_pictures);
  ASSERT_EQ(run_scene(scene, {"-o", "one"}).status, 0);
  ASSERT_EQ(run_scene(scene, {"-o", "two"}).status, 0);
  ASSERT_EQ(run_scene(scene, {"-o", "three", "--set", "gravity=[0, 0, -10.001]"}).status, 0);
  EXPECT_EQ(scree_in(folder_, {"compare", "one", "two"}).status, 0);
  const Finished apart = scree_in(folder_, {"compare", "one", "three"});
  EXPECT_EQ(apart.status, 1);
  EXPECT_TRUE(contains(apart.out, " columns differ, more than --tolerance and --absolute allow\n"))
      << apart.out;
  EXPECT_TRUE(contains(apart.out, "  first cell            column\n")) << apart.out;
  EXPECT_TRUE(contains(apart.out, "final.csv vz")) << apart.out;
  EXPECT_EQ(scree_in(folder_, {"compare", "one", "three", "--tolerance", "1e-3"}).status, 1)
      << "what is rounding differs by all of itself";
  EXPECT_EQ(
      scree_in(folder_, {"compare", "one", "three", "--tolerance", "1e-3", "--absolute", "1e-12"}).status, 0);
  fs::remove(folder_ / "two/final.csv");
  const Finished alone = scree_in(folder_, {"compare", "one", "two"});
  EXPECT_EQ(alone.status, 1);
  EXPECT_TRUE(contains(alone.out, "final.csv: only in the first run\n")) << alone.out;
  EXPECT_TRUE(contains(alone.out, ": 0 columns differ; some columns or rows are in one of the runs only\n"))
      << alone.out;
  EXPECT_EQ(scree_in(folder_, {"compare", "one", "nowhere"}).status, 2);
}

}  // namespace
}  // namespace scree
