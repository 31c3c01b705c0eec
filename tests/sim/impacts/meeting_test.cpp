// Tests of the instants at which bodies in flight meet, against sampling: at the time found they touch and
// close, and before it they are apart at every sample. The samples use the narrow phase as the search does,
// but none of its steps.
#include "sim/impacts/meeting.hpp"

#include "core/rng.hpp"
#include "narrowphase/pair_contacts.hpp"
#include "sim/laws/rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr double step = 1.0 / 60;

Vec3 vector_of(Random& random, double length) {
  return {random.uniform(-length, length), random.uniform(-length, length), random.uniform(-length, length)};
}

Quat turn_of(Random& random) {
  return Quat(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
      .normalized();
}

/// Draws a body whose flight leads past the origin within a step or two, at up to `speed` (m/s).
BodyFlight flight_of(Shape shape, Random& random, double speed) {
  BodyFlight f{.shape = shape,
               .size = Vec3(random.uniform(0.02, 0.2), random.uniform(0.02, 0.2), random.uniform(0.02, 0.2)),
               .inverse_inertia = Vec3::Zero(),
               .position = Vec3::Zero(),
               .orientation = turn_of(random),
               .velocity = vector_of(random, speed),
               .spin = vector_of(random, speed),
               .acceleration = Vec3(0, 0, -9.81),
               .midpoint = 0.5 * step};
  if (shape == Shape::sphere) f.size = Vec3::Constant(f.size.x());
  f.inverse_inertia = shape == Shape::sphere ? Vec3(Vec3::Constant(2.5 / (f.size.x() * f.size.x())))
                                             : Vec3(3 / (f.size.y() * f.size.y() + f.size.z() * f.size.z()),
                                                    3 / (f.size.z() * f.size.z() + f.size.x() * f.size.x()),
                                                    3 / (f.size.x() * f.size.x() + f.size.y() * f.size.y()));
  f.position = vector_of(random, 0.3);
  return f;
}

BodyFlight still(Shape shape, const Vec3& size, Random& random) {
  return {.shape = shape,
          .size = size,
          .inverse_inertia = Vec3::Zero(),
          .position = vector_of(random, 0.1),
          .orientation = turn_of(random),
          .velocity = vector_of(random, 1.0),
          .spin = Vec3::Zero(),
          .acceleration = Vec3::Zero(),
          .midpoint = 0.5 * step};
}

double gap_at(const PairFlight& pair, double s) {
  Manifold manifolds[max_pair_manifolds];
  const int count = find_pair_contacts(pair.i.shape, instant_of(pair.i, s).solid, pair.j.shape,
                                       instant_of(pair.j, s).solid, 1e3, manifolds);
  double gap = HUGE_VAL;
  for (int m = 0; m < count; ++m) {
    for (int k = 0; k < manifolds[m].count; ++k) gap = std::min(gap, manifolds[m].points[k].gap);
  }
  return gap;
}

double size_of(const PairFlight& pair) {
  return std::min(smallest_size(pair.i.shape, pair.i.size), smallest_size(pair.j.shape, pair.j.size));
}

class Meetings : public testing::TestWithParam<std::pair<Shape, Shape>> {
 protected:
  PairFlight pair(std::uint64_t item, double speed) const {
    Random random(17, item);
    const auto body = [&](Shape shape) {
      if (shape == Shape::plane) return still(shape, Vec3::Zero(), random);
      if (shape == Shape::tube) return still(shape, Vec3(0.6, 0.6, 0.8), random);
      return flight_of(shape, random, speed);
    };
    PairFlight p{.i = body(GetParam().first), .j = body(GetParam().second), .until = step, .slowest = {}};
    return p;
  }
};

TEST_P(Meetings, AreTheFirst) {
  constexpr int samples = 1000;
  int met = 0;
  for (std::uint64_t item = 0; item < 300; ++item) {
    const double speed = item % 3 == 0 ? 2.0 : item % 3 == 1 ? 20.0 : 100.0;
    const PairFlight p = pair(item, speed);
    const double size = size_of(p);
    if (gap_at(p, 0) < 0.01 * size) continue;
    const Meeting meeting = next_meeting(p, 0);
    if (meeting.time <= step) {
      ++met;
      ASSERT_NEAR(gap_at(p, meeting.time), 0, 1e-9 * size) << item;
    }
    // A graze may be shorter than a step of the search near the surface, and is then as shallow as this
    // bound.
    const double end = std::min(meeting.time, step);
    for (int k = 0; k < samples; ++k)
      ASSERT_GT(gap_at(p, end * k / samples), -0.05 * size) << item << " " << k;
  }
  EXPECT_GT(met, 10);
}

/// The look before a search leaves out only pairs that never meet, and no pair with a surface.
TEST_P(Meetings, WhatMeetsMayTouch) {
  int met = 0, left_out = 0;
  for (std::uint64_t item = 0; item < 2000; ++item) {
    const double speed = item % 3 == 0 ? 2.0 : item % 3 == 1 ? 20.0 : 100.0;
    const PairFlight p = pair(item, speed);
    for (const double earliest : {0.0, 0.3 * step, 0.7 * step}) {
      const bool meets = next_meeting(p, earliest).time <= step;
      ASSERT_TRUE(!meets || may_touch(p, earliest)) << item << " from " << earliest;
      met += meets;
      left_out += !may_touch(p, earliest);
    }
  }
  EXPECT_GT(met, 100);
  if (is_surface(GetParam().first) || is_surface(GetParam().second)) {
    EXPECT_EQ(left_out, 0);
  } else {
    EXPECT_GT(left_out, 500);
  }
}

TEST_P(Meetings, NothingPassesThroughAtAnySpeed) {
  // Each body is aimed at the other's centre, so that they must meet, however thin they are beside their
  // travel.
  for (std::uint64_t item = 0; item < 200; ++item) {
    PairFlight p = pair(item, 5.0);
    BodyFlight& flyer = p.i.shape == Shape::plane || p.i.shape == Shape::tube ? p.j : p.i;
    BodyFlight& target = &flyer == &p.i ? p.j : p.i;
    if (target.shape == Shape::tube) continue;  // a tube has one side, and bodies start inside it
    Random random(23, item);
    const Vec3 from =
        target.position + (target.shape == Shape::plane ? Vec3(target.orientation * Vec3(0, 0, 4.0))
                                                        : Vec3(turn_of(random) * Vec3(0, 0, 4.0)));
    target.velocity.setZero();
    target.acceleration.setZero();
    flyer.acceleration.setZero();
    flyer.velocity = (target.position - from) * (random.uniform(1.3, 4.0) / step);
    flyer.position = from + 0.5 * step * flyer.velocity;
    const Meeting meeting = next_meeting(p, 0);
    ASSERT_LE(meeting.time, step) << item;
    ASSERT_NEAR(gap_at(p, meeting.time), 0, 1e-9 * size_of(p)) << item;
  }
}

/// A search ends within the gap that counts as touching, wherever gaps are curved or discontinuous in time.
TEST_P(Meetings, EndWithinWhatTouches) {
  for (std::uint64_t item = 0; item < 1000; ++item) {
    const PairFlight p = pair(item, item % 2 == 0 ? 2.0 : 20.0);
    const double size = size_of(p);
    if (gap_at(p, 0) < 0.01 * size) continue;
    const Meeting meeting = next_meeting(p, 0);
    if (meeting.time > step) continue;
    EXPECT_NEAR(gap_at(p, meeting.time), 0, 2 * tolerance::touching_gap * size) << item;
  }
}

TEST_P(Meetings, SlowOnesDoNotCount) {
  for (std::uint64_t item = 0; item < 100; ++item) {
    PairFlight p = pair(item, 2.0);
    std::fill_n(p.slowest, PairFlight::parts, 1e4);
    EXPECT_EQ(next_meeting(p, 0).time, HUGE_VAL) << item;
  }
}

constexpr std::pair<Shape, Shape> kinds[] = {{Shape::sphere, Shape::sphere}, {Shape::sphere, Shape::box},
                                             {Shape::box, Shape::box},       {Shape::sphere, Shape::plane},
                                             {Shape::box, Shape::plane},     {Shape::sphere, Shape::tube},
                                             {Shape::box, Shape::tube},      {Shape::box, Shape::sphere},
                                             {Shape::plane, Shape::box},     {Shape::tube, Shape::sphere}};
INSTANTIATE_TEST_SUITE_P(Shapes, Meetings, testing::ValuesIn(kinds));

/// A rod that turns fast about its middle strikes a ball that it misses at both ends of the step.
TEST(Meetings, TurningCounts) {
  const Vec3 rod_size(0.5, 0.01, 0.01);
  PairFlight p{.i = {.shape = Shape::box,
                     .size = rod_size,
                     .inverse_inertia = Vec3(1.5e4, 12, 12),
                     .position = Vec3::Zero(),
                     .orientation = Quat::Identity(),
                     .velocity = Vec3::Zero(),
                     .spin = Vec3(0, 0, 2 * pi / step),
                     .acceleration = Vec3::Zero(),
                     .midpoint = 0.5 * step},
               .j = {.shape = Shape::sphere,
                     .size = Vec3::Constant(0.01),
                     .inverse_inertia = Vec3::Constant(1e4),
                     .position = Vec3(0, 0.4, 0),
                     .orientation = Quat::Identity(),
                     .velocity = Vec3::Zero(),
                     .spin = Vec3::Zero(),
                     .acceleration = Vec3::Zero(),
                     .midpoint = 0.5 * step},
               .until = step,
               .slowest = {}};
  ASSERT_GT(gap_at(p, 0), 0.3);
  ASSERT_GT(gap_at(p, step), 0.3);
  const Meeting meeting = next_meeting(p, 0);
  // The rod goes a quarter turn, less the angle at which its side is the ball's radius and half its own
  // thickness away: at the start the rod has half a turn to go to where it is at the midpoint.
  const double angle = pi / 2 - std::asin(0.02 / 0.4);
  EXPECT_NEAR(meeting.time, angle / (2 * pi / step), 1e-9 * step);
}

}  // namespace
}  // namespace scree
