// Tests of how long the boxes of moving bodies keep their pairs valid, in each space.
#include "sim/pairs/fat_boxes.hpp"

#include "core/tolerances.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/bodies/random_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace scree {
namespace {

template <class Space>
class FatBoxesTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(FatBoxesTest, test::Spaces, test::SpaceName);

TYPED_TEST(FatBoxesTest, BoxesHoldUntilABodyLeavesIts) {
  const BodyTable start = random_bodies();
  Bodies<TypeParam> bodies = in_space<TypeParam>(start);
  Array<double, TypeParam> margin;
  contact_margins(bodies, 0, tolerance::contact_slack, {}, {}, margin);
  FatBoxes<TypeParam> boxes;
  boxes.put_around(bodies, {}, {}, {}, margin);
  EXPECT_FALSE(boxes.follow_paths());
  EXPECT_TRUE(boxes.pairs_last(bodies, {}, {}, {}, margin));
  EXPECT_EQ(boxes.outside(), 0);
  const auto hold_when_moved = [&](std::size_t body, double share) {
    BodyTable moved = start;
    moved.position[body].x() += share * tolerance::pair_skin * moved.size[body].x();
    copy_bodies(bodies, moved);
    boxes.pairs_last(bodies, {}, {}, {}, margin);
    return boxes.outside() == 0;
  };
  const auto is_free = [&](std::size_t k) { return start.mobility[k] == Mobility::free; };
  ASSERT_TRUE(is_free(0) && is_free(999) && start.mobility[1] == Mobility::fixed);
  for (const std::size_t body : {0, 999}) {
    EXPECT_TRUE(hold_when_moved(body, 0.99));
    EXPECT_FALSE(hold_when_moved(body, 1.01));
  }
  EXPECT_TRUE(hold_when_moved(1, 100)) << "fixed bodies have no room, and need none";

  for (const double dt : {0.0, 0.01}) {
    hold_when_moved(999, 2);
    contact_margins(bodies, dt, tolerance::contact_slack, {}, {}, margin);
    Array<double, TypeParam> set;
    boxes.pairs_last(bodies, {.foresight = dt}, {}, {}, set);
    EXPECT_EQ(to_vector(set), to_vector(margin)) << dt << " s";
  }
  contact_margins(bodies, 0, tolerance::contact_slack, {}, {}, margin);

  hold_when_moved(999, 1);
  const std::vector<double> before = to_vector(margin);
  boxes.add_travel(bodies, {}, {}, margin);
  const std::vector<double> after = to_vector(margin);
  for (std::size_t k = 0; k < count; ++k)
    ASSERT_NEAR(after[k] - before[k], k == 999 ? tolerance::pair_skin * start.size[k].x() : 0, 1e-14);
}

/// Boxes around paths hold as long as the bodies follow these, however far they take them, and until one
/// leaves its path by more than its room.
TYPED_TEST(FatBoxesTest, BoxesAroundPathsHoldUntilABodyLeavesItsPath) {
  constexpr double substep = 0.01;
  const SearchTime first{.now = 2, .substep = substep, .foresight = substep};
  BodyTable start = random_bodies();
  for (Vec3& spin : start.spin) spin.setZero();
  Bodies<TypeParam> bodies = in_space<TypeParam>(start);
  ResponseParameters parameters;
  parameters.gravity.setZero();
  FatBoxes<TypeParam> boxes;
  ASSERT_TRUE(boxes.shall_follow_paths(bodies, first, parameters));
  parameters.accurate = true;
  EXPECT_FALSE(boxes.shall_follow_paths(bodies, first, parameters));
  parameters.accurate = false;
  EXPECT_FALSE(boxes.shall_follow_paths(bodies, {.now = 2, .substep = 1e-6, .foresight = 1e-6}, parameters))
      << "in such a substep the bodies hardly move";

  ApproachFinder<TypeParam> finder;
  const ApproachSpeeds none = finder.find(bodies, {});
  Array<double, TypeParam> margin;
  contact_margins(bodies, substep, tolerance::contact_slack, parameters, none, margin);
  boxes.put_around(bodies, first, parameters, none, margin);
  ASSERT_TRUE(boxes.follow_paths());
  const double lasts = boxes.paths().until;
  ASSERT_GT(lasts, 3.9 * substep);
  const auto outside = [&](double passed, std::size_t body, double leaves) {
    BodyTable moved = start;
    for (std::size_t k = 0; k < count; ++k) moved.position[k] += passed * moved.velocity[k];
    moved.position[body] += leaves * moved.velocity[body].unitOrthogonal();
    copy_bodies(bodies, moved);
    Array<double, TypeParam> set;
    boxes.pairs_last(bodies, {.now = 2 + passed, .substep = substep, .foresight = substep}, parameters, none,
                     set);
    return boxes.outside();
  };
  const std::size_t body = 999;
  const double room = to_vector(boxes.margin())[body] - tolerance::contact_slack * start.size[body].x();
  ASSERT_TRUE(start.mobility[body] == Mobility::free);
  ASSERT_GT(2.9 * substep * start.velocity[body].norm(), 3 * room) << "the path is longer than the room";
  for (const double passed : {0.0, 1.0, 2.9}) {
    // Prescribed bodies have no paths, and all of them move out.
    const std::int64_t prescribed = outside(passed * substep, body, 0);
    EXPECT_EQ(outside(passed * substep, body, 0.99 * room), prescribed) << passed;
    EXPECT_EQ(outside(passed * substep, body, 1.01 * room), prescribed + 1) << passed;
  }
  // A body that is still on its path may leave it before the substep ends.
  const Vec3 on_path = start.velocity[body];
  for (const double share : {0.99, 1.01}) {
    const double change = share * room / (tolerance::travel_factor * 0.5 * substep);
    const std::int64_t others = outside(0, body, 0);
    start.velocity[body] = on_path + change * on_path.unitOrthogonal();
    EXPECT_EQ(outside(0, body, 0) - others, share > 1 ? 1 : 0) << share;
    start.velocity[body] = on_path;
  }
  EXPECT_GT(outside(lasts + 2 * substep, body, 0), 500) << "the paths have an end";
}

/// Paths are not longer than a period lets bodies look.
TYPED_TEST(FatBoxesTest, PathsEndWhereBodiesMightMeetThroughTwoImages) {
  const SearchTime time{.now = 0, .substep = 0.01, .foresight = 0.01};
  Bodies<TypeParam> bodies = in_space<TypeParam>(random_bodies());
  bodies.period = period_of(Vec3(-5, -5, -5), Vec3(10, 10, 10));
  double fastest = 0;
  const BodyTable table = random_bodies();
  for (std::size_t k = 0; k < count; ++k) {
    if (table.mobility[k] == Mobility::free) fastest = std::max(fastest, table.velocity[k].norm());
  }
  ApproachFinder<TypeParam> finder;
  Array<double, TypeParam> margin;
  for (const double most : {0.01, 0.15, 0.3, 3.0}) {
    bodies.period.most_margin = most;
    FatBoxes<TypeParam> boxes;
    const bool follow = boxes.shall_follow_paths(bodies, time, {});
    EXPECT_EQ(follow, fastest * time.substep <= 0.25 * most) << most;
    if (!follow) continue;
    const ApproachSpeeds none = finder.find(bodies, {});
    contact_margins(bodies, 0, tolerance::contact_slack, {}, none, margin);
    boxes.put_around(bodies, time, {}, none, margin);
    const std::vector<double> room = to_vector(boxes.margin());
    for (std::size_t k = 0; k < count; ++k) {
      if (table.mobility[k] != Mobility::free) continue;
      ASSERT_LE(room[k] + boxes.paths().until * table.velocity[k].norm(), most * (1 + 1e-12)) << most;
    }
    EXPECT_GE(boxes.paths().until, 0.5 * time.substep) << most;
  }
}

}  // namespace
}  // namespace scree
