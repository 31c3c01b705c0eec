// Tests that the bodies of a step that failed are found and named.
#include "sim/step/step_failure.hpp"

#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace scree {
namespace {

Scene scene() {
  return scene_of(
      "time: {end: 1, step: 0.1}\nmaterials: {stone: {}}\nbodies:\n"
      "  - {sphere: {radius: 0.1}, material: stone}\n"
      "  - {sphere: {radius: 0.1}, name: ball, at: [1, 0, 0], repeat: {count: [12, 1, 1], spacing: [1, 1, "
      "1]}, "
      "material: stone}\n");
}

TEST(StepFailure, BodiesOutOfRangeAreFound) {
  BodyTable bodies = scene().bodies;
  EXPECT_TRUE(bodies_out_of_range(bodies).empty());
  bodies.spin[9].y() = std::numeric_limits<double>::quiet_NaN();
  bodies.position[4].z() = -1e39;
  bodies.orientation[2].w() = std::numeric_limits<double>::infinity();
  bodies.velocity[1].x() = std::numeric_limits<double>::quiet_NaN();
  bodies.mobility[1] = Mobility::absent;
  EXPECT_EQ(bodies_out_of_range(bodies), (std::vector<std::int32_t>{2, 4, 9}));
}

TEST(StepFailure, TheMostEnergeticComesFirst) {
  BodyTable bodies = scene().bodies;
  bodies.velocity[3].x() = 2;
  bodies.velocity[5].x() = -1;
  bodies.inverse_mass[5] /= 9;
  const std::vector<std::int32_t> order = by_kinetic_energy(bodies);
  ASSERT_EQ(order.size(), 13u);
  EXPECT_EQ(order[0], 5);
  EXPECT_EQ(order[1], 3);
}

TEST(StepFailure, BodiesAreNamedAsTheSceneDoes) {
  EXPECT_EQ(words_for({0, 3}, scene()), "body 0, ball[2] (body 3)");
  EXPECT_TRUE(
      words_for({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, scene()).ends_with(", ball[6] (body 7) and 3 more"));
}

}  // namespace
}  // namespace scree
