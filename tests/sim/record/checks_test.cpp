// Checks against hand-made histories, whose reductions can be worked out on paper.
#include "sim/record/checks.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace scree {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Steps of 1 s; speed.max at step k is values[k], and so are energy.total and ball.position.x.
std::vector<CheckResult> results_of(const std::vector<Check>& checks, const std::vector<double>& values,
                                    double energy_scale = 10, double end = 0) {
  Scene scene;
  scene.time = {.end = end > 0 ? end : static_cast<double>(values.size() - 1), .step = 1, .substeps = 1};
  scene.body_names = {{"ball", 3}};
  scene.checks = checks;
  Checks evaluated(scene, TimeGrid(scene.time));
  Observation observation;
  BodyState body = {};
  const Probe probe{.observe = [&](bool) -> const Observation& { return observation; },
                    .body =
                        [&](std::int32_t id) {
                          EXPECT_EQ(id, 3);
                          return body;
                        }};
  for (std::size_t k = 0; k < values.size(); ++k) {
    observation.speed_max = observation.potential = values[k];
    body.position = Vec3(values[k], 0, 0);
    evaluated.record(static_cast<std::int64_t>(k), probe);
  }
  return evaluated.results(energy_scale);
}

CheckResult result_of(const Check& check, const std::vector<double>& values, double energy_scale = 10,
                      double end = 0) {
  return results_of({check}, values, energy_scale, end).at(0);
}

Check check_of(const char* measure) {
  Check check;
  check.measure = measure;
  return check;
}
Check check_at(double time) {
  Check check = check_of("speed.max");
  check.at = time;
  check.below = 1000;
  return check;
}
Check check_over(double from, double to, Reduce reduce, double level = 0) {
  Check check = check_of("speed.max");
  check.over = {from, to};
  check.reduce = reduce;
  check.level = level;
  check.below = 1000;
  return check;
}

TEST(Checks, AtIsTheNearestStepAndTheEndByDefault) {
  const std::vector<double> values = {10, 20, 30, 40};
  EXPECT_EQ(result_of(check_at(0), values).measured, 10);
  EXPECT_EQ(result_of(check_at(1.4), values).measured, 20);
  EXPECT_EQ(result_of(check_at(1.6), values).measured, 30);
  EXPECT_EQ(result_of(check_at(3), values).measured, 40);
  Check at_end = check_at(0);
  at_end.at.reset();
  EXPECT_EQ(result_of(at_end, values).measured, 40);
}

TEST(Checks, TheErrorIsHowFarFromIdeal) {
  Check check = check_at(3);
  EXPECT_EQ(result_of(check, {10, 20, 30, -40}).error, 40);  // of a bound alone: from 0
  check.expect = -45;
  check.tolerance = 1;
  EXPECT_EQ(result_of(check, {10, 20, 30, -40}).error, 5);
  check.expect.reset();
  check.below.reset();
  check.above = -30;
  EXPECT_TRUE(std::isnan(result_of(check, {10, 20, 30, -40}).error)) << "nothing says what is exact";
  EXPECT_TRUE(std::isnan(result_of(check, {10, 20, 30, 40}).error));
  EXPECT_FALSE(gives_error(check));
  check.below = 50;
  EXPECT_TRUE(std::isnan(result_of(check, {10, 20, 30, 40}).error)) << "nor does a range";
  check.expect = 41;
  check.tolerance = 5;
  EXPECT_EQ(result_of(check, {10, 20, 30, 40}).error, 1);
  EXPECT_TRUE(std::isnan(result_of(check, {10, 20, 30, nan}).error));
}

TEST(Checks, EachReductionOfAHandMadeHistory) {
  const std::vector<double> values = {99, 2, -1, 4, 3, 99};  // steps 1 to 4 count
  const auto reduced = [&](Reduce reduce, double level = 0) {
    return result_of(check_over(1, 4, reduce, level), values).measured;
  };
  EXPECT_EQ(reduced(Reduce::max), 4);
  EXPECT_EQ(reduced(Reduce::min), -1);
  EXPECT_EQ(reduced(Reduce::mean), 2);
  EXPECT_EQ(reduced(Reduce::drift), 3);  // |-1 - 2|
  EXPECT_EQ(reduced(Reduce::range), 5);
  EXPECT_EQ(reduced(Reduce::crossings), 2);
  EXPECT_EQ(reduced(Reduce::crossings, 3.5), 2);
  EXPECT_EQ(reduced(Reduce::crossings, 50), 0);
}

TEST(Checks, TouchingTheLevelIsNoCrossing) {
  const auto crossings = [](const std::vector<double>& values) {
    return result_of(check_over(0, 10, Reduce::crossings), values, 10, 10).measured;
  };
  EXPECT_EQ(crossings({1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}), 0);
  EXPECT_EQ(crossings({0, 0, 1, 0, 0, -1, 0, 1, 1, 1, 0}), 2);
}

