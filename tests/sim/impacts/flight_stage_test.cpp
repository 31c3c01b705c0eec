// Tests that pairs that are passed over have no impact in the whole search either: those whose top speeds sum
// to less than the least impact speed, and those that do not come near one another.
#include "sim/impacts/flight_stage.hpp"

#include "core/rng.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace scree {
namespace {

constexpr std::int32_t count = 60;

/// Returns a plane, and balls and boxes that nearly touch, at 0.1 mm/s to 3 m/s.
BodyTable crowd(std::uint64_t seed) {
  BodyTable table;
  for (std::int32_t k = 0; k < count; ++k) {
    Random random(seed, static_cast<std::uint64_t>(k));
    const auto vector = [&random](double size) {
      const double x = random.uniform(-size, size);
      const double y = random.uniform(-size, size);
      return Vec3(x, y, random.uniform(-size, size));
    };
    const Shape shape = k == 0 ? Shape::plane : k % 3 == 0 ? Shape::box : Shape::sphere;
    const bool plane = shape == Shape::plane;
    const double speed = std::pow(10, random.uniform(-4, 0.5));
    table.position.push_back(plane ? Vec3(Vec3::Zero()) : Vec3(vector(0.25) + Vec3(0, 0, 0.25)));
    table.orientation.push_back(plane ? Quat(Quat::Identity()) : rotation_of(vector(2)));
    table.velocity.push_back(plane ? Vec3(Vec3::Zero()) : vector(speed));
    table.spin.push_back(plane ? Vec3(Vec3::Zero()) : vector(speed));
    table.size.push_back(Vec3::Constant(0.03));
    table.inverse_mass.push_back(plane ? 0 : 1);
    table.inverse_inertia.push_back(plane ? Vec3(Vec3::Zero()) : Vec3(Vec3::Constant(2500)));
    table.shape.push_back(shape);
    table.mobility.push_back(plane ? Mobility::fixed : Mobility::free);
    table.material.push_back(k % 2);
    table.id.push_back(BodyNumber{k});
  }
  return table;
}

class LeastImpactSpeed : public testing::TestWithParam<double> {};  // the parameter is the step (s)

TEST_P(LeastImpactSpeed, TwoSlowBodiesHaveNoImpact) {
  std::int64_t passed_over = 0;
  std::int64_t met = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Bodies<Host> bodies;
    copy_bodies(bodies, crowd(seed));
    const std::vector<PairLaw> table{{0.3, 0}, {0.5, 0}, {0.5, 0}, {0.6, 0}};
    const ContactLaws laws{bodies.shape.view(),    bodies.size.view(), bodies.mobility.view(),
                           bodies.material.view(), {table.data(), 4},  2};
    for (const double from : {0.0, 0.5 * GetParam()}) {
      const FlightTerms terms{.laws = laws, .step = GetParam(), .from = from, .bounces = from == 0};
      ResponseParameters parameters;
      parameters.gravity = Vec3(0, 0, -9.81);
      parameters.restitution_threshold = {.any = 0, .lossy = 2 * 9.81 * GetParam()};
      FlightLog<Host> log;
      log.resize(count);
      FlightStage stage(terms, parameters, view_of(bodies), log);
      for (std::int32_t k = 0; k < count; ++k) {
        stage.clock[k] = from;
        stage.budget_used[k] = 0;
        stage.bound(k);
      }
      const double least_impact_speed = stage.find_least_impact_speed(0.03, 0.6);
      for (std::int32_t i = 0; i < count; ++i) {
        for (std::int32_t j = i + 1; j < count; ++j) {
          const bool meets = stage.next(i, j, LoadedParts{}).time <= terms.step;
          met += meets ? 1 : 0;
          if (stage.top_speed[i] + stage.top_speed[j] > least_impact_speed) continue;
          ++passed_over;
          ASSERT_FALSE(meets) << "seed " << seed << ", bodies " << i << " and " << j;
        }
      }
    }
  }
  EXPECT_GT(passed_over, 1000);
  EXPECT_GT(met, 100);
}

