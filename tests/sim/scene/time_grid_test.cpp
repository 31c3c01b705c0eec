#include "sim/scene/time_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace scree {
namespace {

TimeGrid grid_of(double end, double step) { return TimeGrid({.end = end, .step = step, .substeps = 1}); }

TEST(TimeGrid, StepsHaveTheSceneLengthButForAShorterLast) {
  const TimeGrid even({.end = 1, .step = 0.1});
  for (std::int64_t step = 1; step <= even.last(); ++step) EXPECT_EQ(even.length(step), 0.1);
  const TimeGrid uneven({.end = 1, .step = 0.3});
  EXPECT_EQ(uneven.length(3), 0.3);
  EXPECT_NEAR(uneven.length(4), 0.1, 1e-15);
}

TEST(TimeGrid, CountsWholeStepsInSpiteOfRounding) {
  EXPECT_EQ(grid_of(6, 0.002).last(), 3000);
  EXPECT_EQ(grid_of(0.3, 0.1).last(), 3);  // although 0.3 / 0.1 < 3
  EXPECT_EQ(grid_of(0.7, 0.1).last(), 7);
  EXPECT_EQ(grid_of(1.1, 0.1).last(), 11);  // although 1.1 / 0.1 > 11
}

TEST(TimeGrid, LastStepIsShorterAndEndsAtTheEnd) {
  const TimeGrid grid = grid_of(1, 0.3);
  EXPECT_EQ(grid.last(), 4);
  EXPECT_EQ(grid.time(4), 1.0);
  EXPECT_EQ(grid.time(3), 3 * 0.3);
}

/// Finds the step nearest to a time by comparing every step's time with it.
std::int64_t nearest_by_search(const TimeGrid& grid, double time) {
  std::int64_t best = 0;
  for (std::int64_t k = 1; k <= grid.last(); ++k) {
    if (std::abs(grid.time(k) - time) < std::abs(grid.time(best) - time)) best = k;
  }
  return best;
}

TEST(TimeGrid, NearestIsTheOneFoundBySearch) {
  for (const TimeGrid& grid : {grid_of(1, 0.3), grid_of(1, 0.1), grid_of(0.95, 0.1), grid_of(0.05, 0.1)}) {
    for (double time = -0.5; time < 1.5; time += 0.007) {
      EXPECT_EQ(grid.nearest(time), nearest_by_search(grid, time)) << time;
    }
  }
}

TEST(TimeGrid, IntervalsIncludeTheirEnds) {
  const TimeGrid grid = grid_of(1, 0.1);
  EXPECT_EQ(grid.first_in(0.3), 3);
  EXPECT_EQ(grid.last_in(0.3), 3);  // although 3 * 0.1 > 0.3
  EXPECT_EQ(grid.first_in(0.31), 4);
  EXPECT_EQ(grid.first_in(0.29), 3);
  EXPECT_EQ(grid.last_in(0.69), 6);
  EXPECT_EQ(grid.last_in(0.71), 7);
  EXPECT_EQ(grid.first_in(0), 0);
  EXPECT_EQ(grid.last_in(1), 10);
  EXPECT_GT(grid.first_in(0.41), grid.last_in(0.49)) << "no step between";
}

TEST(TimeGrid, ContainsItsEndInSpiteOfRounding) {
  EXPECT_TRUE(grid_of(0.3, 0.1).contains(3 * 0.1));  // although 3 * 0.1 > 0.3
  EXPECT_FALSE(grid_of(1, 0.1).contains(1.01));
}

std::vector<std::int64_t> due_at_each_step(const TimeGrid& grid, double period) {
  Cadence cadence(grid, period);
  std::vector<std::int64_t> due;
  for (std::int64_t k = 0; k <= grid.last(); ++k) due.push_back(cadence.due(k));
  return due;
}

TEST(Cadence, HappensAtTheStepNearestToEachMultiple) {
  using Due = std::vector<std::int64_t>;
  EXPECT_EQ(due_at_each_step(grid_of(1, 0.1), 0.3), (Due{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}));
  EXPECT_EQ(due_at_each_step(grid_of(0.4, 0.1), 0.16), (Due{1, 0, 1, 1, 0}));  // multiples 0, 0.16 and 0.32
  EXPECT_EQ(due_at_each_step(grid_of(0.75, 0.25), 0.125), (Due{2, 2, 2, 1})) << "ties go to the earlier step";
  EXPECT_EQ(due_at_each_step(grid_of(0.3, 0.1), 0), (Due{1, 0, 0, 0}));
  EXPECT_EQ(due_at_each_step(grid_of(0.3, 0.1), std::numeric_limits<double>::infinity()), (Due{1, 0, 0, 0}));
}

TEST(Cadence, LosesNoFrameWhateverTheRates) {
  const auto due = due_at_each_step(grid_of(6, 0.002), 1.0 / 30);
  EXPECT_EQ(std::accumulate(due.begin(), due.end(), std::int64_t{0}), 181);
  Cadence at_once(grid_of(6, 0.002), 1.0 / 30);
  EXPECT_EQ(at_once.due(3000), 181) << "steps that were not asked about are made up for";
}

TEST(TimeGrid, SpansAreHalfOpenAndTakenAtTheNearestSteps) {
  const TimeGrid grid({.end = 1, .step = 0.1});
  const auto steps = [&](double from, double until) {
    const TimeGrid::Steps s = grid.steps_in({from, until});
    return std::pair(s.first, s.end);
  };
  EXPECT_EQ(steps(0, HUGE_VAL), std::pair(std::int64_t{0}, std::int64_t{11}));
  EXPECT_EQ(steps(0.3, 0.7), std::pair(std::int64_t{3}, std::int64_t{7}));
  EXPECT_EQ(steps(0.34, 0.66), std::pair(std::int64_t{3}, std::int64_t{7}));
  EXPECT_EQ(steps(0, 1), std::pair(std::int64_t{0}, std::int64_t{10}));  // gone in the last state
  EXPECT_EQ(steps(0, 1.01), std::pair(std::int64_t{0}, std::int64_t{11}));
  EXPECT_FALSE(grid.steps_in({0.3, 0.7}).holds(2));
  EXPECT_TRUE(grid.steps_in({0.3, 0.7}).holds(3));
  EXPECT_TRUE(grid.steps_in({0.3, 0.7}).holds(6));
  EXPECT_FALSE(grid.steps_in({0.3, 0.7}).holds(7));
}

}  // namespace
}  // namespace scree
