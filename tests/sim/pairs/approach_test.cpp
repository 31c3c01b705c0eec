// Tests of approach speeds, and of the margins of bodies that move along with their neighbours, in each
// space.
#include "sim/pairs/approach.hpp"

#include "core/tolerances.hpp"
#include "sim/pairs/fat_boxes.hpp"
#include "tests/core/spaces.hpp"
#include "tests/sim/bodies/random_bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace scree {
namespace {

template <class Space>
class ApproachTest : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ApproachTest, test::Spaces, test::SpaceName);

constexpr double dt = 0.01, slack = 0.5 * tolerance::contact_slack;

/// Returns balls of radius 0.5 m and, as number 0, a tube that turns at 2 rad/s around z.
BodyTable in_drum(const std::vector<Vec3>& position, const std::vector<Vec3>& velocity) {
  BodyTable bodies;
  for (std::size_t k = 0; k < position.size(); ++k) {
    const bool is_drum = k == 0;
    bodies.id.push_back(BodyNumber{static_cast<std::int32_t>(k)});
    bodies.position.push_back(position[k]);
    bodies.velocity.push_back(velocity[k]);
    bodies.orientation.push_back(Quat::Identity());
    bodies.spin.push_back(is_drum ? Vec3(0, 0, 2) : Vec3(9, 9, 9));
    bodies.size.push_back(is_drum ? Vec3(10, 0, 10) : Vec3(0.5, 0, 0));
    bodies.inverse_mass.push_back(is_drum ? 0 : 1);
    bodies.inverse_inertia.push_back(is_drum ? Vec3(0, 0, 0) : Vec3(1, 1, 1));
    bodies.shape.push_back(is_drum ? Shape::tube : Shape::sphere);
    bodies.mobility.push_back(is_drum ? Mobility::prescribed : Mobility::free);
    bodies.material.push_back(0);
  }
  return bodies;
}

/// Returns the lowered margins.
template <class Space>
std::vector<double> lowered(const BodyTable& table, const std::vector<Pair>& list,
                            const ResponseParameters& parameters, std::vector<double>* whole = nullptr) {
  const Bodies<Space> bodies = in_space<Space>(table);
  Array<Pair, Space> pairs;
  copy(pairs, list);
  Array<double, Space> margin;
  contact_margins(bodies, dt, tolerance::contact_slack, parameters, {}, margin);
  if (whole) *whole = to_vector(margin);
  ApproachFinder<Space> finder;
  contact_margins(bodies, dt, tolerance::contact_slack, parameters,
                  finder.find(bodies, std::as_const(pairs).view()), margin);
  return to_vector(margin);
}

/// Of a row of balls that falls, only those near one that has stopped have room for the fall.
TYPED_TEST(ApproachTest, BodiesThatMoveTogetherHaveRoomForTheirDifferenceAlone) {
  const Vec3 fall(0, 0, -4);
  std::vector<Vec3> position{Vec3::Zero()}, velocity{Vec3::Zero()};
  for (int k = 1; k <= 5; ++k) {
    position.push_back(Vec3(0, 0, k));
    velocity.push_back(k == 1 ? Vec3(Vec3::Zero()) : k == 5 ? Vec3(fall + Vec3(0.1, 0, 0)) : fall);
  }
  ResponseParameters parameters;
  parameters.gravity = Vec3(0, 0, -10);
  std::vector<double> whole;
  const std::vector<double> margin =
      lowered<TypeParam>(in_drum(position, velocity), {{1, 2}, {2, 3}, {3, 4}, {4, 5}}, parameters, &whole);
  const auto room = [](double speed) {
    return slack + tolerance::travel_factor * (2 * speed * dt + 10 * dt * dt);
  };
  EXPECT_EQ(margin[0], whole[0]) << "a body that is not free keeps its margin";
  EXPECT_EQ(margin[1], whole[1]) << "a ball at rest has no more room than before, whatever approaches it";
  EXPECT_EQ(margin[2], whole[2]) << "nor has the ball that approaches it";
  EXPECT_NEAR(margin[3], room(0), 1e-12);
  EXPECT_NEAR(margin[4], room(0.1), 1e-8);
  EXPECT_NEAR(margin[5], room(0.1), 1e-8);
  EXPECT_LT(4 * margin[3], whole[3]);
}

/// A ball that is carried along by the wall of a drum is as slow, relative to it, as the wall's point there.
TYPED_TEST(ApproachTest, AWallCountsWithItsVelocityAtTheOtherBody) {
  const std::vector<Vec3> position{Vec3::Zero(), Vec3(8, 0, 0), Vec3(0, 8, 1)};
  const std::vector<Vec3> velocity{Vec3::Zero(), Vec3(0, 16, 0), Vec3(-16, 0, 0.5)};
  const std::vector<double> margin = lowered<TypeParam>(in_drum(position, velocity), {{0, 1}, {0, 2}}, {});
  EXPECT_NEAR(margin[1], slack, 1e-12);
  EXPECT_NEAR(margin[2], slack + tolerance::travel_factor * 2 * 0.5 * dt, 1e-8);
}

TYPED_TEST(ApproachTest, NoMarginIsRaised) {
  const BodyTable bodies = random_bodies();
  std::vector<Pair> pairs;
  const auto n = static_cast<std::int32_t>(bodies.position.size());
  for (std::int32_t k = 0; k + 7 < n; ++k) pairs.push_back({k, k + 7});
  std::vector<double> whole;
  const std::vector<double> margin = lowered<TypeParam>(bodies, pairs, {}, &whole);
  ASSERT_EQ(margin.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) EXPECT_LE(margin[k], whole[k]) << k;
}

/// A spinning body needs room for its corners, unless it is a ball.
TYPED_TEST(ApproachTest, TheSpinOfABoxIsAnApproach) {
  BodyTable bodies =
      in_drum({Vec3::Zero(), Vec3(1, 0, 0), Vec3(2, 0, 0)}, {Vec3::Zero(), Vec3(30, 0, 0), Vec3(30, 0, 0)});
  bodies.shape[2] = Shape::box;
  bodies.size[2] = Vec3(0.5, 0.5, 0.5);
  bodies.spin[2] = Vec3(0, 0, 3);
  const std::vector<double> margin = lowered<TypeParam>(bodies, {{1, 2}}, {});
  const double speed = 3 * std::sqrt(0.75);
  for (const std::size_t k : {1, 2})
    EXPECT_NEAR(margin[k], slack + tolerance::travel_factor * 2 * speed * dt, 1e-7) << k;
  const std::vector<double> alone = lowered<TypeParam>(bodies, {}, {});
  EXPECT_NEAR(alone[1], slack, 1e-12);
  EXPECT_NEAR(alone[2], slack + tolerance::travel_factor * speed * dt, 1e-12) << "it may turn into another";
}

}  // namespace
}  // namespace scree
