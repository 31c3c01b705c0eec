// Tests of many light bodies that strike a heavy one in one round: what is conserved, and how far the result
// is from that in the order of times.
#include "sim/impacts/impact_group.hpp"

#include "tests/core/spaces.hpp"
#include "tests/sim/impacts/impact_outcomes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

template <class Space>
class ImpactGroups : public test::InSpace<Space> {};
TYPED_TEST_SUITE(ImpactGroups, test::Spaces, test::SpaceName);

/// Energy, momentum, and angular momentum about the origin, of the free bodies at the midpoint.
struct Conserved {
  double energy = 0;
  Vec3 momentum = Vec3::Zero();
  Vec3 angular = Vec3::Zero();
};
Conserved conserved_by(const BodyTable& bodies, const Vec3& gravity) {
  Conserved sum;
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    if (bodies.mobility[k] != Mobility::free) continue;
    const Vec3 momentum = bodies.velocity[k] / bodies.inverse_mass[k];
    sum.energy += 0.5 * momentum.dot(bodies.velocity[k]) -
                  gravity.dot(bodies.position[k]) / bodies.inverse_mass[k] +
                  rotational_energy(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k]);
    sum.momentum += momentum;
    sum.angular += bodies.position[k].cross(momentum) +
                   spin_momentum(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k]);
  }
  return sum;
}

/// Returns a thousand light balls around a heavy body of 0.5 m, all on their way to it.
FlightScene under_fire(Shape shape, double ratio) {
  FlightScene scene;
  scene.add(shape, Vec3(0.5, 0.4, 0.3), Vec3::Zero(), Vec3(0.3, 0.2, -0.1));
  if (shape == Shape::sphere) scene.bodies.size[0] = Vec3::Constant(0.5);
  scene.bodies.spin[0] = Vec3(1, -2, 3);
  scene.weigh(0, ratio);
  for (std::int32_t k = 1; k <= 1000; ++k) {
    Random random(17, static_cast<std::uint64_t>(k));
    const double height = (k - 0.5) / 500 - 1;  // a spiral from pole to pole
    const double turn = 2.399963 * k;
    const Vec3 from = Vec3(std::cos(turn) * std::sqrt(1 - height * height),
                           std::sin(turn) * std::sqrt(1 - height * height), height);
    const double gap = random.uniform(0.001, 0.004);
    const double far =
        shape == Shape::sphere ? 0.51 : (from.cwiseAbs().cwiseQuotient(Vec3(0.51, 0.41, 0.31))).maxCoeff();
    scene.add_ball(0.01, shape == Shape::sphere ? Vec3((far + gap) * from) : Vec3((1 / far + gap) * from),
                   vector_in(random, 0.5) - random.uniform(1, 2) * from);
    scene.bodies.spin.back() = vector_in(random, 20);
  }
  return scene;
}

TYPED_TEST(ImpactGroups, ManyStrikeAHeavyBodyAtOnce) {
  for (const Shape shape : {Shape::sphere, Shape::box}) {
    for (const double restitution : {1.0, 0.5, 0.0}) {
      FlightScene scene = under_fire(shape, 1e5);
      scene.law = {.restitution = restitution, .friction = 0.4};
      scene.parameters.gravity = Vec3(0, 0, -9.81);
      scene.parameters.restitution_threshold = {.any = 0, .lossy = 0};
      const std::vector<Pair> pairs = scene.pairs(0.02);
      const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
      const Outcome order = in_time_order(scene, pairs);
      if (restitution > 0) {
        EXPECT_GT(rounds.impacts.size(), 500u);
      }
      EXPECT_LT(rounds.rounds, 20);
      const Conserved before = conserved_by(scene.bodies, scene.parameters.gravity);
      const Conserved after = conserved_by(rounds.bodies, scene.parameters.gravity);
      EXPECT_LE((after.momentum - before.momentum).norm(), 1e-13 * 1e5);
      EXPECT_LE((after.angular - rounds.moved.angular_correction - before.angular).norm(), 1e-12 * 1e5);
      const double explained =
          before.energy - rounds.moved.restitution - rounds.moved.friction + rounds.moved.integration;
      EXPECT_NEAR(after.energy, explained, 1e-13 * before.energy);
      EXPECT_GE(rounds.moved.restitution, -1e-12);
      EXPECT_GE(rounds.moved.friction, 0);
      // Each impact sees the heavy body without the other impacts of its round, which together give 1000 kg
      // m/s to a mass of 1e5 kg.
      EXPECT_LE((rounds.bodies.velocity[0] - order.bodies.velocity[0]).norm(), 2e-5);
      EXPECT_NEAR(rounds.moved.restitution, order.moved.restitution, 1e-2 * (1 + order.moved.restitution));
      EXPECT_NEAR(rounds.moved.friction, order.moved.friction, 1e-2 * (1 + order.moved.friction));
    }
  }
}

