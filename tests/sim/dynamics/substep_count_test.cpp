#include "sim/dynamics/substep_count.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr double deep = 2 * tolerance::substep_overlap;
constexpr double wedged = 0.5 * (tolerance::substep_overlap + tolerance::coarser_overlap);

SubstepCount finest() {
  SubstepCount count;
  for (int k = 0; k < 5; ++k) count.judge(count.next(), deep);
  return count;
}

TEST(SubstepCount, DeepOverlapsAskForFinerStepsUpToABound) {
  SubstepCount count;
  EXPECT_EQ(count.next(), 1);
  count.judge(count.next(), deep);
  EXPECT_EQ(count.next(), 2);
  EXPECT_EQ(finest().next(), tolerance::most_substeps);
}

TEST(SubstepCount, ShallowOnesAskForCoarserStepsAtOnce) {
  SubstepCount count = finest();
  count.judge(count.next(), 0);
  EXPECT_EQ(count.next(), tolerance::most_substeps / 2);
  for (int k = 0; k < 5; ++k) count.judge(count.next(), 0);
  EXPECT_EQ(count.next(), 1);
}

/// One contact of millions that stays as deep held all at the finest steps.
TEST(SubstepCount, WhatIsWedgedDoesNotHoldFineStepsForGood) {
  SubstepCount count = finest();
  for (int k = 1; k < tolerance::wedged_steps; ++k) count.judge(count.next(), wedged);
  EXPECT_EQ(count.next(), tolerance::most_substeps);
  count.judge(count.next(), wedged);
  EXPECT_EQ(count.next(), tolerance::most_substeps / 2);
  for (int k = 0; k < tolerance::wedged_steps; ++k) count.judge(count.next(), wedged);
  EXPECT_EQ(count.next(), 1);
}

TEST(SubstepCount, ADeepOneStartsTheWaitAnew) {
  SubstepCount count = finest();
  for (int k = 1; k < tolerance::wedged_steps; ++k) count.judge(count.next(), wedged);
  count.judge(count.next(), deep);
  for (int k = 1; k < tolerance::wedged_steps; ++k) count.judge(count.next(), wedged);
  EXPECT_EQ(count.next(), tolerance::most_substeps);
}

}  // namespace
}  // namespace scree
