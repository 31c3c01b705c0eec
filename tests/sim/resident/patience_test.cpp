#include "sim/resident/patience.hpp"

#include "core/tolerances.hpp"

#include <gtest/gtest.h>

namespace scree::resident {
namespace {

constexpr int balls = 6, boxes = 12;  // of plan_sweeps()

/// As many substeps as are judged together, `times` times.
void judge(Patience& patience, int times, double undone, double dissipated = 0) {
  for (int k = 0; k < 32 * times; ++k) patience.judge(k % 2 == 0 ? undone : -undone, 1.0, dissipated);
}

TEST(Patience, AHeapIsSweptAsUsualAtFirst) {
  Patience of_balls, of_boxes;
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), balls);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), 2 * boxes);
}

TEST(Patience, WhatIsLeftUndoneAsksForMore) {
  Patience of_balls, of_boxes;
  of_boxes.sweeps(boxes, true, 1.0);
  for (const int expected : {12, 24, 48, 96, 96}) {
    judge(of_balls, 1, 2 * tolerance::undone_power);
    EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), expected);
  }
  for (const int expected : {48, 96, 96}) {
    judge(of_boxes, 1, 2 * tolerance::undone_power);
    EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), expected);
  }
}

TEST(Patience, LittleAsksForFewer) {
  Patience of_balls, of_boxes;
  of_boxes.sweeps(boxes, true, 1.0);
  for (const int expected : {3, 2}) {
    EXPECT_FALSE(of_balls.is_calm());
    judge(of_balls, 1, 0.5 * tolerance::calm_power);
    EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), expected);
  }
  EXPECT_TRUE(of_balls.is_calm());
  judge(of_boxes, 3, 0.5 * tolerance::calm_power);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), 24);
}

TEST(Patience, AHeapThatMovesIsSweptAsUsual) {
  Patience of_balls, of_boxes;
  of_boxes.sweeps(boxes, true, 1.0);
  judge(of_balls, 3, 0.08, 0.9);
  judge(of_boxes, 3, 0.05, 0.6);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), balls);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), boxes);
  // Whatever it was swept before; and a slow mode that dissipates as much is none of that.
  judge(of_balls, 1, 0.4);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), 24) << "much is left undone";
  judge(of_balls, 2, 0.08, 0.9);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), balls);
  judge(of_balls, 1, 0.3, 0.9);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), 12);
}

TEST(Patience, OneSubstepDecidesNothing) {
  Patience patience;
  patience.judge(0.4, 1.0, 0.0);
  EXPECT_EQ(patience.sweeps(balls, false, 1.0), balls);
}

TEST(Patience, AHeapThatHasJustFallenIsSweptAtOnce) {
  Patience of_balls, of_boxes;
  of_balls.judge(0.6, 1.0, 0.2);
  EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), 96);
  of_boxes.judge(-0.6, 1.0, 0.2);
  EXPECT_EQ(of_boxes.sweeps(boxes, true, 1.0), 96);
  // Where all moves, that much is left undone however often it is swept.
  Patience of_flow;
  of_flow.judge(1.0, 1.0, 2.0);
  EXPECT_EQ(of_flow.sweeps(balls, false, 1.0), balls);
  // And as soon as little is left, there are fewer again.
  for (const int expected : {48, 24, 12, 6}) {
    judge(of_balls, 1, 0.01, 0.5);
    EXPECT_EQ(of_balls.sweeps(balls, false, 1.0), expected);
  }
}

TEST(Patience, EightSubstepsTellThatAllFlows) {
  Patience of_flow, of_more;
  for (Patience* patience : {&of_flow, &of_more}) {
    patience->judge(0.6, 1.0, 0.2);
    EXPECT_EQ(patience->sweeps(balls, false, 1.0), 96);
  }
  for (int k = 0; k < 8; ++k) {
    EXPECT_FALSE(of_flow.flows()) << k;
    of_flow.judge(0.05, 1.0, 0.9);
    of_more.judge(0.12, 1.0, 0.9);
  }
  EXPECT_TRUE(of_flow.flows());
  EXPECT_EQ(of_flow.sweeps(balls, false, 1.0), balls);
  EXPECT_EQ(of_more.sweeps(balls, false, 1.0), 96) << "more is left undone than flowing explains";
  judge(of_flow, 1, 0.01, 0.5);
  EXPECT_FALSE(of_flow.flows());
}

/// As many substeps as tell that a heap flows, `times` times.
void flow(Patience& patience, int times, double overlap, double dissipated = 1.0) {
  for (int k = 0; k < 8 * times; ++k) {
    patience.judge(0.02, 1.0, dissipated);
    patience.see_overlap(overlap);
  }
}

TEST(Patience, AHeapThatFlowsIsSweptByItsOverlaps) {
  Patience patience;
  EXPECT_DOUBLE_EQ(patience.change(), tolerance::heap_change);
  const double little = 0.5 * tolerance::little_overlap_in_flow;
  const double much = 1.5 * tolerance::much_overlap_in_flow;
  for (const double expected : {2 * tolerance::heap_change, 4 * tolerance::heap_change,
                                tolerance::heap_change_in_flow, tolerance::heap_change_in_flow}) {
    flow(patience, 1, little);
    EXPECT_DOUBLE_EQ(patience.change(), expected);
  }
  flow(patience, 3, 0.5 * (tolerance::little_overlap_in_flow + tolerance::much_overlap_in_flow));
  EXPECT_DOUBLE_EQ(patience.change(), tolerance::heap_change_in_flow);
  flow(patience, 1, much);
  EXPECT_DOUBLE_EQ(patience.change(), 4 * tolerance::heap_change);
  flow(patience, 1, 2 * much);
  EXPECT_DOUBLE_EQ(patience.change(), tolerance::heap_change);
}

TEST(Patience, AHeapThatLandsLayerByLayerDoesNotFlow) {
  Patience patience;
  flow(patience, 8, 0.0, 0.7);
  EXPECT_FALSE(patience.flows());
  EXPECT_DOUBLE_EQ(patience.change(), tolerance::heap_change);
}

TEST(Patience, SubstepsShareTheSweepsOfAStep) {
  Patience of_balls, of_boxes;
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
}  // namespace scree::resident
