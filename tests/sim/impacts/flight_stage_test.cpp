// Tests that pairs whose top speeds sum to less than the least impact speed, which are passed over, have no
// impact in the whole search either.
#include "sim/impacts/flight_stage.hpp"

#include "core/rng.hpp"

#include <gtest/gtest.h>

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

INSTANTIATE_TEST_SUITE_P(Steps, LeastImpactSpeed, testing::Values(1.0 / 240, 1.0 / 1000));

}  // namespace
}  // namespace scree
