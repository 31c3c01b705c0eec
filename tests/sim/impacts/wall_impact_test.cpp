// Tests of a ball's next impact on a tube's wall, against stepping and bisection in long double.
#include "core/rng.hpp"
#include "tests/sim/impacts/flight_oracle.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

RealVec3 place_of(const FlightInTube& ball, double step, Real s) {
  return place_at(ball.flight, ball.velocity, step, s);
}

// for flights over some metres and a second
constexpr double rounding = 1e-13;

FlightInTube draw_flight(Random& random) {
  const auto across = [&random](double length) {
    const double x = random.uniform(-length, length);
    return Vec3(x, random.uniform(-length, length), 0);
  };
  FlightInTube ball;
  ball.reach = random.uniform(0.8, 2);
  ball.velocity = across(4);
  ball.flight.acceleration = across(2);
  ball.flight.position = across(0.5);
  return ball;
}

TEST(WallImpact, IsWhereTheCentreLeavesItsCircle) {
  constexpr double step = 0.1;
  int met = 0;
  for (int n = 0; n < 200; ++n) {
    Random random(21, static_cast<std::uint64_t>(n));
    const FlightInTube ball = draw_flight(random);
    const double earliest = random.uniform(0, step);
    const Real expected =
        first_time(earliest, 1, [&](Real s) { return place_of(ball, step, s).norm() >= ball.reach; });
    const WallImpact impact = next_wall_impact(ball, step, earliest);
    if (expected > 1) continue;
    ++met;
    ASSERT_NEAR(impact.time, static_cast<double>(expected), rounding) << n;
    const RealVec3 at = place_of(ball, step, expected);
    EXPECT_LT((impact.outward.cast<Real>() - at.normalized()).norm(), rounding);
    EXPECT_GT(impact.speed, 0);
  }
  EXPECT_GT(met, 100);
}

TEST(WallImpact, AfterABounceIsAtTheEndOfTheChord) {
  // At 45 degrees the chord is sqrt(2) radii long. Rounding puts the ball a little inside or beyond the wall.
  for (const double beyond : {-1e-16, 0.0, 1e-16}) {
    const Vec3 velocity(-1, 1, 0);
    // The ball is at the wall half a step before the midpoint, which is the beginning of the step.
    const FlightInTube ball{
        .flight = {Vec3(2 + beyond, 0, 0) + 0.5 * velocity, Vec3::Zero()}, .velocity = velocity, .reach = 2};
    const WallImpact impact = next_wall_impact(ball, 1.0, 0.0);
    EXPECT_NEAR(impact.time, 2.0, 1e-15) << beyond;
    EXPECT_LT((impact.outward - Vec3::UnitY()).norm(), 1e-15) << beyond;
  }
}

TEST(WallImpact, ThereIsNoneForABallAtRestOrWiderThanTheTube) {
  const FlightInTube resting{.flight = {Vec3(1, 0, 0), Vec3::Zero()}, .velocity = Vec3::Zero(), .reach = 2};
  EXPECT_EQ(next_wall_impact(resting, 0.1, 0).time, HUGE_VAL);
  const FlightInTube wide{.flight = {Vec3::Zero(), Vec3::Zero()}, .velocity = Vec3::Ones(), .reach = -1};
  EXPECT_EQ(next_wall_impact(wide, 0.1, 0).time, HUGE_VAL);
}

}  // namespace
}  // namespace scree
