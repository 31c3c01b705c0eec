#include "sim/response/sweep_count.hpp"

#include "core/tolerances.hpp"

#include <gtest/gtest.h>

namespace scree::solver {
namespace {

constexpr int balls = 6, boxes = 12;  // as in plan_sweeps()

/// Judges `times` periods of as many substeps as are judged together.
void judge(SweepCount& count, int times, double residual, double dissipated = 0) {
  for (int k = 0; k < 32 * times; ++k) count.judge(k % 2 == 0 ? residual : -residual, 1.0, dissipated);
}

TEST(SweepCount, AHeapIsSweptAsUsualAtFirst) {
  SweepCount of_balls, of_boxes;
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), balls);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), 2 * boxes);
}

TEST(SweepCount, WhatIsLeftUndoneAsksForMore) {
  SweepCount of_balls, of_boxes;
  of_boxes.sweeps(boxes, true, 1.0);
  for (const int expected : {12, 24, 48, 96, 96}) {
    judge(of_balls, 1, 2 * tolerance::residual_power);
    EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), expected);
  }
  for (const int expected : {48, 96, 96}) {
    judge(of_boxes, 1, 2 * tolerance::residual_power);
    EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), expected);
  }
}

TEST(SweepCount, LittleAsksForFewer) {
  SweepCount of_balls, of_boxes;
  of_boxes.sweeps(boxes, true, 1.0);
  for (const int expected : {3, 2}) {
    EXPECT_FALSE(of_balls.needs_least_sweeps());
    judge(of_balls, 1, 0.5 * tolerance::least_sweeps_power);
    EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), expected);
  }
  EXPECT_TRUE(of_balls.needs_least_sweeps());
  judge(of_boxes, 3, 0.5 * tolerance::least_sweeps_power);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), 24);
}

TEST(SweepCount, AHeapThatMovesIsSweptAsUsual) {
  SweepCount of_balls, of_boxes;
  of_boxes.sweeps(boxes, true, 1.0);
  judge(of_balls, 3, 0.08, 0.9);
  judge(of_boxes, 3, 0.05, 0.6);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), balls);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), boxes);
  // This holds whatever the heap was swept before. A slow mode that dissipates as much does not count as such
  // motion.
  judge(of_balls, 1, 0.4);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), 24) << "much residual power is left";
  judge(of_balls, 2, 0.08, 0.9);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), balls);
  judge(of_balls, 1, 0.3, 0.9);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), 12);
}

TEST(SweepCount, OneSubstepDecidesNothing) {
  SweepCount count;
  count.judge(0.4, 1.0, 0.0);
  EXPECT_EQ(count.sweeps(balls, false, 1.0), balls);
}

TEST(SweepCount, AHeapThatHasJustFallenIsSweptAtOnce) {
  SweepCount of_balls, of_boxes;
  of_balls.judge(0.6, 1.0, 0.2);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), 96);
  of_boxes.judge(-0.6, 1.0, 0.2);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), 96);
  // Where all bodies move, such a residual is left however often the heap is swept.
  SweepCount of_flow;
  of_flow.judge(1.0, 1.0, 2.0);
  EXPECT_EQ(of_flow.sweeps(balls, false, 1.0), balls);
  // As soon as little is left, there are fewer sweeps again.
  for (const int expected : {48, 24, 12, 6}) {
    judge(of_balls, 1, 0.01, 0.5);
    EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), expected);
  }
}

TEST(SweepCount, EightSubstepsTellThatAllFlows) {
  SweepCount of_flow, of_more;
  for (SweepCount* count : {&of_flow, &of_more}) {
    count->judge(0.6, 1.0, 0.2);
    EXPECT_EQ(count->sweeps(balls, false, 1.0), 96);
  }
  for (int k = 0; k < 8; ++k) {
    EXPECT_FALSE(of_flow.flows()) << k;
    of_flow.judge(0.05, 1.0, 0.9);
    of_more.judge(0.12, 1.0, 0.9);
  }
  EXPECT_TRUE(of_flow.flows());
  EXPECT_EQ(of_flow.sweeps(balls, false, 1.0), balls);
  EXPECT_EQ(of_more.sweeps(balls, false, 1.0), 96) << "more residual power is left than flowing explains";
  judge(of_flow, 1, 0.01, 0.5);
  EXPECT_FALSE(of_flow.flows());
}

/// Judges `times` periods of as many substeps as show that a heap flows.
void flow(SweepCount& count, int times, double overlap, double dissipated = 1.0) {
  for (int k = 0; k < 8 * times; ++k) {
    count.judge(0.02, 1.0, dissipated);
    count.judge_overlap(overlap);
  }
}

TEST(SweepCount, AHeapThatFlowsIsSweptByItsOverlaps) {
  SweepCount count;
  EXPECT_DOUBLE_EQ(count.change(), tolerance::heap_change);
  const double little = 0.5 * tolerance::little_overlap_in_flow;
  const double much = 1.5 * tolerance::much_overlap_in_flow;
  for (const double expected : {2 * tolerance::heap_change, 4 * tolerance::heap_change,
                                tolerance::heap_change_in_flow, tolerance::heap_change_in_flow}) {
    flow(count, 1, little);
    EXPECT_DOUBLE_EQ(count.change(), expected);
  }
  flow(count, 3, 0.5 * (tolerance::little_overlap_in_flow + tolerance::much_overlap_in_flow));
  EXPECT_DOUBLE_EQ(count.change(), tolerance::heap_change_in_flow);
  flow(count, 1, much);
  EXPECT_DOUBLE_EQ(count.change(), 4 * tolerance::heap_change);
  flow(count, 1, 2 * much);
  EXPECT_DOUBLE_EQ(count.change(), tolerance::heap_change);
}

TEST(SweepCount, AHeapThatLandsLayerByLayerDoesNotFlow) {
  SweepCount count;
  flow(count, 8, 0.0, 0.7);
  EXPECT_FALSE(count.flows());
  EXPECT_TRUE(count.moves());
  EXPECT_DOUBLE_EQ(count.change(), tolerance::heap_change);
}

TEST(SweepCount, BodiesAtRestDoNotMove) {
  SweepCount count;
  EXPECT_FALSE(count.moves());
  judge(count, 1, 0.0, 1.1 * tolerance::moving_power);
  EXPECT_TRUE(count.moves());
  judge(count, 1, 0.0, 0.9 * tolerance::moving_power);
  EXPECT_FALSE(count.moves());
}

TEST(SweepCount, SubstepsShareTheSweepsOfAStep) {
  SweepCount of_balls, of_boxes;
  judge(of_balls, 6, 1.0);
  of_boxes.sweeps(boxes, true, 1.0);
  judge(of_boxes, 6, 1.0);
  for (const int substeps : {1, 2, 4, 8}) {
    EXPECT_EQ(substeps * of_balls.sweeps(balls, false, 1.0 / substeps), 96) << substeps;
    EXPECT_EQ(substeps * of_boxes.sweeps(boxes, true, 1.0 / substeps), 96) << substeps;
  }
  EXPECT_EQ(of_balls.sweeps(balls, false, 1e-6), 2);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1e-6), 4);
}

}  // namespace
}  // namespace scree::solver