TEST(Checks, ExpectationWithToleranceAndMargin) {
  Check check = check_of("ball.position.x");
  check.expect = 5;
  check.tolerance = 0.5;
  const CheckResult near = result_of(check, {0, 5.25});
  EXPECT_EQ(near.verdict, Verdict::passed);
  EXPECT_EQ(near.margin, 0.25);
  const CheckResult far = result_of(check, {0, 4});
  EXPECT_EQ(far.verdict, Verdict::failed);
  EXPECT_EQ(far.margin, -0.5);
  EXPECT_EQ(result_of(check, {0, 5.5}).verdict, Verdict::passed) << "the tolerance itself is allowed";
}

TEST(Checks, RelativeIsToTheExpectation) {
  Check check = check_of("speed.max");
  check.expect = -200;
  check.relative = 0.01;
  EXPECT_EQ(result_of(check, {0, -201}).tolerance, 2.0);
  EXPECT_EQ(result_of(check, {0, -201}).verdict, Verdict::passed);
  EXPECT_EQ(result_of(check, {0, -203}).verdict, Verdict::failed);
}

TEST(Checks, BelowAndAboveAreStrictAndMayGoTogether) {
  Check check = check_of("speed.max");
  check.above = 1;
  check.below = 2;
  EXPECT_EQ(result_of(check, {0, 1.75}).verdict, Verdict::passed);
  EXPECT_EQ(result_of(check, {0, 1.75}).margin, 0.25);
  EXPECT_EQ(result_of(check, {0, 1}).verdict, Verdict::failed);
  EXPECT_EQ(result_of(check, {0, 2}).verdict, Verdict::failed);
  EXPECT_EQ(result_of(check, {0, 2.5}).margin, -0.5);
}

TEST(Checks, EnergiesCompareToTheEnergyScale) {
  Check relative = check_of("energy.total");
  relative.expect = 1000;
  relative.relative = 1e-3;
  EXPECT_DOUBLE_EQ(*result_of(relative, {0, 1000}, 50).tolerance, 0.05);

  Check drift = check_of("energy.total");
  drift.over = {0, 2};
  drift.reduce = Reduce::drift;
  drift.below = 0.1;
  EXPECT_EQ(result_of(drift, {1000, 1004, 999}, 50).measured, 4.0 / 50);
  EXPECT_EQ(result_of(drift, {1000, 1004, 999}, 50).verdict, Verdict::passed);
  EXPECT_EQ(result_of(drift, {1000, 1006, 999}, 50).verdict, Verdict::failed);
  EXPECT_EQ(result_of(drift, {7, 7, 7}, 0).verdict, Verdict::passed) << "nothing moved, and nothing drifted";
  EXPECT_EQ(result_of(drift, {7, 8, 7}, 0).verdict, Verdict::failed);

  Check unexplained = check_of("energy.unexplained");  // has been divided by the scale already
  unexplained.expect = 0;
  unexplained.tolerance = 1e-9;
  unexplained.relative = 1;
  EXPECT_EQ(result_of(unexplained, {0, 0}, 50).tolerance, 1e-9);
}

TEST(Checks, NanAndInfinityAreErrorsNotPasses) {
  for (const double bad : {nan, HUGE_VAL, -HUGE_VAL}) {
    for (const Reduce reduce : {Reduce::max, Reduce::min, Reduce::mean, Reduce::drift, Reduce::crossings}) {
      const CheckResult result = result_of(check_over(0, 2, reduce), {1, bad, 1});
      EXPECT_EQ(result.verdict, Verdict::not_evaluated);
      EXPECT_EQ(result.problem, "not a finite number at 1 s");
      EXPECT_TRUE(std::isnan(result.measured));
    }
    EXPECT_EQ(result_of(check_at(1), {1, bad, 1}).verdict, Verdict::not_evaluated);
  }
  EXPECT_EQ(result_of(check_at(2), {1, nan, 1}).verdict, Verdict::passed) << "a step that does not count";
}

TEST(Checks, TimesThatTheRunDoesNotReachAreErrors) {
  EXPECT_EQ(result_of(check_at(7), {1, 1, 1}).verdict, Verdict::not_evaluated);
  EXPECT_EQ(result_of(check_over(1, 7, Reduce::max), {1, 1, 1}).verdict, Verdict::not_evaluated);
  EXPECT_EQ(result_of(check_over(1.2, 1.8, Reduce::max), {1, 1, 1}).problem, "no step in that interval");
  EXPECT_EQ(result_of(check_over(1, 5, Reduce::max), {1, 1, 1}, 10, 5).verdict, Verdict::not_reached);
  EXPECT_TRUE(is_failure(Verdict::not_reached));
  // Stopped after step 2 of 5.
  EXPECT_EQ(result_of(check_over(1, 5, Reduce::max), {1, 1, 1}, 10, 5).problem,
            "the run stopped before that");
  EXPECT_EQ(result_of(check_at(1), {1, 1, 1}, 10, 5).verdict, Verdict::passed);
}

