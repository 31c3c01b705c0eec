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
    room = life.choose(now, substep, rate, 0) / substep;
    now += lasted * substep;
  }
  return room;
}

TEST(BoxLife, LastsTheLongerTheSlowerTheBodiesAre) {
  double last = 1e9;
  for (const double travel : {1e-5, 1e-2, 0.1, 0.3, 3.0}) {
    BoxLife life;
    const double room = life.choose(0, substep, travel / substep, 0) / substep;
    EXPECT_LE(room, last) << travel;
    EXPECT_GE(room, 1) << "a substep has room, however fast the bodies are";
    last = room;
  }
  EXPECT_LT(last, 2);
  BoxLife of_resting_bodies;
  EXPECT_GT(of_resting_bodies.choose(0, substep, 0, 0) / substep, 16);
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
  const double undisturbed = life.choose(0, substep, rate, 0);
  life.make_room();
  const double room = life.choose(substep, substep, rate, 0);
  EXPECT_GT(room, 1.1 * undisturbed);
  double now = 2 * substep;
  EXPECT_LT(substeps_after(life, 200, 1, rate, now) * substep, undisturbed)
      << "nothing was sent out for long";
  for (int k = 0; k < 100; ++k) life.make_room();
  EXPECT_LT(life.choose(now, substep, rate, 0) / substep, 4) << "room is bounded";
}

/// Boxes that are made anew at once, because impacts have sent bodies out, have not failed to last.
TEST(BoxLife, BoxesThatAreMadeAnewAtOnceAreNotJudged) {
  constexpr double rate = 0.01 / substep;
  BoxLife life;
  life.choose(0, substep, rate, 0);
  const int hoped_for = life.planned();
  ASSERT_GT(hoped_for, 6);
  life.choose(0, substep, rate, 0);
  EXPECT_EQ(life.planned(), hoped_for);
  life.choose(substep, substep, rate, 0);
  EXPECT_EQ(life.planned(), 1);
}

/// The boxes of bodies that fall together last longer than those of bodies that scatter as fast, but a path
/// does not grow without bounds.
TEST(BoxLife, LastsTheLongerTheBetterBodiesFollowTheirPaths) {
  const auto planned = [](double leaving, double along) {
    BoxLife life;
    life.choose(0, substep, leaving / substep, along / substep);
    return life.planned();
  };
  EXPECT_GT(planned(0.01, 0.4), 2 * planned(0.4, 0));
  EXPECT_LE(planned(0.01, 0.4), planned(0.01, 0));
  EXPECT_LE(planned(0.01, 4), planned(0.01, 0.4));
  EXPECT_GE(planned(0.3, 100), 1);
}

}  // namespace
}  // namespace scree
