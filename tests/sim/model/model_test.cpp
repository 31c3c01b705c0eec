// Tests that a run computes only what its scene needs: each feature is off where it cannot matter, and
// computing it there changes no bit.
#include "sim/model/model.hpp"

#include "sim/step/step_failure.hpp"
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace scree {
namespace {

/// A scene in which everything lands on everything within the time given.
const std::string smooth_spheres = R"(
gravity: [0, 0, -9.81]
time: {end: 0.4, step: 0.005}
materials: {a: {density: 1000, restitution: 0.4}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {sphere: {radius: {uniform: [0.04, 0.06]}}, at: [0, 0, 0.1], repeat: {count: [4, 4, 3], spacing: [0.125, 0.125, 0.125], jitter: 0.002}, material: a}
)";

const std::string smooth_boxes = R"(
gravity: [0, 0, -9.81]
time: {end: 0.4, step: 0.005}
materials: {a: {density: 1000}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: [0.1, 0.12, 0.14]}, at: [0, 0, 0.1], repeat: {count: [3, 3, 3], spacing: [0.17, 0.17, 0.17], jitter: 0.004}, rotate: {axis: [1, 1, 0], degrees: 20}, material: a}
)";

const std::string rough_cubes_and_balls = R"(
gravity: [0, 0, -9.81]
time: {end: 0.4, step: 0.005}
materials: {a: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: [0.1, 0.1, 0.1]}, at: [0, 0, 0.1], repeat: {count: [3, 3, 2], spacing: [0.17, 0.17, 0.17], jitter: 0.004}, rotate: {axis: [1, 1, 0], degrees: 20}, spin: [1, 2, 3], material: a}
  - {sphere: {radius: 0.05}, at: [0, 0, 0.5], repeat: {count: [3, 3, 2], spacing: [0.12, 0.12, 0.12], jitter: 0.004}, material: a}
)";

/// A scene with a coefficient of rolling friction, but without a round body of that material.
const std::string rough_flat_boxes = R"(
gravity: [0, 0, -9.81]
time: {end: 0.4, step: 0.005}
materials: {a: {density: 1000, friction: 0.5, rolling_friction: 0.2}, b: {density: 1000, friction: 0.3}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: [0.1, 0.12, 0.14]}, at: [0, 0, 0.1], repeat: {count: [3, 3, 2], spacing: [0.17, 0.17, 0.17], jitter: 0.004}, rotate: {axis: [1, 1, 0], degrees: 20}, material: a}
  - {sphere: {radius: 0.05}, at: [0, 0, 0.5], repeat: {count: [3, 3, 2], spacing: [0.12, 0.12, 0.12], jitter: 0.004}, material: b}
)";

struct Case {
  const char* feature;
  const std::string& scene;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.feature; }

bool is_on(const Scene& scene, const std::string& feature) {
  const std::vector<Feature> features = plan_model(scene).features();
  return std::ranges::find(features, feature, &Feature::name)->on;
}

std::uint64_t hash_at_end(const Scene& scene) {
  Simulation simulation(scene, one_thread);
  run_to_end(simulation);
  return simulation.state_hash();
}

class Model : public testing::TestWithParam<Case> {};

TEST_P(Model, WhatCannotMatterIsOffAndChangesNoBit) {
  const auto& [feature, text] = GetParam();
  const Scene lean = scene_of(text);
  const Scene full = scene_of(text + "model: {" + feature + ": on}\n");
  EXPECT_FALSE(is_on(lean, feature));
  EXPECT_TRUE(is_on(full, feature));
  EXPECT_EQ(hash_at_end(lean), hash_at_end(full));
}

/// Returns whether the outcome shows that the first scene leaves something out: its bits differ from those of
/// the second scene, or the guards stop it.
bool is_seen(const Scene& lean, const Scene& full) try {
  return hash_at_end(lean) != hash_at_end(full);
} catch (const StepFailure&) {
  return true;
}

/// This shows that the oracle can fail: where a feature matters, leaving it out is seen.
TEST_P(Model, WhatMattersIsOnAndChangesBits) {
  static const std::string rough_bodies = R"(
gravity: [0, 0, -9.81]
time: {end: 0.4, step: 0.005}
materials: {a: {density: 1000, friction: 0.5, restitution: 0.4, rolling_friction: 0.1}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {sphere: {radius: 0.05}, at: [1, 0, 0.05], velocity: [1, 0, 0], material: a}
  - {box: {size: [0.1, 0.12, 0.14]}, at: [0, 0, 0.2], rotate: {axis: [1, 1, 0], degrees: 20}, spin: [1, 2, 3], velocity: [1, 0, 0], material: a}
)";
  const std::string feature = GetParam().feature;
  const Scene full = scene_of(rough_bodies);
  EXPECT_TRUE(is_on(full, feature));
  EXPECT_TRUE(is_seen(scene_of(rough_bodies + "model: {" + feature + ": off}\n"), full));
}