TYPED_TEST(ImpactGroups, AHeavyBodyIsStruckAsInTheOrderOfTimesTheMoreTheHeavierItIs) {
  double last = HUGE_VAL;
  for (const double ratio : {1e3, 1e4, 1e5, 1e6}) {
    FlightScene scene = under_fire(Shape::sphere, ratio);
    scene.parameters.rotation = false;
    const std::vector<Pair> pairs = scene.pairs(0.02);
    const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
    const Outcome order = in_time_order(scene, pairs);
    const double given = (order.bodies.velocity[0] - scene.bodies.velocity[0]).norm();
    const double error = (rounds.bodies.velocity[0] - order.bodies.velocity[0]).norm() / given;
    EXPECT_LT(error, 0.3 * last) << ratio;
    last = error;
  }
  EXPECT_LT(last, 1e-2);
}

/// The surface of a plane that tilts has no bound on its speed.
TYPED_TEST(ImpactGroups, AHeavyBodyIsStruckWhereAWallTilts) {
  FlightScene scene = under_fire(Shape::sphere, 1e5);
  scene.add_plane(Vec3::UnitZ(), -10);
  scene.bodies.mobility.back() = Mobility::prescribed;
  scene.bodies.spin.back() = Vec3(0.1, 0, 0);
  const std::vector<Pair> pairs = scene.pairs(0.02);
  const Outcome rounds = in_rounds<TypeParam>(scene, pairs);
  EXPECT_GT(rounds.impacts.size(), 500u);
  EXPECT_LT((rounds.bodies.velocity[0] - in_time_order(scene, pairs).bodies.velocity[0]).norm(), 2e-5);
}

TYPED_TEST(ImpactGroups, OneLightBallOnAHeavyOneIsAsInTheOrderOfTimes) {
  FlightScene scene = under_fire(Shape::box, 1e5);
  scene.law = {.restitution = 0.7, .friction = 0.4};
  scene.parameters.gravity = Vec3(0, 0, -9.81);
  std::size_t impacts = 0;
  for (const Pair& pair : scene.pairs(0.02)) {
    if (pair.i != 0) continue;
    const Outcome order = in_time_order(scene, {pair});
    const Outcome rounds = in_rounds<TypeParam>(scene, {pair});
    // The heavy body turns with some 1e5 J, which the tolerance allows to be rounded.
    ASSERT_NO_FATAL_FAILURE(expect_same(rounds, order, 1e-9)) << pair.j;
    impacts += order.impacts.size();
  }
  EXPECT_GT(impacts, 500u);
}

/// The gas is not so dense that a light ball would use up its impact budget between two heavy ones.
TYPED_TEST(ImpactGroups, HeavyBodiesInAGasKeepItsEnergy) {
  FlightScene scene = gas(0.2);
  scene.parameters.rotation = false;
  for (std::int32_t k = 0; k < 1000; k += 7) scene.weigh(k, 1e3);
  for (std::int32_t k = 0; k < 1000; k += 70) scene.weigh(k, 1e3);
  const double energy = conserved_by(scene.bodies, Vec3::Zero()).energy;
  std::size_t impacts = 0;
  for (int substep = 0; substep < 30; ++substep) {
    scene.fly(0.5 * scene.step);
    const Outcome outcome = in_rounds<TypeParam>(scene, scene.pairs(0.05));
    impacts += outcome.impacts.size();
    scene.bodies = outcome.bodies;
    scene.fly(0.5 * scene.step);
  }
  EXPECT_GT(impacts, 3000u);
  EXPECT_NEAR(conserved_by(scene.bodies, Vec3::Zero()).energy, energy, 1e-12 * energy);
}

}  // namespace
}  // namespace scree
