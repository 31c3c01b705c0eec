// Speed against error of hand-made points: the front, orders and costs can be worked out on paper.
#include "sim/record/study.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace scree {
namespace {

StudyPoint point(const char* step, const char* mode, double error, double cost) {
  CheckResult check{.check = "q at the end",
                    .expected = "1",
                    .measured = 1 + error,
                    .error = error,
                    .verdict = Verdict::passed};
  return {{{"time.step", step}, {"mode", mode}}, {check}, "", cost};
}

/// Mode a is of second order, mode b of first; one combination fails, one is exact.
Study example() {
  Study study{"scene", {{"time.step", {"0.1", "0.05", "0.025"}}, {"mode", {"a", "b"}}}, {}};
  study.points = {point("0.1", "a", 4e-3, 1),    point("0.1", "b", 1e-1, 1),
                  point("0.05", "a", 1e-3, 2),   point("0.05", "b", 5e-2, 1.5),
                  point("0.025", "a", 25e-5, 4), point("0.025", "b", 25e-3, 3)};
  return study;
}

StudyPoint failed(const char* step) {
  return {{{"time.step", step}, {"mode", "a"}}, {}, "blew up", std::numeric_limits<double>::quiet_NaN()};
}

TEST(Study, TheFrontIsWhatNoOtherBeats) {
  Study study = example();
  EXPECT_EQ(pareto_front(study, 0), (std::vector<std::size_t>{0, 2, 4}));
  study.points.push_back(point("0.2", "b", 3e-3, 0.5));  // beats the first in both
  study.points.push_back(point("0.2", "a", 1e-3, 2));    // as good as the third: one of the two is enough
  study.points.push_back(failed("0.4"));                 // outside
  EXPECT_EQ(pareto_front(study, 0), (std::vector<std::size_t>{6, 2, 4}));
}

TEST(Study, ErrorsOfRoundingAreEqual) {
  Study study = example();
  study.points = {point("0.1", "a", 1e-16, 1), point("0.05", "a", 0, 2)};
  EXPECT_EQ(pareto_front(study, 0), std::vector<std::size_t>{0});
}

TEST(Study, CurvesDifferInTheFirstKeyAndHaveTheirOrders) {
  const Study study = example();
  const std::vector<Curve> curves = curves_of(study);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].settings, "mode=a");
  EXPECT_EQ(curves[0].points, (std::vector<std::size_t>{0, 2, 4}));
  EXPECT_NEAR(fitted_order(study, curves[0], 0), 2.0, 1e-12);
  EXPECT_NEAR(fitted_order(study, curves[1], 0), 1.0, 1e-12);
}

TEST(Study, RoundingAndFailuresHaveNoPartInTheOrder) {
  Study study = example();
  study.points.push_back(point("0.0125", "a", 1e-16, 8));
  study.points.push_back(failed("0.2"));
  EXPECT_NEAR(fitted_order(study, curves_of(study)[0], 0), 2.0, 1e-12);
  study.points[0] = failed("0.1");
  EXPECT_TRUE(std::isnan(fitted_order(study, curves_of(study)[0], 0)));  // two are left
}

TEST(Study, CheapestWayToEachPowerOfTen) {
  const std::vector<Reached> reached = cheapest_to(example(), 0);
  ASSERT_EQ(reached.size(), 2u);
  EXPECT_DOUBLE_EQ(reached[0].error, 1e-2);
  EXPECT_EQ(reached[0].point, 0u);
  EXPECT_DOUBLE_EQ(reached[1].error, 1e-3);
  EXPECT_EQ(reached[1].point, 2u);
}

TEST(Study, ACheckWithoutAnExactValueHasNoError) {
  Study study = example();
  EXPECT_FALSE(study.has_no_error(0));
  for (StudyPoint& each : study.points) each.checks[0].error = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(study.has_no_error(0));
  EXPECT_TRUE(pareto_front(study, 0).empty());
  study.points = {failed("0.4")};
  EXPECT_FALSE(study.has_no_error(0)) << "no run says so";
}

TEST(Study, WritesEveryCombination) {
  Study study = example();
  study.points.push_back(failed("0.2"));
  const std::string csv = to_csv(study);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 8);
  EXPECT_TRUE(
      csv.starts_with("time.step,mode,wall_s_per_simulated_s,problem,error: q at the end\n0.1,a,1,,0.004\n"));
  EXPECT_NE(csv.find("0.2,a,nan,blew up,inf\n"), std::string::npos);
  const auto json = nlohmann::json::parse(to_json(study));
  EXPECT_EQ(json["points"].size(), 7u);
  EXPECT_EQ(json["points"][6]["problem"], "blew up");
  EXPECT_NEAR(json["checks"][0]["orders"][1]["order"].get<double>(), 1.0, 1e-12);
  EXPECT_EQ(json["checks"][0]["front"], (std::vector<int>{0, 2, 4}));
}

TEST(Study, PlotsEveryCurveAndLeavesOutWhatIsOutside) {
  Study study = example();
  study.points.push_back(failed("0.2"));
  const std::string script = plot_script(study, 0, "error_1");
  EXPECT_NE(script.find("set output 'error_1.svg'"), std::string::npos);
  EXPECT_NE(script.find("set output 'error_1.png'"), std::string::npos);
  EXPECT_NE(script.find("title 'mode=b'"), std::string::npos);
  EXPECT_EQ(script.find("nan"), std::string::npos);
  EXPECT_EQ(script.find("inf"), std::string::npos);
}

}  // namespace
}  // namespace scree
