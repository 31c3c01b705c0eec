// Tests of the next meeting of two balls, against stepping and bisection in long double.
#include "core/rng.hpp"
#include "tests/sim/impacts/flight_oracle.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

RealVec3 offset_at(const FlightOfBalls& balls, double step, Real s) {
  return place_at(balls.flight, balls.velocity, step, s);
}

// The flights go over some metres at some 30 m/s. No drawn pair grazes, which would cost half of the digits.
constexpr double rounding = 1e-13;

Vec3 draw(Random& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  return Vec3(x, y, random.uniform(-size, size));
}

TEST(BallImpact, IsTheFirstTouchAndItsNormalAndSpeedAreOfThatInstant) {
  constexpr double step = 0.1;
  int met = 0;
  int passed_by = 0;
  for (std::uint64_t n = 0; n < 500; ++n) {
    Random random(22, n);
    FlightOfBalls balls;
    balls.flight.position = draw(random, 1);
    balls.flight.acceleration = n % 2 == 0 ? Vec3(0, 0, 0) : Vec3(0, 0, -9.81);
    balls.velocity = draw(random, 20);
    balls.touching = random.uniform(0.1, 0.8);
    const double earliest = random.uniform(0, 0.03);
    if (offset_at(balls, step, earliest).norm() < balls.touching) continue;
    const Real expected = first_time(
        earliest, step, [&](Real s) { return offset_at(balls, step, s).norm() <= balls.touching; });
    const BallImpact impact = next_ball_impact(balls, step, earliest);
    if (expected > step) {
      ++passed_by;
      EXPECT_GT(impact.time, step * (1 - rounding)) << n;
      continue;
    }
    ++met;
    ASSERT_NEAR(impact.time, static_cast<double>(expected), rounding * step) << n;
    const Vec3 at = offset_at(balls, step, impact.time).cast<double>();
    EXPECT_LT((impact.normal - at.normalized()).norm(), rounding) << n;
    EXPECT_NEAR(at.norm(), balls.touching, rounding) << n;
    const Vec3 velocity = balls.velocity + impact.time * balls.flight.acceleration;
    EXPECT_NEAR(impact.speed, impact.normal.dot(velocity), rounding) << n;
    EXPECT_LT(impact.speed, 0) << n;
  }
  EXPECT_GT(met, 30);
  EXPECT_GT(passed_by, 100);
}

/// A ball passes another one at their touching distance, less or more a small share of it. A graze is a
/// double root, which costs half of the digits and no more.
TEST(BallImpact, GrazesAreFoundAsWellAsTheirRootsAreKnown) {
  constexpr double step = 0.001;
  constexpr Real speed = 3, touching = 0.02, start = 0.001;
  for (int digit = 1; digit <= 14; ++digit) {
    for (const double side : {-1.0, 1.0}) {
      const double miss = 0.02 * (1 + side * std::pow(10.0, -digit));
      FlightOfBalls balls{
          .flight = {Vec3::Zero(), Vec3::Zero()}, .velocity = Vec3(3, 0, 0), .touching = 0.02};
      balls.flight.position = Vec3(-0.001 + 1.5 * step, miss, 0);
      const BallImpact impact = next_ball_impact(balls, step, 0);
      if (side > 0) {
        EXPECT_EQ(impact.time, HUGE_VAL) << digit;
        continue;
      }
      const Real half_chord = std::sqrt((touching - miss) * (touching + miss));
      if (half_chord > start) {
        EXPECT_EQ(impact.time, 0) << digit;  // they overlap
        continue;
      }
      const auto expected = static_cast<double>((start - half_chord) / speed);
      const double known = 1e-17 * 0.02 / static_cast<double>(half_chord * speed);
      EXPECT_NEAR(impact.time, expected, 64 * known + 1e-15 * step) << digit;
    }
  }
}

TEST(BallImpact, OverlapIsNowIfTheyCloseAndNeverIfTheyPart) {
  FlightOfBalls balls{.flight = {Vec3(0.9, 0, 0), Vec3::Zero()}, .velocity = Vec3(-1, 0, 0), .touching = 1};
  EXPECT_EQ(next_ball_impact(balls, 0.01, 0.004).time, 0.004);
  balls.velocity = Vec3(1, 0, 0);
  EXPECT_EQ(next_ball_impact(balls, 0.01, 0.004).time, HUGE_VAL);
}

TEST(BallImpact, CoincidentCentresGiveAFiniteNormal) {
  const FlightOfBalls balls{
      .flight = {Vec3::Zero(), Vec3::Zero()}, .velocity = Vec3(0, 0, -1), .touching = 1};
  const BallImpact impact = next_ball_impact(balls, 0.01, 0.005);
  EXPECT_TRUE(impact.normal.allFinite());
  EXPECT_EQ(impact.time, 0.005);
}

}  // namespace
}  // namespace scree
