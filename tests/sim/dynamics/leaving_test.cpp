// Bodies that go, in each space, against loops.
#include "sim/dynamics/leaving.hpp"

#include "tests/core/spaces.hpp"
#include "tests/sim/dynamics/crowd.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace scree {
namespace {

template <class Space>
class LeavingTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(LeavingTest, test::Spaces, test::SpaceName);

TYPED_TEST(LeavingTest, FreeBodiesBeyondTheWorldAreFoundInOrder) {
  BodyTable table = crowd();
  const World world{.from = {-3, -4, -2}, .to = {4, 3, 5}};
  table.position[0] = world.to;  // the world is closed
  std::vector<std::int32_t> beyond;
  for (std::size_t k = 0; k < table.position.size(); ++k) {
    bool inside = true;
    for (int a = 0; a < 3; ++a)
      inside = inside && table.position[k][a] >= world.from[a] && table.position[k][a] <= world.to[a];
    if (!inside && table.mobility[k] == Mobility::free) beyond.push_back(static_cast<std::int32_t>(k));
  }
  ASSERT_GT(beyond.size(), 100u);
  EXPECT_EQ(bodies_beyond<TypeParam>(world, in_space<TypeParam>(table)), beyond);
  const World all{.from = Vec3::Constant(-9), .to = Vec3::Constant(9)};
  EXPECT_TRUE(bodies_beyond<TypeParam>(all, in_space<TypeParam>(table)).empty());
}

TYPED_TEST(LeavingTest, ThoseTakenOutAreReturnedAsTheyWere) {
  const BodyTable table = crowd();
  Bodies<TypeParam> bodies = in_space<TypeParam>(table);
  const std::vector<std::int32_t> ids = {0, 4, 350, 999};
  const BodyTable gone = take_out<TypeParam>(ids, bodies);
  BodyTable left;
  copy_bodies(left, bodies);
  ASSERT_EQ(gone.count(), 4);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const auto id = static_cast<std::size_t>(ids[k]);
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

}  // namespace
}  // namespace scree
