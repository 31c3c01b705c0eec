// Tests of impacts in rounds, against impacts in the order of their times: they are the same for every body,
// to rounding.
#include "tests/core/spaces.hpp"
#include "tests/sim/impacts/impact_outcomes.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace scree {
namespace {

template <class Space>
class Rounds : public test::InSpace<Space> {};
TYPED_TEST_SUITE(Rounds, test::Spaces, test::SpaceName);

TYPED_TEST(Rounds, TwoBallsMeetOnce) {
  FlightScene scene;
  scene.law.restitution = 0.5;
  scene.add_ball(0.1, Vec3(0, 0, 0), Vec3(1, 0, 0));
  scene.add_ball(0.1, Vec3(0.201, 0, 0), Vec3(-1, 0, 0));
  const Outcome rounds = in_rounds<TypeParam>(scene, {{0, 1}});
  expect_same(rounds, in_time_order(scene, {{0, 1}}), 1e-15);
  EXPECT_EQ(rounds.rounds, 1);
  EXPECT_NEAR(rounds.bodies.velocity[0].x(), -0.5, 1e-15);
  EXPECT_NEAR(rounds.moved.restitution, 0.75, 1e-15);
  EXPECT_TRUE(rounds.late);  // 0.5 ms after the midpoint
}

TYPED_TEST(Rounds, ManyAtOnceAreMoreThanThereIsRoomForAtFirst) {
  constexpr std::int32_t lanes = 6000;
  FlightScene scene;
  std::vector<Pair> pairs;
  for (std::int32_t k = 0; k < lanes; ++k) {
    scene.add_ball(0.1, Vec3(0, k, 0), Vec3(1, 0, 0));
    scene.add_ball(0.1, Vec3(0.201, k, 0), Vec3(-1, 0, 0));
    pairs.push_back({2 * k, 2 * k + 1});
  }
  const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
  EXPECT_EQ(rounds.rounds, 1);
  ASSERT_EQ(rounds.impacts.size(), static_cast<std::size_t>(lanes));
  for (std::size_t k = 0; k < lanes; ++k) {
    // The impacts are in the order of the pairs.
    ASSERT_EQ(rounds.impacts[k].i, 2 * (lanes - 1 - static_cast<std::int32_t>(k)));
    ASSERT_NEAR(rounds.bodies.velocity[2 * k].x(), -1, 1e-15);
    ASSERT_NEAR(rounds.bodies.velocity[2 * k + 1].x(), 1, 1e-15);
  }
}

TYPED_TEST(Rounds, ACradlePassesOnOneBall) {
  constexpr int balls = 20;
  FlightScene scene;
  for (int k = 0; k < balls; ++k)
    scene.add_ball(0.1, Vec3(0.2 * k - (k == 0 ? 1e-3 : 0), 0, 0), Vec3(k == 0 ? 1.0 : 0.0, 0, 0));
  const std::vector<Pair> pairs = scene.pairs(0.01);
  const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
  expect_same(rounds, in_time_order(scene, pairs), 1e-15);
  EXPECT_EQ(rounds.rounds, balls - 1);
  for (int k = 0; k < balls; ++k)
    EXPECT_NEAR(rounds.bodies.velocity[static_cast<std::size_t>(k)].x(), k == balls - 1 ? 1.0 : 0.0, 1e-14);
}

/// A large ball at rest, in pairs with ball 1, which strikes it, and with thousands of others. One of these,
/// `struck`, is in the way that the large ball takes then.
struct LargeBall {
  FlightScene scene;
  std::vector<Pair> pairs;

  static constexpr std::int32_t others = 5000;

