#include "sim/record/outcome.hpp"

#include "core/error.hpp"
#include "sim/record/manifest.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace scree {
namespace {

SceneOutcome sample() {
  SceneOutcome outcome{.scene = "a \"b\".yaml", .status = status_check_failed, .wall = 0.5};
  outcome.checks = {
      {.check = "x at the end",
       .expected = "1",
       .tolerance = 0.1,
       .measured = 1.0 / 3,
       .half_width = 0.25,
       .margin = -0.5,
       .verdict = Verdict::failed},
      {.check = "y",
       .expected = "below 2",
       .measured = std::numeric_limits<double>::quiet_NaN(),
       .margin = std::numeric_limits<double>::quiet_NaN(),
       .verdict = Verdict::not_evaluated,
       .problem = "not a finite number at 1 s"},
      {.check = "z", .expected = "below 2", .measured = 1, .margin = 1, .verdict = Verdict::passed}};
  return outcome;
}

TEST(Outcome, SurvivesTheWayThroughJson) {
  const SceneOutcome sent = sample();
  const SceneOutcome got = outcome_from_json(to_json(sent));
  EXPECT_EQ(got.scene, sent.scene);
  EXPECT_EQ(got.status, sent.status);
  EXPECT_EQ(got.wall, sent.wall);
  ASSERT_EQ(got.checks.size(), sent.checks.size());
  EXPECT_EQ(got.checks[0].measured, 1.0 / 3);
  EXPECT_EQ(got.checks[0].half_width, 0.25);
  EXPECT_FALSE(got.checks[1].half_width.has_value());
  EXPECT_EQ(got.checks[0].tolerance, 0.1);
  EXPECT_EQ(got.checks[0].verdict, Verdict::failed);
  EXPECT_TRUE(std::isnan(got.checks[1].measured));
  EXPECT_FALSE(got.checks[1].tolerance.has_value());
  EXPECT_EQ(got.checks[1].problem, sent.checks[1].problem);
  EXPECT_EQ(got.checks[2].verdict, Verdict::passed);
  EXPECT_THROW(outcome_from_json("{\"scene\": \"half"), RunError);
  EXPECT_THROW(outcome_from_json("{}"), RunError);
}

TEST(Outcome, ChecksThatWereNotEvaluatedAndScenesThatDidNotRunCountAsFailed) {
  const std::vector<SceneOutcome> outcomes = {
      sample(),
      {.scene = "bad.yaml", .status = status_bad_input, .message = "bad.yaml:1:1: no"},
      {.scene = "long.yaml", .left_out = "is labelled long"}};
  const Tally tally = tally_of(outcomes);
  EXPECT_EQ(tally.passed, 1);
  EXPECT_EQ(tally.failed, 3);
  EXPECT_EQ(tally.left_out, 1);
  const auto json = nlohmann::json::parse(to_json(outcomes));
  EXPECT_EQ(json["failed"], 3);
  EXPECT_EQ(json["scenes"][0]["checks"][1]["measured"], nullptr);
  EXPECT_EQ(json["scenes"][1]["message"], "bad.yaml:1:1: no");
}

TEST(Outcome, AnyCheckThatDidNotPassFailsTheRun) {
  const std::vector<CheckResult> checks = sample().checks;
  EXPECT_EQ(status_of({}), status_done);
  EXPECT_EQ(status_of({checks[2]}), status_done);
  EXPECT_EQ(status_of({checks[2], checks[1]}), status_check_failed);
  EXPECT_EQ(status_of({checks[0], checks[2]}), status_check_failed);
}

TEST(Manifest, SaysWhatRanAndHowItCameOut) {
  Scene scene;
  scene.name = "hopper";
  scene.seed = 7;
  scene.resolved = "format: 1\n";
  RunSummary run{.status = "failed", .error = "boom", .space = "host", .steps = 12, .state_hash = 0xabc};
  run.last.kinetic_linear = 0.1;
  run.last.counters.narrowphase.ccd_stopped = 3;
  run.last.counters.narrowphase.crosscheck.asked = 20;
  for (const double size : {2e-7, 2e-6, 0.5, 0.25, 12.0})
    run.last.counters.narrowphase.crosscheck.ccd_deeper.note(size);
  run.checks = sample().checks;
  run.warnings = {"no movie"};
  const auto json = nlohmann::json::parse(manifest_of(scene, run));
  EXPECT_EQ(json["status"], "failed");
  EXPECT_EQ(json["error"], "boom");
  EXPECT_EQ(json["state_hash"], "0000000000000abc");
  EXPECT_EQ(json["scene"]["seed"], 7);
  EXPECT_EQ(json["steps"], 12);
  EXPECT_EQ(json["observation"]["energy"]["total"], 0.1);
  EXPECT_EQ(json["counters"]["ccd_stopped"], 3);
  EXPECT_EQ(json["counters"]["crosscheck"],
            nlohmann::json::parse(R"({"asked": 20, "touching": {}, "ccd_shallower": {},
                                      "ccd_deeper": {"1e-06": 1, "1e-01": 2, "1e+00": 1}})"));
  EXPECT_EQ(json["checks"][0]["measured"], 1.0 / 3);
  EXPECT_EQ(json["warnings"][0], "no movie");
  EXPECT_FALSE(json["program"]["commit"].get<std::string>().empty());
  EXPECT_EQ(json["observation"]["contacts"], 0);
  run.last.contacts = -1;
  EXPECT_EQ(nlohmann::json::parse(manifest_of(scene, run))["observation"]["contacts"], nullptr);

  Scene other = scene;
  other.resolved = "format: 1\nseed: 8\n";
  EXPECT_NE(nlohmann::json::parse(manifest_of(other, run))["scene"]["hash"], json["scene"]["hash"]);
}

}  // namespace
}  // namespace scree