TEST(Checks, AskOnlyForWhatTheyNeed) {
  Scene scene;
  scene.time = {.end = 4, .step = 1, .substeps = 1};
  scene.body_names = {{"ball", 0}};
  scene.checks = {check_over(1, 2, Reduce::max), check_at(4), check_of("ball.position.z")};
  scene.checks.back().above = -1;
  Checks checks(scene, TimeGrid(scene.time));
  std::set<std::int64_t> observed, asked_for_body;
  std::int64_t step = 0;
  const Observation nothing;
  const Probe probe{.observe = [&](bool) -> const Observation& {
                      observed.insert(step);
                      return nothing;
                    },
                    .body =
                        [&](std::int32_t) {
                          asked_for_body.insert(step);
                          return BodyState{};
                        }};
  for (; step <= 4; ++step) checks.record(step, probe);
  EXPECT_EQ(observed, (std::set<std::int64_t>{1, 2, 4}));
  EXPECT_EQ(asked_for_body, (std::set<std::int64_t>{4}));
}

/// Steps of 1 s at whose end ball.position.x is each seed's value.
std::vector<CheckResult> pooled_over(const Check& check, const std::vector<double>& values) {
  std::vector<std::vector<CheckResult>> runs;
  for (const double value : values) runs.push_back({result_of(check, {0, value})});
  return pooled({check}, runs);
}

TEST(Checks, TheMeanOfTheSeedsIsJudgedByItsInterval) {
  Check check = check_of("ball.position.x");
  check.expect = 10;
  check.tolerance = 1;
  check.confidence = 0.95;
  EXPECT_EQ(result_of(check, {0, 10}).verdict, Verdict::of_seeds) << "one run tells nothing";
  EXPECT_FALSE(is_failure(Verdict::of_seeds));
  // Mean 10.5, s = 0.5; of four values t(0.975, 3) = 3.18245 (tables).
  const CheckResult result = pooled_over(check, {10, 10, 11, 11}).at(0);
  EXPECT_EQ(result.measured, 10.5);
  const double half_width = 3.182446305284263 * std::sqrt(1.0 / 3.0) / 2;
  EXPECT_NEAR(*result.half_width, half_width, 1e-12);
  EXPECT_NEAR(result.margin, 1 - 0.5 - half_width, 1e-12);
  EXPECT_EQ(result.error, 0.5);
  EXPECT_EQ(result.verdict, Verdict::failed) << "the mean is within the tolerance, its interval is not";
  check.tolerance = 1.5;
  EXPECT_EQ(pooled_over(check, {10, 10, 11, 11}).at(0).verdict, Verdict::passed);
  Check below = check_of("ball.position.x");
  below.below = 11;
  below.confidence = 0.95;
  EXPECT_EQ(pooled_over(below, {10, 10, 11, 11}).at(0).verdict, Verdict::failed);
  EXPECT_EQ(pooled_over(below, {10, 10, 10.1, 10.1}).at(0).verdict, Verdict::passed);
}

TEST(Checks, WithoutAConfidenceTheWorstSeedCounts) {
  Check check = check_of("ball.position.x");
  check.expect = 10;
  check.tolerance = 1;
  EXPECT_EQ(pooled_over(check, {10, 10.5, 9.9}).at(0).measured, 10.5);
  EXPECT_EQ(pooled_over(check, {10, 10.5, 9.9}).at(0).verdict, Verdict::passed);
  EXPECT_EQ(pooled_over(check, {10, 12, 9.9}).at(0).verdict, Verdict::failed);
  EXPECT_EQ(pooled_over(check, {10, nan, 12}).at(0).verdict, Verdict::not_evaluated);
}

TEST(Checks, SayInWordsWhatTheyAsk) {
  Check check = check_over(1, 6, Reduce::crossings, 0.5);
  check.above = 2;
  const CheckResult result = result_of(check, {1, 1, 1, 1, 1, 1, 1});
  EXPECT_EQ(result.check, "crossings of speed.max through 0.5 over 1 to 6");
  EXPECT_EQ(result.expected, "above 2, below 1000");
}

TEST(Checks, UnknownMeasuresAreBadInput) {
  EXPECT_THROW(result_of(check_of("speed.maximum"), {1, 1}), InputError);
  EXPECT_THROW(result_of(check_of("bal.position.x"), {1, 1}), InputError);
}

}  // namespace
}  // namespace scree
