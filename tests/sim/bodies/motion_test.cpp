// Tests of free and prescribed motion and of the sums over bodies, in each space, against loops and closed
// forms.
#include "sim/bodies/motion.hpp"

#include "core/rng.hpp"
#include "sim/bodies/prescribed.hpp"
#include "sim/bodies/region.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/bodies/random_bodies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace scree {
namespace {

template <class Space>
class MotionTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(MotionTest, test::Spaces, test::SpaceName);

TYPED_TEST(MotionTest, FreeBodiesFlyOnAndTurn) {
  const BodyTable before = random_bodies();
  Bodies<TypeParam> bodies = in_space<TypeParam>(before);
  constexpr double dt = 0.01;
  EXPECT_EQ(advance<TypeParam>(bodies, dt, {}), 0) << "equal moments: the energy does not drift";
  BodyTable after;
  copy_bodies(after, bodies);
  for (std::size_t k = 0; k < count; ++k) {
    const double time = before.mobility[k] == Mobility::free ? dt : 0;
    const Quat turned = rotation_of(time * before.spin[k]) * before.orientation[k];
    ASSERT_LT((after.position[k] - before.position[k] - time * before.velocity[k]).norm(), 1e-14);
    ASSERT_LT(after.orientation[k].angularDistance(turned), 1e-14);
    ASSERT_EQ(after.spin[k], before.spin[k]);
  }
}

TYPED_TEST(MotionTest, SumsAndExtremesAreThoseOfALoop) {
  BodyTable table = random_bodies();
  Bodies<TypeParam> bodies = in_space<TypeParam>(table);
  const Vec3 gravity(0.3, -0.2, -9.81);
  const Vec3 reference(1, 2, 3);
  const Region region{.name = "a", .from = Vec3(-3, -2, -4), .to = Vec3(2, 4, 1)};
  long double kinetic = 0, potential = 0, mass = 0, inside = 0;
  Vec3 momentum = Vec3::Zero();
  std::int64_t free = 0, inside_count = 0;
  double fastest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (table.mobility[k] != Mobility::free) continue;
    const double m = 1 / table.inverse_mass[k];
    const Vec3& x = table.position[k];
    ++free;
    mass += m;
    kinetic += 0.5L * m * table.velocity[k].squaredNorm();
    potential -= m * gravity.dot(x - reference);
    momentum += m * table.velocity[k];
    fastest = std::max(fastest, table.velocity[k].norm());
    if ((x - region.from).minCoeff() < 0 || (region.to - x).minCoeff() < 0) continue;
    ++inside_count;
    inside += m;
  }
  const Totals totals = totals_of<TypeParam>(bodies, gravity, reference);
  EXPECT_EQ(totals.count, free);
  EXPECT_NEAR(totals.mass, static_cast<double>(mass), 1e-11);
  EXPECT_NEAR(totals.kinetic_linear, static_cast<double>(kinetic), 1e-10);
  EXPECT_NEAR(totals.potential, static_cast<double>(potential), 1e-9);
  EXPECT_LT((totals.momentum - momentum).norm(), 1e-11);
  const Energies energies = energies_of<TypeParam>(bodies, gravity, reference);
  EXPECT_NEAR(energies.kinetic(), totals.kinetic_linear + totals.kinetic_angular, 1e-10);
  EXPECT_NEAR(energies.potential, totals.potential, 1e-9);
  EXPECT_NEAR(largest_speed<TypeParam>(bodies), fastest, 1e-14);
  const RegionContents contents = contents_of<TypeParam>(region, bodies);
  EXPECT_GT(inside_count, 50);
  EXPECT_EQ(contents.count, inside_count);
  EXPECT_NEAR(contents.mass, static_cast<double>(inside), 1e-11);
}

TYPED_TEST(MotionTest, BodiesWithANumberThatIsNotFiniteAreCounted) {
  const auto count_of = [](const BodyTable& table) {
    return energies_of<TypeParam>(in_space<TypeParam>(table), Vec3::Zero(), Vec3::Zero()).not_finite;
  };
  BodyTable table = random_bodies();
  ASSERT_EQ(table.mobility[900], Mobility::free);
  EXPECT_EQ(count_of(table), 0);
  table.spin[900].y() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(count_of(table), 1);
  table.position[400].z() = std::numeric_limits<double>::quiet_NaN();
  table.velocity[34].x() = -std::numeric_limits<double>::infinity();
  table.orientation[32].w() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(count_of(table), 4);
  table.velocity[34].x() = 1e308;  // the speed is too large for its energy, but it is a number
  EXPECT_EQ(count_of(table), 3);
}

TYPED_TEST(MotionTest, WorkIsForceTimesWay) {
  const BodyTable table = random_bodies();
  Bodies<TypeParam> bodies = in_space<TypeParam>(table);
  Array<Vec3, TypeParam> start, acceleration;
  copy(start, std::vector<Vec3>(count, Vec3(1, 0, 0)));
  copy(acceleration, table.velocity);
  long double work = 0;
  for (std::size_t k = 0; k < count; ++k)
    if (table.mobility[k] == Mobility::free)
      work += table.velocity[k].dot(table.position[k] - Vec3(1, 0, 0)) / table.inverse_mass[k];
  EXPECT_NEAR(work_of_forces(bodies, start, std::as_const(acceleration).view()), static_cast<double>(work),
              1e-10);
}

TYPED_TEST(MotionTest, PrescribedBodiesAreWhereTheirPathsSay) {
  const BodyTable start = random_bodies();
  Bodies<TypeParam> bodies = in_space<TypeParam>(start);
  PathTable table;
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(count); ++k)
    table.paths.push_back({.body = BodyNumber{k},
                           .pivot = Vec3(1, 0, 2),
                           .arm = Vec3(0, 1, 0),
                           .orientation = Quat::Identity(),
                           .velocity = Vec3(0, 0, 3),
                           .spin = Vec3(0, 0, 2),
                           .start = 0.1});
  place_prescribed(PrescribedPaths<TypeParam>(table), 0.6, bodies);
  BodyTable placed;
  copy_bodies(placed, bodies);
  const Vec3 arm(-std::sin(1.0), std::cos(1.0), 0);
  for (std::size_t k = 0; k < count; ++k) {
    const bool moves = start.mobility[k] == Mobility::prescribed;
    const Vec3 position = moves ? Vec3(Vec3(1, 0, 3.5) + arm) : start.position[k];
    const Vec3 velocity = moves ? Vec3(-2 * arm.y(), 2 * arm.x(), 3) : start.velocity[k];
    ASSERT_LT((placed.position[k] - position).norm(), 1e-14);
    ASSERT_LT((placed.velocity[k] - velocity).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace scree