  LargeBall(double mass, double speed, std::int32_t struck) {
    scene.add_ball(1.0, Vec3(0, 0, 0), Vec3(0, 0, 0));
    scene.weigh(0, mass);
    scene.add_ball(0.1, Vec3(-1.101, 0, 0), Vec3(speed, 0, 0));
    pairs.push_back({0, 1});
    for (std::int32_t k = 2; k < others + 2; ++k) {
      scene.add_ball(0.1, Vec3(k == struck ? 1.1005 : 1.2, 0, k == struck ? 0.0 : k), Vec3(0, 0, 0));
      pairs.push_back({0, k});
    }
  }
};

TYPED_TEST(Rounds, AStruckBodyWithThousandsOfPairsLooksAtAllOfThem) {
  for (const std::int32_t struck : {2, 700, LargeBall::others + 1}) {
    const LargeBall large(1, 2, struck);
    const Outcome order = in_time_order(large.scene, large.pairs);
    const Outcome rounds = in_rounds<TypeParam>(large.scene, large.pairs);
    expect_same(rounds, order, 1e-15);
    ASSERT_EQ(rounds.impacts.size(), 2u);
    EXPECT_NEAR(rounds.bodies.velocity[static_cast<std::size_t>(struck)].x(), 2, 1e-14);
    expect_same(in_rounds<TypeParam>(large.scene, large.pairs, true), order, 1e-15);
  }
}

/// The large ball is so heavy that it is struck in an impact group.
TYPED_TEST(Rounds, AStruckHeavyBodyWithThousandsOfPairsLooksAtAllOfThem) {
  constexpr double mass = 1000, speed = 800;
  constexpr std::int32_t struck = 700;
  const LargeBall large(mass, speed, struck);
  const Outcome rounds = in_rounds<TypeParam>(large.scene, large.pairs);
  ASSERT_EQ(rounds.impacts.size(), 2u);
  // The speed that the large ball is given, and what an elastic impact of it gives to a ball at rest.
  const double given = 2 * speed / (1 + mass);
  EXPECT_NEAR(rounds.bodies.velocity[struck].x(), 2 * mass / (1 + mass) * given, 1e-12);
}

TYPED_TEST(Rounds, OfAGasAreTheSame) {
  FlightScene scene = gas(0.05);
  scene.parameters.rotation = false;
  const double energy = scene.kinetic_energy();
  std::size_t impacts = 0;
  std::int64_t rounds = 0;
  for (int substep = 0; substep < 100; ++substep) {
    scene.fly(0.5 * scene.step);
    const std::vector<Pair> pairs = scene.pairs(0.05);
    const Outcome outcome = in_rounds<TypeParam>(scene, pairs);
    ASSERT_NO_FATAL_FAILURE(expect_same(outcome, in_time_order(scene, pairs), 1e-12)) << substep;
    impacts += outcome.impacts.size();
    rounds += outcome.rounds;
    scene.bodies = outcome.bodies;
    scene.fly(0.5 * scene.step);
  }
  EXPECT_NEAR(scene.kinetic_energy(), energy, 1e-12 * energy);
  EXPECT_GT(impacts, 1000u);
  EXPECT_LT(rounds, 400);
}

/// Returns the number of balls whose impacts come in another order than that of their times.
std::size_t count_differences(const Outcome& rounds, const Outcome& order) {
  const auto pair_of = [](const Impact& impact) { return std::pair(impact.i, impact.j); };
  const auto got = by_body(rounds);
  const auto expected = by_body(order);
  std::size_t differ = 0;
  for (std::size_t k = 0; k < got.size(); ++k)
    differ += std::ranges::equal(got[k], expected[k], {}, pair_of, pair_of) ? 0 : 1;
  return differ;
}

TYPED_TEST(Rounds, OfADenseGasHardlyDiffer) {
  FlightScene scene = gas(0.4);
  scene.parameters.rotation = false;
  const double energy = scene.kinetic_energy();
  std::size_t differ = 0;
  std::size_t impacts = 0;
  for (int substep = 0; substep < 60; ++substep) {
    scene.fly(0.5 * scene.step);
    const std::vector<Pair> pairs = scene.pairs(0.05);
    const Outcome outcome = in_rounds<TypeParam>(scene, pairs);
    differ += count_differences(outcome, in_time_order(scene, pairs));
    impacts += outcome.impacts.size();
    scene.bodies = outcome.bodies;
    scene.fly(0.5 * scene.step);
  }
  EXPECT_NEAR(scene.kinetic_energy(), energy, 1e-12 * energy);
  EXPECT_GT(impacts, 20000u);
  EXPECT_LE(differ, 10u);  // (of 60,000)
}

TYPED_TEST(Rounds, OfADenseGasAreThoseOfTheQueueOneByOne) {
  FlightScene scene = gas(0.4);
  scene.parameters.rotation = false;
  for (int substep = 0; substep < 5; ++substep) {
    scene.fly(0.5 * scene.step);
    const std::vector<Pair> pairs = scene.pairs(0.05);
    const Outcome outcome = in_rounds<TypeParam>(scene, pairs, true);
    ASSERT_NO_FATAL_FAILURE(expect_same(outcome, in_time_order(scene, pairs), 1e-9)) << substep;
    EXPECT_EQ(outcome.rounds, static_cast<std::int64_t>(outcome.impacts.size()));
    scene.bodies = outcome.bodies;
    scene.fly(0.5 * scene.step);
  }
}

TYPED_TEST(Rounds, BallsOnAPlaneDoNotWaitForEachOther) {
  FlightScene scene;
  scene.law = {.restitution = 0.7, .friction = 0.3};
  scene.parameters.gravity = Vec3(0, 0, -9.81);
  scene.add_plane(Vec3::UnitZ(), 0);
  for (int k = 0; k < 400; ++k) {
    Random random(7, static_cast<std::uint64_t>(k));
    scene.add_ball(0.1, Vec3(k % 20, k / 20, random.uniform(0.098, 0.102)),
                   Vec3(random.uniform(-1, 1), 0, random.uniform(-3, -2)));
    scene.bodies.spin.back() = vector_in(random, 5);
  }
  const std::vector<Pair> pairs = scene.pairs(0.05);
  const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
  expect_same(rounds, in_time_order(scene, pairs), 1e-14);
  EXPECT_EQ(rounds.impacts.size(), 400u);
  EXPECT_EQ(rounds.rounds, 1);
}

TYPED_TEST(Rounds, BoxesDropOnAPlane) {
  FlightScene scene;
  scene.law = {.restitution = 0.6, .friction = 0.4};
  scene.parameters.gravity = Vec3(0, 0, -9.81);
  scene.add_plane(Vec3::UnitZ(), 0);
  for (int k = 0; k < 100; ++k) {
    Random random(9, static_cast<std::uint64_t>(k));
    const Vec3 size(random.uniform(0.05, 0.1), random.uniform(0.05, 0.1), random.uniform(0.05, 0.1));
    scene.add(Shape::box, size, Vec3(k % 10, k / 10, 0.9 * size.norm()), Vec3(0, 0, -4));
    scene.bodies.orientation.back() = rotation_of(vector_in(random, 3));
    scene.bodies.spin.back() = vector_in(random, 20);
  }
  scene.step = 1.0 / 60;
  const std::vector<Pair> pairs = scene.pairs(0.2);
  const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
  expect_same(rounds, in_time_order(scene, pairs), 1e-10);
  EXPECT_GT(rounds.impacts.size(), 100u);
}

TYPED_TEST(Rounds, BulletsMeetThinPlates) {
  constexpr int lanes = 50;
  FlightScene scene;
  scene.parameters.restitution = false;
  scene.step = 1.0 / 60;
  for (int k = 0; k < lanes; ++k) {
    Random random(13, static_cast<std::uint64_t>(k));
    scene.add_ball(0.01, Vec3(0, k, 0), Vec3(random.uniform(50, 400), 0, 0));
    scene.add(Shape::box, Vec3(0.002, 0.2, 0.2), Vec3(0.2, k + random.uniform(-0.1, 0.1), 0), Vec3::Zero());
  }
  const std::vector<Pair> pairs = scene.pairs(0.1);
  const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
  expect_same(rounds, in_time_order(scene, pairs), 1e-9);
  EXPECT_GE(rounds.impacts.size(), static_cast<std::size_t>(lanes));
}

TYPED_TEST(Rounds, SlowBodiesHaveNone) {
  FlightScene scene = gas(0.05);
  scene.parameters.restitution_threshold = {.any = 4, .lossy = 0};
  const Outcome rounds = in_rounds<TypeParam>(scene, scene.pairs(0.05));
  EXPECT_TRUE(rounds.impacts.empty());
  EXPECT_EQ(rounds.rounds, 0);
  EXPECT_FALSE(rounds.late);
}

/// Of each four balls the first strikes the second, which may then strike two more. In the second round there
/// are more pairs to search than there is room for, while the meetings of the first round must be kept.
TYPED_TEST(Rounds, RoomMayBeLackingInALaterRound) {
  constexpr std::int32_t lanes = 3000;
  FlightScene scene;
  std::vector<Pair> pairs;
  for (std::int32_t k = 0; k < lanes; ++k) {
    const Vec3 lane(0, k, 0);
    scene.add_ball(0.1, lane, Vec3(3, 0, 0));
    scene.add_ball(0.1, lane + Vec3(0.2005, 0, 0), Vec3(0, 0, 0));
    scene.add_ball(0.1, lane + Vec3(0.3746, 0.1001, 0), Vec3(0, 0, 0));
    scene.add_ball(0.1, lane + Vec3(0.3752, -0.1002, 0), Vec3(0, 0, 0));
    for (std::int32_t i = 0; i < 4; ++i)
      for (std::int32_t j = i + 1; j < 4; ++j) pairs.push_back({4 * k + i, 4 * k + j});
  }
  const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
  EXPECT_GT(rounds.rounds, 2);
  ASSERT_GE(rounds.impacts.size(), static_cast<std::size_t>(3 * lanes));
  expect_same(rounds, in_time_order(scene, pairs), 1e-11);
}

/// The first of four bodies with many pairs drives the second into the third before the third meets the
/// fourth, so that the third waits. Each is a candidate with very many other bodies, none of which it meets.
TYPED_TEST(Rounds, BodiesWithManyPairsWaitForOneAnother) {
  constexpr std::int32_t many = 4, others = 300;
  static_assert(others > AdjacencyView::most_of_few);
  FlightScene scene;
  const double at[many] = {0, 0.2002, 0.4004, 0.6009};
  const double speed[many] = {3, 0, 0, -1};
  for (int k = 0; k < many; ++k) scene.add_ball(0.1, Vec3(at[k], 0, 0), Vec3(speed[k], 0, 0));
  for (std::int32_t k = 0; k < others; ++k) scene.add_ball(0.1, Vec3(k, 5, 0), Vec3(0, 0.1, 0));
  std::vector<Pair> pairs = {{0, 1}, {1, 2}, {2, 3}};
  for (std::int32_t body = 0; body < many; ++body)
    for (std::int32_t other = many; other < many + others; ++other) pairs.push_back({body, other});
  const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
  EXPECT_GE(rounds.impacts.size(), 3u);
  expect_same(rounds, in_time_order(scene, pairs), 1e-12);
}

/// All three balls touch at the start, and each closes with the next one; the last one is heavy to the first.
TYPED_TEST(Rounds, NobodyWaitsInACircle) {
  FlightScene scene;
  const double apart = 0.2 - 1e-6;
  const Vec3 at[] = {Vec3(0, 0, 0), Vec3(apart, 0, 0), Vec3(0.5, std::sqrt(0.75), 0) * apart};
  const Vec3 velocity[] = {Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0)};
  const double mass[] = {1, 12, 144};
  for (std::int32_t k = 0; k < 3; ++k) {
    scene.add_ball(0.1, at[k] + 0.5 * scene.step * velocity[k], velocity[k]);
    scene.weigh(k, mass[k]);
  }
  std::vector<Pair> pairs = {{0, 1}, {0, 2}, {1, 2}};
  std::vector<int> order = {0, 1, 2};
  do {
    std::vector<Pair> ordered;
    for (const int k : order) ordered.push_back(pairs[static_cast<std::size_t>(k)]);
    const Outcome rounds = in_rounds<TypeParam>(scene, ordered);
    EXPECT_LE(rounds.rounds, 8);
    EXPECT_GE(rounds.impacts.size(), 2u);
  } while (std::next_permutation(order.begin(), order.end()));
}

