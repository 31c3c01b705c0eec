#include "sim/record/guards.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace scree {
namespace {

GuardCount guard_called(const std::string& name, const std::vector<GuardCount>& guards) {
  return *std::ranges::find(guards, name, &GuardCount::name);
}

Observation busy() {
  Observation seen;
  seen.counters.substeps = 100;
  seen.counters.redone = 1;
  seen.left = 2;
  seen.counters.unconverged = 3;
  seen.counters.unfinished_impacts = 4;
  seen.counters.long_direct_failed = 5;
  seen.counters.narrowphase.ccd_stopped = 6;
  seen.counters.residual = 1e-7;
  return seen;
}

TEST(Guards, SayWhichBodiesOverlappedAndHowDeep) {
  const WorstOverlap worst{.relative = 0.012, .time = 0.5, .bodies = {3, 7}};
  const auto guards = guards_of(busy(), {worst, "ball (body 3) and body 7"});
  for (const char* name : {"sweeps", "impacts", "newton"})
    EXPECT_NE(
        guard_called(name, guards)
            .effect.find("the deepest overlap was 1.2 % of the smaller body's radius or half edge, between "
                         "ball (body 3) and body 7, at t = 0.5 s"),
        std::string::npos)
        << name;
  EXPECT_NE(guard_called("sweeps", guards_of(busy(), {})).effect.find("no bodies overlapped"),
            std::string::npos);
}

TEST(Guards, MatterWhereTheRunShowsIt) {
  const auto mattering = [](const GuardedRun& run) {
    std::string names;
    for (const GuardCount& guard : guards_of(busy(), run))
      if (guard.matters) names += std::string(guard.name) + ' ';
    return names;
  };
  const WorstOverlap slight{1e-3, 0, {0, 1}}, deep{0.5, 0, {0, 1}};
  EXPECT_EQ(mattering({slight, ""}), "left ");
  EXPECT_EQ(mattering({deep, ""}), "left sweeps impacts newton ");
  EXPECT_EQ(mattering({slight, "", false, 0.1}), "left ");
  EXPECT_EQ(mattering({slight, "", false, 0.9}), "left impacts ")
      << "bounces are lost in four of 100 substeps";
  // Who asks for a tolerance is told that it was missed, and by how much.
  EXPECT_EQ(mattering({slight, "", true}), "left sweeps newton ");
  EXPECT_NE(guard_called("newton", guards_of(busy(), {.worst = {}, .bodies = {}, .accurate = true}))
                .effect.find("a residual of 1e-07 was left"),
            std::string::npos);
}

TEST(Guards, AreToldWithTheirCountsAndTheSettingThatHelps) {
  const auto guards = guards_of(busy(), {});
  EXPECT_EQ(line_of(guard_called("left", guards)),
            "bodies that left the world and were taken out: 2; later measurements do not include them. To "
            "have fewer: "
            "a larger box in world.from and world.to.");
  EXPECT_EQ(line_of(guard_called("impacts", guards)),
            "substeps whose chains of impacts reached the limit: 4; that is 4 of 100 substeps; their "
            "remaining impacts "
            "did not bounce; no bodies overlapped in the states that were measured. To have fewer: a smaller "
            "time.step.");
}

TEST(Guards, ALargeOverlapIsToldOnce) {
  const auto warning = [](const Observation& seen, double relative, double time) {
    const GuardedRun run{{relative, time, {0, 1}}, "a (body 0) and body 1"};
    return overlap_warning(guards_of(seen, run), run);
  };
  const std::string deep =
      "the deepest overlap was 210 % of the smaller body's radius or half edge, between a (body 0) and body "
      "1, at t = ";
  EXPECT_EQ(warning({}, 2.1, 0),
            deep + "0 s: the scene places these bodies into each other; move them apart in the scene");
  EXPECT_EQ(warning({}, 2.1, 0.25), deep + "0.25 s; try a smaller time.step");
  EXPECT_EQ(warning({}, 0.04, 0), "");
  EXPECT_EQ(warning({}, 0, 0), "");
  EXPECT_EQ(warning(busy(), 2.1, 0), "") << "the guards of the sweeps say so";
  Observation left;
  left.left = 1;
  EXPECT_NE(warning(left, 2.1, 0), "") << "this guard matters, and says nothing of overlaps";
}

TEST(Guards, SharesArePercentagesWithoutExponents) {
  EXPECT_EQ(percent_words(0.0123456), "1.23 %");
  EXPECT_EQ(percent_words(2.1), "210 %");
  EXPECT_EQ(percent_words(123.456), "12346 %");
}

TEST(Guards, KeepTheWorstOfWhatIsMeasured) {
  WorstOverlap worst;
  Observation seen;
  const auto see = [&](double time, double relative, std::int32_t body) {
    seen.time = time;
    seen.penetration.relative_max = relative;
    seen.penetration.deepest = {body, body + 1};
    worst.include(seen);
  };
  see(0, std::numeric_limits<double>::quiet_NaN(), 9);
  EXPECT_EQ(worst.relative, 0);
  see(1, 0.1, 1);
  see(2, 0.3, 2);
  see(3, 0.2, 3);
  EXPECT_EQ(worst.relative, 0.3);
  EXPECT_EQ(worst.time, 2);
  EXPECT_EQ(worst.bodies[0], 2);
}

}  // namespace
}  // namespace scree
