// `scree study`, end to end.
#include "tests/sim/cli/falling_ball.hpp"

namespace scree {
namespace {

TEST_F(ProgramTest, StudyTriesEveryCombinationAndDrawsIt) {
  // With substeps of a third of the step the ball falls as exactly; without gravity it is off.
  write_text(folder_ / "fall.yaml", falling_ball(good_check));
  const std::vector<std::string> command = {
      "study", "fall.yaml", "--vary", "time.substeps=1,3", "--vary", "gravity=[[0, 0, -10], [0, 0, 0]]"};
  const Finished run = scree_in(folder_, command);
  EXPECT_EQ(run.status, 0) << run.out << run.error;
  EXPECT_TRUE(contains(run.out, "4 combinations. Measuring errors, ")) << run.out;
  EXPECT_TRUE(contains(run.out, "Measuring times, one run at a time, median of 3:\n")) << run.out;
  EXPECT_TRUE(contains(run.out, "settings (* = no other is faster and as exact)\n")) << run.out;
  EXPECT_TRUE(contains(run.out, "time to reach")) << run.out;
  const std::vector<std::string> files = files_below(folder_ / "output/fall-study");
  EXPECT_EQ(std::vector<std::string>(files.begin(), files.begin() + 3),
            (std::vector<std::string>{"error_1.gp", "error_1.png", "error_1.svg"}));
  const Json study = Json::parse(text_of(folder_ / "output/fall-study/study.json"));
  ASSERT_EQ(study["points"].size(), 4u);
  EXPECT_GT(study["points"][1]["checks"][0]["error"].get<double>(), 0.01);
  EXPECT_GT(study["points"][3]["wall_s_per_simulated_s"].get<double>(), 0);
  const Finished again = scree_in(folder_, command);
  EXPECT_EQ(again.status, 2);
  EXPECT_EQ(again.error,
            "scree: output/fall-study: holds earlier results; --overwrite replaces them, -o DIR writes "
            "elsewhere\n");
  const Finished bare = scree_in(folder_, {"study", "fall.yaml"});
  EXPECT_EQ(bare.status, 2);
  EXPECT_EQ(bare.error, "scree: --vary KEY=V1,V2,... is missing: study needs at least one setting to vary\n");
  EXPECT_EQ(scree_in(folder_, {"study", "fall.yaml", "--vary", "gravitty=1"}).status, 2);
}

TEST_F(ProgramTest, StudyNeedsACheckThatSaysWhatIsExact) {
  const std::string above = "{measure: ball.position.z, above: 5}";
  const std::string below = "{measure: energy.unexplained, below: 1.0e-9}";
  write_text(folder_ / "fall.yaml", falling_ball("checks: [" + above + "]\n"));
  const std::vector<std::string> command = {"study",     "fall.yaml", "--vary", "time.substeps=1,2",
                                            "--repeats", "1"};
  const Finished none = scree_in(folder_, command);
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(contains(none.error, "has no check with `expect`, or with `below` alone")) << none.error;
  write_text(folder_ / "fall.yaml", falling_ball("checks: [" + above + ", " + below + "]\n"));
  const Finished run = scree_in(folder_, command);
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_TRUE(contains(run.out, "\nno error of ball.position.z at the end: ")) << run.out;
  EXPECT_TRUE(contains(run.out, "\nerror of energy.unexplained at the end\n")) << run.out;
  const Json study = Json::parse(text_of(folder_ / "output/fall-study/study.json"));
  EXPECT_EQ(study["points"][0]["checks"][0]["error"], nullptr);
  EXPECT_TRUE(study["checks"][0]["front"].empty());
}

}  // namespace
}  // namespace scree