TYPED_TEST(Rounds, WhatWasLoadedDoesNotBounce) {
  FlightScene scene;
  for (int k = 0; k < 2; ++k) {
    scene.add_ball(0.1, Vec3(0, k, 0), Vec3(1, 0, 0));
    scene.add(Shape::sphere, Vec3::Constant(0.1), Vec3(0.201, k, 0), Vec3(-1, 0, 0), false);
  }
  World<TypeParam> world(scene);
  Array<Pair, TypeParam> pairs;
  Array<LoadedParts, TypeParam> loaded;
  copy(pairs, std::vector<Pair>{{0, 1}, {2, 3}});
  copy(loaded, std::vector<LoadedParts>{{.bits = 1}, {.bits = 2}});
  ImpactRounds<TypeParam> rounds;
  rounds.resolve({std::as_const(pairs).view(), std::as_const(loaded).view(), world.terms(0)},
                 scene.parameters, view_of(world.bodies));
  const std::vector<Impact> impacts = impacts_of(rounds);
  ASSERT_EQ(impacts.size(), 1u);
  EXPECT_EQ(impacts[0].i, 2);
}

/// Balls 0 and 1 rest on balls 4 and 5, ball 2 rests on the fixed ball 6, and ball 3 on none. All pairs
/// within the row of 0 to 3 meet.
TYPED_TEST(Rounds, TwoThatBearLoadInACrowdAreLeftToItsContacts) {
  FlightScene scene;
  scene.law.restitution = 0.5;
  for (int k = 0; k < 4; ++k) scene.add_ball(0.1, Vec3(0.201 * k, 0, 0), Vec3(k % 2 == 0 ? 1 : -1, 0, 0));
  for (const int k : {0, 1}) scene.add_ball(0.1, Vec3(0.201 * k, 0, -0.2), Vec3::Zero());
  scene.add(Shape::sphere, Vec3::Constant(0.1), Vec3(0.402, 0, -0.2), Vec3::Zero(), false);
  World<TypeParam> world(scene);
  Array<Pair, TypeParam> pairs;
  Array<LoadedParts, TypeParam> loaded;
  copy(pairs, std::vector<Pair>{{0, 1}, {0, 4}, {1, 5}, {2, 3}, {2, 6}});
  copy(loaded, std::vector<LoadedParts>{{}, {.bits = 1}, {.bits = 1}, {}, {.bits = 1}});
  for (const bool one_by_one : {false, true}) {
    ImpactRounds<TypeParam> rounds;
    rounds.resolve({.pairs = std::as_const(pairs).view(),
                    .loaded = std::as_const(loaded).view(),
                    .terms = world.terms(0),
                    .one_by_one = one_by_one},
                   scene.parameters, view_of(world.bodies));
    const std::vector<Impact> impacts = impacts_of(rounds);
    const FlightStage stage = rounds.stage(world.terms(0), scene.parameters, view_of(world.bodies));
    ASSERT_EQ(impacts.size(), one_by_one ? 2u : 1u) << "in the accurate mode all are impacts";
    EXPECT_TRUE(std::ranges::any_of(impacts, [](const Impact& impact) { return impact.i == 2; }));
    if constexpr (std::is_same_v<TypeParam, Host>) {
      EXPECT_EQ(stage.both_bore_load(0, 1), !one_by_one);
      EXPECT_FALSE(stage.both_bore_load(2, 3));
    }
    rounds.undo(view_of(world.bodies));
  }
}