/// Returns a body and a boundary that both move and turn, and another body. The boundary's surface is near
/// the first one.
BodyTable near_a_boundary(std::uint64_t seed, Shape boundary, bool tilts) {
  constexpr double size = 0.03;
  Random random(seed, tilts ? 1u : 0u);
  const auto vector = [&random](double most) {
    const double x = random.uniform(-most, most);
    const double y = random.uniform(-most, most);
    return Vec3(x, y, random.uniform(-most, most));
  };
  const Quat turned = rotation_of(vector(3));
  const Vec3 up = turned * Vec3::UnitZ();
  const double speed = std::pow(10, random.uniform(-2, 1));
  BodyTable table;
  const auto add = [&](Shape shape, const Vec3& position, const Vec3& extents, Mobility mobility) {
    const bool is_free = mobility == Mobility::free;
    table.position.push_back(position);
    table.orientation.push_back(is_free ? rotation_of(vector(3)) : turned);
    table.velocity.push_back(vector(speed));
    table.spin.push_back(is_free || tilts ? vector(3 * speed) : Vec3(random.uniform(-9, 9) * speed * up));
    table.size.push_back(extents);
    table.inverse_mass.push_back(is_free ? 1 : 0);
    table.inverse_inertia.push_back(is_free ? Vec3(2000, 2500, 3000) : Vec3(Vec3::Zero()));
    table.shape.push_back(shape);
    table.mobility.push_back(mobility);
    table.material.push_back(0);
    table.id.push_back(BodyNumber{static_cast<std::int32_t>(table.id.size())});
  };
  const auto body_shape = [&random] { return random.uniform(0, 1) < 0.5 ? Shape::sphere : Shape::box; };
  const Vec3 at = vector(1);
  const Vec3 away = size * random.uniform(0.8, 3.0) * up;
  add(boundary, boundary == Shape::plane ? Vec3(at - away) : Vec3(at + away - 0.4 * up), Vec3(0.5, 0, 0.4),
      Mobility::prescribed);
  add(body_shape(), at, Vec3::Constant(size), Mobility::free);
  add(body_shape(), at + size * random.uniform(1.5, 4) * vector(1).normalized(), Vec3::Constant(size),
      Mobility::free);
  return table;
}

/// Returns accelerations of the three bodies, or none if the seed is even.
Array<Vec3, Host> accelerations(std::uint64_t seed) {
  Array<Vec3, Host> of_bodies;
  if (seed % 2 == 0) return of_bodies;
  Random random(seed, 2);
  std::vector<Vec3> values;
  for (int k = 0; k < 3; ++k) {
    const double x = random.uniform(-300, 300);
    const double y = random.uniform(-300, 300);
    values.emplace_back(x, y, random.uniform(-300, 300));
  }
  copy(of_bodies, values);
  return of_bodies;
}

TEST(FlightStage, PairsThatMeetAreNotFar) {
  constexpr double step = 1.0 / 240;
  int met = 0, passed_over = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    for (const Shape boundary : {Shape::plane, Shape::tube}) {
      for (const bool tilts : {false, true}) {
        Bodies<Host> bodies;
        copy_bodies(bodies, near_a_boundary(seed, boundary, tilts));
        const std::vector<PairLaw> table{{0.5, 0}};
        const ContactLaws laws{bodies.shape.view(),    bodies.size.view(), bodies.mobility.view(),
                               bodies.material.view(), {table.data(), 1},  1};
        ResponseParameters parameters;
        parameters.gravity = Vec3(0, 0, -9.81);
        parameters.restitution_threshold = {.any = 0, .lossy = 0};
        FlightLog<Host> log;
        log.resize(bodies.count());
        // In every other trial the bodies have accelerations of their own.
        const Array<Vec3, Host> acceleration = accelerations(seed);
        parameters.acceleration = acceleration.view();
        const double from = seed / 2 % 2 == 0 ? 0.0 : 0.5 * step;
        const FlightStage stage({.laws = laws, .step = step, .from = from, .bounces = true}, parameters,
                                view_of(bodies), log);
        for (std::int32_t k = 0; k < bodies.count(); ++k) {
          stage.clock[k] = from;
          stage.budget_used[k] = 0;
          stage.bound(k);
        }
        for (const auto& [i, j] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
          PairFlight pair = stage.pair_of(i, j, step);
          for (double& slowest : pair.slowest) slowest = 0.01;
          const bool meet = next_meeting(pair, from).time <= step;
          ImpactLimits limits;
          const bool may = stage.may_meet(i, j, limits);
          met += meet ? 1 : 0;
          passed_over += may ? 0 : 1;
          ASSERT_TRUE(may || !meet) << "seed " << seed << ", bodies " << i << " and " << j;
        }
      }
    }
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(passed_over, 1000);
}

TEST(FlightStage, ASpinAboutTheAxisOfABoundaryMovesNoSurface) {
  Random random(1, 0);
  for (int k = 0; k < 1000; ++k) {
    const auto angle = [&random] { return random.uniform(-3, 3); };
    BodyFlight tube{};
    tube.shape = Shape::tube;
    tube.orientation = rotation_of(Vec3(angle(), 0, 0)) * rotation_of(Vec3(0, angle(), angle()));
    tube.spin = angle() * tube.axis();
    EXPECT_TRUE(tube.tilting_spin().isZero(0)) << k;
    tube.spin += 1e-10 * (tube.orientation * Vec3::UnitX());
    EXPECT_FALSE(tube.tilting_spin().isZero(0)) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Steps, LeastImpactSpeed, testing::Values(1.0 / 240, 1.0 / 1000));

}  // namespace
}  // namespace scree
