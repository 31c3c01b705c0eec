// Tests of how long the boxes of moving bodies keep their pairs valid, in each space.
#include "sim/pairs/fat_boxes.hpp"

#include "core/tolerances.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/bodies/random_bodies.hpp"

#include <gtest/gtest.h>

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
  contact_margins(bodies, 0, tolerance::contact_slack, {}, margin);
  FatBoxes<TypeParam> boxes;
  boxes.put_around(bodies, 0, 0, {}, margin);
  EXPECT_TRUE(boxes.pairs_last(bodies, margin));
  EXPECT_EQ(boxes.outside(), 0);
  const auto hold_when_moved = [&](std::size_t body, double share) {
    BodyTable moved = start;
    moved.position[body].x() += share * tolerance::pair_skin * moved.size[body].x();
    copy_bodies(bodies, moved);
    boxes.pairs_last(bodies, margin);
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
    for (const double share : {0.5, 2.0}) {
      hold_when_moved(999, share);
      contact_margins(bodies, dt, tolerance::contact_slack, {}, margin);
      Array<double, TypeParam> set;
      EXPECT_EQ(boxes.pairs_last(bodies, dt, {}, set), boxes.pairs_last(bodies, margin))
          << dt << " s, " << share;
      EXPECT_EQ(to_vector(set), to_vector(margin));
    }
  }
  contact_margins(bodies, 0, tolerance::contact_slack, {}, margin);

  hold_when_moved(999, 1);
  const std::vector<double> before = to_vector(margin);
  boxes.add_travel(bodies, margin);
  const std::vector<double> after = to_vector(margin);
  for (std::size_t k = 0; k < count; ++k)
    ASSERT_NEAR(after[k] - before[k], k == 999 ? tolerance::pair_skin * start.size[k].x() : 0, 1e-14);
}

}  // namespace
}  // namespace scree
