#include "sim/model/substep_count.hpp"

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

/// Without the limit on the wait, one contact among millions that stays this deep would hold the whole run at
/// the finest steps.
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

constexpr double between = 0.5 * (tolerance::heap_substep_overlap + tolerance::coarser_overlap);

/// Returns the number of substeps after `steps` steps of a heap that leaves, with n substeps, `left(n)` times
/// the overlaps that it may leave at quality 1.
template <class Left>
int next_after(int steps, SubstepCount& count, const Left& left, double quality = 1) {
  for (int k = 0; k < steps; ++k) {
    const double times = left(count.next());
    count.judge_heap(count.next(), between / quality, [times] {
      return OverlapsLeft{times * tolerance::mean_overlap_left, times * tolerance::worst_overlap_left};
    });
  }
  return count.next();
}

TEST(SubstepCount, AHeapFollowsWhatIsLeftAndNotWhatIsCorrected) {
  SubstepCount count;
  ASSERT_GT(between, tolerance::substep_overlap);
  EXPECT_EQ(next_after(1000, count, [](int) { return 0.9; }), 1);
  EXPECT_EQ(next_after(32, count, [](int) { return 1.1; }), 2);
  EXPECT_EQ(next_after(8, count, [](int) { return 2.1; }), 4);
  EXPECT_EQ(next_after(1000, count, [](int) { return 0.9; }), 4) << "half as many would leave too much";
  EXPECT_EQ(next_after(64, count, [](int) { return 0.2; }), 1);
}

/// One of four measurements may be deep, since a single contact may cause it, but not two of them, and none
/// may be far too deep.
TEST(SubstepCount, ASingleDeepOverlapDoesNotDecideForAHeap) {
  const auto after_measurements = [](std::initializer_list<double> worst) {
    SubstepCount count;
    for (const double times : worst)
      for (int k = 0; k < 8; ++k)
        count.judge_heap(count.next(), between, [times] {
          return OverlapsLeft{0, times * tolerance::worst_overlap_left};
        });
    return count.next();
  };
  EXPECT_EQ(after_measurements({0.5, 4.5, 0.5, 0.5, 4.5, 0.5, 0.5, 0.5}), 1);
  EXPECT_EQ(after_measurements({0.5, 4.5, 0.5, 1.1}), 2);
  EXPECT_EQ(after_measurements({1.1, 0.5, 4.5, 0.5}), 2);
  EXPECT_EQ(after_measurements({5.1}), 2);
}

TEST(SubstepCount, AHeapThatSinksDeepIsNotMeasuredFirst) {
  SubstepCount count;
  const auto unseen = []() -> OverlapsLeft { throw "is measured"; };
  count.judge_heap(1, 1.1 * tolerance::heap_substep_overlap, unseen);
  EXPECT_EQ(count.next(), 2);
  for (int k = 0; k < 100; ++k) count.judge_heap(count.next(), 0.9 * tolerance::coarser_overlap, unseen);
  EXPECT_EQ(count.next(), 1) << "and one at rest never";
}

/// Two substeps leave too much overlap, and four so little that two are tried. Over a long time few steps
/// have fewer than four.
TEST(SubstepCount, WhatWasTriedInVainIsTriedLessOften) {
  SubstepCount count;
  const auto left = [](int substeps) { return substeps < 4 ? 1.5 : 0.1; };
  EXPECT_EQ(next_after(72, count, left), 4);
  int coarse = 0;
  for (int k = 0; k < 4000; ++k) coarse += next_after(1, count, left) < 4 ? 1 : 0;
  EXPECT_GT(coarse, 0);
  EXPECT_LT(coarse, 400);
}

TEST(SubstepCount, QualityDividesWhatMayBeLeft) {
  EXPECT_EQ(most_substeps(1), tolerance::most_substeps);
  EXPECT_EQ(most_substeps(4), 2 * tolerance::most_substeps);
  EXPECT_EQ(most_substeps(16), 4 * tolerance::most_substeps);
  EXPECT_EQ(most_substeps(0.25), tolerance::most_substeps / 2);
  EXPECT_EQ(most_substeps(0.01), 1);
  SubstepCount fine(4), coarse(0.25);
  EXPECT_EQ(next_after(
                8, fine, [](int) { return 0.6; }, 4),
            2);
  EXPECT_EQ(next_after(
                1000, coarse, [](int) { return 3.9; }, 0.25),
            1);
  for (SubstepCount* few : {&fine, &coarse}) few->judge(1, 0.5 * tolerance::substep_overlap);
  EXPECT_EQ(fine.next(), 2);
  EXPECT_EQ(coarse.next(), 1);
}

}  // namespace
}  // namespace scree