TYPED_TEST(Rounds, UndoneAreAsIfTheyHadNotBeen) {
  FlightScene scene = gas(0.2);
  scene.step = 1.0 / 20;
  World<TypeParam> world(scene);
  Array<Pair, TypeParam> pairs;
  copy(pairs, scene.pairs(0.1));
  ImpactRounds<TypeParam> rounds;
  const auto resolve = [&] {
    rounds.resolve({std::as_const(pairs).view(), {}, world.terms(0)}, scene.parameters,
                   view_of(world.bodies));
    BodyTable after;
    copy_bodies(after, world.bodies);
    return hash_of(after);
  };
  const std::uint64_t first = resolve();
  EXPECT_GT(rounds.struck().size(), 100);
  rounds.undo(view_of(world.bodies));
  BodyTable undone;
  copy_bodies(undone, world.bodies);
  EXPECT_EQ(hash_of(undone), hash_of(scene.bodies));
  EXPECT_TRUE(rounds.impacts().size() == 0 && !rounds.any_late_impact());
  EXPECT_EQ(resolve(), first);
}

TYPED_TEST(Rounds, TheSecondHalfGoesOnFromTheFirst) {
  FlightScene scene = gas(0.02);
  scene.step = 1.0 / 60;  // some approaches are deep
  for (Vec3& velocity : scene.bodies.velocity) velocity *= 2;
  const std::vector<Pair> pairs = scene.pairs(0.3);
  World<TypeParam> world(scene);
  World<Host> host(scene);
  Array<Pair, TypeParam> candidates;
  copy(candidates, pairs);
  ImpactRounds<TypeParam> rounds;
  test::EventQueue queue;
  Outcome outcome, order;
  for (const double from : {0.0, 0.5 * scene.step}) {
    outcome.moved = rounds.resolve({std::as_const(candidates).view(), {}, world.terms(from)},
                                   scene.parameters, view_of(world.bodies));
    order.moved = queue.resolve({pairs.data(), static_cast<std::int64_t>(pairs.size())}, host.terms(from),
                                scene.parameters, view_of(host.bodies));
    outcome.impacts = impacts_of(rounds);
    order.impacts = queue.impacts();
    copy_bodies(outcome.bodies, world.bodies);
    copy_bodies(order.bodies, host.bodies);
    ASSERT_NO_FATAL_FAILURE(expect_same(outcome, order, 1e-11)) << "from " << from;
    ASSERT_GT(outcome.impacts.size(), 10u);
    // The response might change the velocities in this way.
    if (from > 0) continue;
    BodyTable turned = order.bodies;
    for (Vec3& velocity : turned.velocity) velocity = Vec3(velocity.y(), velocity.z(), velocity.x());
    copy_bodies(host.bodies, turned);
    copy_bodies(world.bodies, turned);
  }
}

TYPED_TEST(Rounds, DoNotDependOnTheThreads) {
  FlightScene scene = gas(0.3);
  for (std::int32_t k = 0; k < 1000; k += 10) scene.weigh(k, 500);
  const std::vector<Pair> pairs = scene.pairs(0.05);
  std::vector<Outcome> outcomes;
  for (const int threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    outcomes.push_back(arena.execute([&] { return in_rounds<TypeParam>(scene, pairs); }));
  }
  EXPECT_EQ(hash_of(outcomes[0].bodies), hash_of(outcomes[1].bodies));
  EXPECT_EQ(outcomes[0].moved.restitution, outcomes[1].moved.restitution);
  ASSERT_EQ(outcomes[0].impacts.size(), outcomes[1].impacts.size());
  for (std::size_t k = 0; k < outcomes[0].impacts.size(); ++k)
    ASSERT_EQ(outcomes[0].impacts[k].impulse, outcomes[1].impacts[k].impulse);
}

}  // namespace
}  // namespace scree