const std::string smooth_inelastic_spheres = [] {
  std::string text = smooth_spheres;
  text.replace(text.find(", restitution: 0.4"), 18, "");
  return text;
}();

INSTANTIATE_TEST_SUITE_P(Features, Model,
                         testing::Values(Case{"friction", smooth_spheres}, Case{"friction", smooth_boxes},
                                         Case{"rolling_friction", rough_cubes_and_balls},
                                         Case{"rolling_friction", rough_flat_boxes},
                                         Case{"rotation", smooth_spheres}, Case{"restitution", smooth_boxes},
                                         Case{"restitution", smooth_inelastic_spheres},
                                         Case{"restitution", rough_cubes_and_balls}));

/// Continuous detection is chosen substep by substep: where no body is fast, forbidding it changes nothing.
TEST(ModelPlan, ContinuousDetectionLeavesSlowScenesAsTheyAre) {
  const std::string slow = R"(
gravity: [0, 0, -9.81]
time: {end: 0.5, step: 0.001}
materials: {a: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: [0.1, 0.12, 0.14]}, at: [0, 0, 0.071], repeat: {count: [2, 2, 3], spacing: [0.17, 0.17, 0.142]}, material: a}
)";
  EXPECT_TRUE(is_on(scene_of(slow), "continuous"));
  EXPECT_EQ(hash_at_end(scene_of(slow)), hash_at_end(scene_of(slow + "model: {continuous: off}\n")));
}

/// The gyroscopic term is chosen body by body (rotation_test.cpp tests the equivalence).
TEST(ModelPlan, GyroscopicIsOffForSpheresAndCubes) {
  EXPECT_FALSE(is_on(scene_of(rough_cubes_and_balls), "gyroscopic"));
  EXPECT_TRUE(is_on(scene_of(smooth_boxes), "gyroscopic"));
}

TEST(ModelPlan, GravityIsOffWhereThereIsNone) {
  EXPECT_TRUE(is_on(scene_of(smooth_spheres), "gravity"));
  EXPECT_FALSE(is_on(scene_of("time: {end: 1, step: 0.1}\nmaterials: {a: {density: 1}}\nbodies:\n"
                              "  - {sphere: {radius: 1}, material: a}\n"),
                     "gravity"));
}

/// There is one grid level for equal spheres and several for sizes far apart, and any number of levels gives
/// the same bits.
TEST(ModelPlan, GridLevelsFollowTheSizesAndChangeNoBit) {
  const std::string mixed = R"(
gravity: [0, 0, -9.81]
time: {end: 0.2, step: 0.005}
materials: {a: {density: 1000, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {sphere: {radius: 0.4}, scatter: {count: 20, from: [0, 0, 0], to: [4, 4, 4]}, material: a}
  - {sphere: {radius: 0.02}, scatter: {count: 1000, from: [0, 0, 0], to: [4, 4, 0.5]}, material: a}
)";
  EXPECT_FALSE(is_on(scene_of(smooth_spheres), "levels"));
  EXPECT_TRUE(is_on(scene_of(mixed), "levels"));
  for (const std::string& text : {smooth_spheres, mixed}) {
    const std::uint64_t hash = hash_at_end(scene_of(text));
    for (const char* levels : {"1", "2", "4"})
      EXPECT_EQ(hash, hash_at_end(scene_of(text + "broadphase: {levels: " + levels + "}\n"))) << levels;
  }
}

/// Planes are unbounded bodies outside the grid; boxes with the same faces hold the same balls in the same
/// way.
TEST(ModelPlan, PlanesAndThickBoxesAreTheSameWalls) {
  const std::string head = R"(
gravity: [0, 0, -9.81]
time: {end: 0.3, step: 0.005}
materials: {a: {density: 1000, friction: 0.5, restitution: 0.3}}
bodies:
  - {sphere: {radius: 0.05}, at: [0, 0, 0.06], repeat: {count: [3, 3, 1], spacing: [0.125, 0.125, 0.1]}, velocity: [0.3, 0.2, 0], material: a}
)";
  Simulation planes(scene_of(head + R"(
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {plane: {normal: [-1, 0, 0], offset: -0.35}, material: a}
)"),
                    one_thread);
  Simulation boxes(scene_of(head + R"(
  - {box: {size: [4, 4, 2]}, at: [0, 0, -1], fixed: true, material: a}
  - {box: {size: [2, 4, 4]}, at: [1.35, 0, 0], fixed: true, material: a}
)"),
                   one_thread);
  run_to_end(planes);
  run_to_end(boxes);
  for (std::int32_t k = 0; k < 9; ++k) {
    EXPECT_LT((planes.body(k).position - boxes.body(k).position).norm(), 1e-14) << k;
    EXPECT_LT((planes.body(k).spin - boxes.body(k).spin).norm(), 1e-12) << k;
  }
}

}  // namespace
}  // namespace scree
