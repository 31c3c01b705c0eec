// Tests of how long the boxes of the broad phase are to last.
#include "sim/pairs/box_life.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr double substep = 0.01;  // s

/// Makes boxes `times` times, each when the last ones have lasted `lasted` substeps, and returns for how many
/// substeps the last ones have room.
double substeps_after(BoxLife& life, int times, double lasted, double rate, double& now) {
  double room = 0;
  for (int k = 0; k < times; ++k) {
    room = life.choose(now, substep, rate) / substep;
    now += lasted * substep;
  }
  return room;
}

TEST(BoxLife, LastsTheLongerTheSlowerTheBodiesAre) {
  double last = 1e9;
  for (const double travel : {1e-5, 1e-2, 0.1, 0.3, 3.0}) {
    BoxLife life;
    const double room = life.choose(0, substep, travel / substep) / substep;
    EXPECT_LE(room, last) << travel;
    EXPECT_GE(room, 1) << "a substep has room, however fast the bodies are";
    last = room;
  }
  EXPECT_LT(last, 2);
  BoxLife of_resting_bodies;
  EXPECT_GT(of_resting_bodies.choose(0, substep, 0) / substep, 16);
}

TEST(BoxLife, BoxesThatFailAreFollowedByOthersThatLastAsLong) {
  constexpr double rate = 0.01 / substep;
  BoxLife life;
  double now = 0;
  const double hoped_for = substeps_after(life, 1, 3, rate, now);
  ASSERT_GT(hoped_for, 6);
  const double after_failure = substeps_after(life, 1, 1, rate, now);
  EXPECT_GE(after_failure, 3);
  EXPECT_LT(after_failure, 4);
  EXPECT_LT(substeps_after(life, 3, 1, rate, now), 2) << "these have failed as well";
  EXPECT_GT(substeps_after(life, 40, 32, rate, now), 0.9 * hoped_for) << "they have not failed for long";
}

TEST(BoxLife, DoesNotJudgeBoxesThatWereForgotten) {
  constexpr double rate = 0.01 / substep;
  BoxLife life, forgetful;
  double now = 0, same = 0;
  const double first = substeps_after(life, 1, 1, rate, now);
  substeps_after(forgetful, 1, 1, rate, same);
  forgetful.forget();
  EXPECT_LT(substeps_after(life, 1, 1, rate, now), 2);
  EXPECT_NEAR(substeps_after(forgetful, 1, 1, rate, same), first, 0.1);
}

TEST(BoxLife, LeavesRoomForImpactsWhereTheyHaveSentBodiesOut) {
  constexpr double rate = 0.3 / substep;
  BoxLife life;
  const double calm = life.choose(0, substep, rate);
  life.make_room();
  const double room = life.choose(substep, substep, rate);
  EXPECT_GT(room, 1.1 * calm);
  double now = 2 * substep;
  EXPECT_LT(substeps_after(life, 200, 1, rate, now) * substep, calm) << "nothing was sent out for long";
  for (int k = 0; k < 100; ++k) life.make_room();
  EXPECT_LT(life.choose(now, substep, rate) / substep, 4) << "room is bounded";
}

}  // namespace
}  // namespace scree
