// Tests of bodies that come and go, in each space, against loops.
#include "sim/bodies/coming_and_going.hpp"

#include "sim/bodies/body_order.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/bodies/random_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace scree {
namespace {

template <class Space>
class ComingAndGoing : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ComingAndGoing, test::Spaces, test::SpaceName);

TYPED_TEST(ComingAndGoing, FreeBodiesBeyondTheWorldAreFoundInOrder) {
  BodyTable table = random_bodies();
  const World world{.from = {-3, -4, -2}, .to = {4, 3, 5}};
  table.position[0] = world.to;  // the world is a closed box
  std::vector<BodyNumber> beyond;
  for (std::size_t k = 0; k < table.position.size(); ++k) {
    bool inside = true;
    for (int a = 0; a < 3; ++a)
      inside = inside && table.position[k][a] >= world.from[a] && table.position[k][a] <= world.to[a];
    if (!inside && table.mobility[k] == Mobility::free)
      beyond.push_back(BodyNumber{static_cast<std::int32_t>(k)});
  }
  ASSERT_GT(beyond.size(), 100u);
  EXPECT_EQ(bodies_beyond<TypeParam>(world, in_space<TypeParam>(table)), beyond);
  const World all{.from = Vec3::Constant(-9), .to = Vec3::Constant(9)};
  EXPECT_TRUE(bodies_beyond<TypeParam>(all, in_space<TypeParam>(table)).empty());
}

TYPED_TEST(ComingAndGoing, ThoseTakenOutAreReturnedAsTheyWere) {
  const BodyTable table = random_bodies();
  Bodies<TypeParam> bodies = in_space<TypeParam>(table);
  const std::vector<BodyNumber> ids = numbers({0, 4, 350, 999});
  const BodyTable gone = take_out<TypeParam>(ids, bodies);
  BodyTable left;
  copy_bodies(left, bodies);
  ASSERT_EQ(gone.count(), 4);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const std::size_t id = index_of(ids[k]);
    EXPECT_EQ(gone.id[k], ids[k]);
    EXPECT_EQ(gone.position[k], table.position[id]);
    EXPECT_EQ(gone.inverse_mass[k], table.inverse_mass[id]);
    EXPECT_EQ(gone.mobility[k], table.mobility[id]);
    EXPECT_EQ(left.mobility[id], Mobility::absent);
    left.mobility[id] = table.mobility[id];
    left.inverse_mass[id] = table.inverse_mass[id];
    left.inverse_inertia[id] = table.inverse_inertia[id];
  }
  EXPECT_EQ(hash_of(left), hash_of(table)) << "nothing else has changed";
}

TYPED_TEST(ComingAndGoing, FreeBodiesInARegionAreFoundInOrder) {
  BodyTable table = random_bodies();
  const Region region{.name = "", .from = {-3, -4, -2}, .to = {4, 3, 5}};
  table.position[0] = region.from;  // the region is a closed box
  std::vector<BodyNumber> inside;
  for (std::size_t k = 0; k < table.position.size(); ++k) {
    const Vec3& x = table.position[k];
    const bool is_in = (x - region.from).minCoeff() >= 0 && (region.to - x).minCoeff() >= 0;
    if (is_in && table.mobility[k] == Mobility::free)
      inside.push_back(BodyNumber{static_cast<std::int32_t>(k)});
  }
  ASSERT_GT(inside.size(), 50u);
  EXPECT_EQ(bodies_in<TypeParam>(region, in_space<TypeParam>(table)), inside);
}

TYPED_TEST(ComingAndGoing, ThoseNearABoxAreAllThatMayReachIntoIt) {
  BodyTable table = random_bodies();
  table.shape[3] = Shape::plane;
  table.mobility[5] = Mobility::absent;
  const Vec3 low(-1, -1, -1), high(1, 2, 0);
  std::vector<BodyNumber> near;
  for (std::size_t k = 0; k < table.position.size(); ++k) {
    double squared = 0;
    for (int a = 0; a < 3; ++a) {
      const double outside = std::max({low[a] - table.position[k][a], table.position[k][a] - high[a], 0.0});
      squared += outside * outside;
    }
    const bool boundary = table.shape[k] == Shape::plane || table.shape[k] == Shape::tube;
    if (table.mobility[k] != Mobility::absent &&
        (boundary || std::sqrt(squared) <= bounding_radius(table.shape[k], table.size[k])))
      near.push_back(BodyNumber{static_cast<std::int32_t>(k)});
  }
  ASSERT_GT(near.size(), 5u);
  ASSERT_LT(near.size(), 900u);
  EXPECT_EQ(bodies_near<TypeParam>(low, high, in_space<TypeParam>(table)).id, near);
}

TYPED_TEST(ComingAndGoing, ThoseTakenOutCanBeBroughtIn) {
  const BodyTable table = random_bodies();
  Bodies<TypeParam> bodies = in_space<TypeParam>(table);
  BodyTable gone = take_out<TypeParam>(numbers({0, 4, 350, 999}), bodies);
  gone.velocity[2] = Vec3(1, 2, 3);
  bring_in<TypeParam>(gone, bodies);
  BodyTable now;
  copy_bodies(now, bodies);
  EXPECT_EQ(now.velocity[350], Vec3(1, 2, 3));
  now.velocity[350] = table.velocity[350];
  EXPECT_EQ(hash_of(now), hash_of(table));
}

TYPED_TEST(ComingAndGoing, BodiesAreKnownByTheirNumbersWhereverTheyLie) {
  const BodyTable table = random_bodies();
  Bodies<TypeParam> here = in_space<TypeParam>(table);
  Bodies<TypeParam> there = in_space<TypeParam>(shuffled(table));
  find_places<TypeParam>(there);
  const Region region{.name = "", .from = {-3, -4, -2}, .to = {4, 3, 5}};
  const World world{.from = region.from, .to = region.to};
  EXPECT_EQ(bodies_in<TypeParam>(region, there), bodies_in<TypeParam>(region, here));
  EXPECT_EQ(bodies_beyond<TypeParam>(world, there), bodies_beyond<TypeParam>(world, here));
  EXPECT_EQ(hash_of(bodies_near<TypeParam>(region.from, region.to, there)),
            hash_of(bodies_near<TypeParam>(region.from, region.to, here)));
  const std::vector<BodyNumber> some = numbers({700, 4, 350, 999});
  BodyTable gone = take_out<TypeParam>(some, there);
  EXPECT_EQ(gone.id, some);
  EXPECT_EQ(hash_of(gone), hash_of(take_out<TypeParam>(some, here)));
  gone.velocity[2] = Vec3(1, 2, 3);
  bring_in<TypeParam>(gone, there);
  BodyTable now;
  copy_by_number<TypeParam>(now, there);
  EXPECT_EQ(now.velocity[350], Vec3(1, 2, 3));
  now.velocity[350] = table.velocity[350];
  EXPECT_EQ(hash_of(now), hash_of(table));
}

}  // namespace
}  // namespace scree
