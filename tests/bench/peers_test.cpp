// Tests of the benchmark against other engines: each engine gets the scene as it is, so that bodies fall,
// rest and slide as that engine's documentation promises; the judge and its errors give known values.
#include "bench/peers/cases.hpp"
#include "bench/peers/engine.hpp"
#include "core/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

namespace scree::bench {
namespace {

constexpr double step = 1.0 / 256;  // s; its multiples are exact

struct Entrant {
  const char* engine;
  const char* setting;
};

class Peers : public testing::TestWithParam<Entrant> {
 protected:
  /// Returns a scene with these bodies, gravity 9.81 m/s^2, friction 0.3 and no restitution. It is written to
  /// a file, because the engine `scree` reads that file again with its own settings.
  Scene scene_of(const std::string& bodies) {
    const std::string path = testing::TempDir() + "/peers_" + GetParam().engine + ".yaml";
    std::ofstream(path) << "format: 1\ngravity: [0, 0, -9.81]\ntime: {end: 10, step: 0.00390625}\n"
                           "materials: {a: {density: 1000, friction: 0.3}}\nbodies:\n"
                        << bodies;
    return read_scene(path);
  }

  BodyTable state_after(const std::string& bodies, int steps) {
    const Scene scene = scene_of(bodies);
    const auto engine = make_engine(GetParam().engine, GetParam().setting, scene, step);
    for (int k = 0; k < steps; ++k) engine->step();
    BodyTable table = scene.bodies;
    engine->read(table);
    return table;
  }
};

TEST_P(Peers, FallFreelyWithTheOrderOfTheirStep) {
  const int steps = 256;
  const BodyTable end = state_after(
      "  - {box: {size: [0.2, 0.3, 0.4]}, at: [1, 2, 3], velocity: [1, 0, 0], spin: [0, 0, 2], material: "
      "a}\n",
      steps);
  // Bodies fall farther by g t step / 2 with semi-implicit Euler; with the midpoint rule they do not.
  const double excess = 0.5 * 9.81 * 1 * step;
  EXPECT_NEAR(end.position[0].x(), 2, 1e-12);
  EXPECT_NEAR(end.position[0].z(), 3 - 0.5 * 9.81, 1.001 * excess);
  EXPECT_NEAR(end.velocity[0].z(), -9.81, 1e-12);
  EXPECT_NEAR(end.spin[0].z(), 2, 1e-12);
  const Vec3 axis = end.orientation[0] * Vec3::UnitX();
  // An orientation that is moved along its tangent and normalised again lags by (w h)^3 / 12 in each step,
  // which makes 1e-5.
  EXPECT_NEAR(std::atan2(axis.y(), axis.x()), 2, 1e-4);
}

TEST_P(Peers, RestOnAPlaneThatIsNotAtTheOrigin) {
  const BodyTable end = state_after(
      "  - {plane: {normal: [0, 0, 1], offset: 2}, material: a}\n"
      "  - {sphere: {radius: 0.25}, at: [0, 0, 2.25], material: a}\n",
      512);
  // Contacts that act like springs give way; a ball within half a percent of its radius counts as at rest.
  EXPECT_NEAR(end.position[1].z(), 2.25, 1e-3);
  EXPECT_NEAR(end.velocity[1].norm(), 0, 1e-2);
}

TEST_P(Peers, SlideAsTheFrictionOfThePairSays) {
  const BodyTable end = state_after(
      "  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}\n"
      "  - {sphere: {radius: 0.5}, at: [0, 0, 0.5], velocity: [4, 0, 0], material: a}\n",
      64);
  // Friction takes 0.0115 m/s in each step: no step lacks it, and no step applies it twice.
  EXPECT_NEAR(end.velocity[1].x(), 4 - 0.3 * 9.81 * 0.25, 0.01);
}

TEST_P(Peers, GiveWayToAForceAndATorqueAllTheTime) {
  const int steps = 128;
  const BodyTable end = state_after(
      "  - {sphere: {radius: 0.5}, name: a, at: [0, 0, 9], mass: 2, material: a}\n"
      "forces:\n"
      "  - {on: a, force: [6, -8, 0], torque: [0, 0, 3]}\n",
      steps);
  const double time = steps * step;
  EXPECT_NEAR((end.velocity[0] - Vec3(3, -4, -9.81) * time).norm(), 0, 1e-12);
  EXPECT_NEAR((end.spin[0] - Vec3(0, 0, 3 / (0.4 * 2 * 0.25)) * time).norm(), 0, 1e-12);
}

TEST_P(Peers, RefuseASettingThatTheyDoNotKnow) {
  const Scene scene = scene_of("  - {sphere: {radius: 1}, material: a}\n");
  for (const char* setting : {"no.such.setting=1", "none"})
    EXPECT_THROW(make_engine(GetParam().engine, setting, scene, step), InputError) << setting;
}

std::string name_of(const testing::TestParamInfo<Entrant>& entrant) {
  std::string name = entrant.param.engine + std::string("_") + entrant.param.setting;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

TEST(Engines, RefuseAForceThatEnds) {
  const Scene scene = parse_scene(R"(
format: 1
time: {end: 1, step: 0.01}
materials: {a: {}}
bodies:
  - {sphere: {radius: 1}, name: a, material: a}
forces:
  - {on: a, force: [1, 0, 0], until: 0.5}
)",
                                  "ends.yaml");
  EXPECT_THROW(make_engine("bullet", "default", scene, step), InputError);
  EXPECT_THROW(make_engine("ode", "direct", scene, step), InputError);
}

INSTANTIATE_TEST_SUITE_P(Engines, Peers,
                         testing::Values(Entrant{"bullet", "default"}, Entrant{"bullet", "tuned"},
                                         Entrant{"bullet", "no-erp"}, Entrant{"ode", "quick-10"},
                                         Entrant{"ode", "direct"}, Entrant{"ode", "direct-slip"},
                                         Entrant{"scree", "default"}),
                         name_of);

TEST(Judge, SeesEnergyPenetrationAndTravelOfAStateMadeByHand) {
  Scene scene = parse_scene(R"(
format: 1
gravity: [0, 0, -10]
time: {end: 1, step: 0.01}
materials: {a: {density: 1}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {sphere: {radius: 0.5}, at: [0, 0, 0.5], mass: 2, material: a}
  - {sphere: {radius: 0.25}, at: [0, 0, 2], mass: 2, material: a}
)",
                            "judge.yaml");
  Judge judge(scene);
  EXPECT_EQ(judge.findings().energy_change, 0);
  BodyTable moved = scene.bodies;
  moved.position[1].z() = 0.4;            // 0.1 deep in the plane
  moved.position[2] = Vec3(0.3, 0, 0.8);  // 0.5 from the first ball, and so 0.25 deep in it
  moved.velocity[2] = Vec3(0, 3, 0);
  moved.spin[2] = Vec3(0, 0, 4);
  judge.see(moved, 0.5);
  const Findings& f = judge.findings();
  const double angular = 0.5 * (0.4 * 2 * 0.0625) * 16;
  const double kinetic = 0.5 * 2 * 9 + angular;
  EXPECT_NEAR(f.spin_energy, angular, 1e-12);
  EXPECT_NEAR(f.energy_change, kinetic - 20 * 1.3, 1e-12);
  EXPECT_NEAR(f.worst_energy_change, std::abs(f.energy_change), 1e-12);
  EXPECT_NEAR(f.rms_speed, std::sqrt(2 * kinetic / 4), 1e-12);
  EXPECT_NEAR(f.worst_penetration, 0.25, 1e-12);
  EXPECT_NEAR(f.squared_penetration, 0.01 + 0.0625, 1e-12);
  EXPECT_EQ(f.time, 0.5);
  EXPECT_NEAR(f.penetration.relative_max, 1, 1e-12);
  EXPECT_NEAR(f.penetration.relative_mean, (0.2 + 1) / 2, 1e-12);
  EXPECT_EQ(f.newest.position[2], moved.position[2]);
  judge.see(scene.bodies, 1);
  EXPECT_NEAR(judge.findings().worst_drift, 0.3, 1e-12);
  EXPECT_EQ(judge.findings().energy_change, 0);
  EXPECT_EQ(judge.findings().penetration.max, 0);
}

TEST(Errors, AreMeansOfAllStatesOrOfTheNewest) {
  const auto square = [](const Scene&, const Findings& f) { return f.time * f.time; };
  const Case two = {"two", 0, 0, 0, {{"mean", "", square, true}, {"newest", "", square}}};
  const Scene scene;
  Errors errors(two, scene);
  Findings findings;
  for (const double time : {1, 3, 4}) {
    findings.time = time;
    errors.see(findings);
  }
  EXPECT_NEAR(errors.values()[0], 26.0 / 3, 1e-12);
  EXPECT_EQ(errors.values()[1], 16);
}

/// Engines whose friction pyramids hold the bodies in place get the published error, and motion by the
/// formula gets no error.
TEST(Errors, OfTheRollingCaseAreAsPublished) {
  const Case& rolling = find_case("rolling");
  const Scene scene = read_scene(SCREE_SOURCE_DIR "/configs/validation/simbenchmark/rolling.yaml");
  Findings at_rest, moving;
  at_rest.newest = moving.newest = scene.bodies;
  Errors of_rest(rolling, scene), of_motion(rolling, scene);
  for (int k = 0; k < 4000; ++k) {
    at_rest.time = moving.time = 0.001 * k;
    const Vec3 along = moving.time * Vec3(0.5, std::sqrt(0.75), 0);
    moving.newest.velocity[1] = 0.7385 * along;
    moving.newest.velocity[2] = 0.2110 * along;
    of_rest.see(at_rest);
    of_motion.see(moving);
  }
  EXPECT_NEAR(of_rest.values()[0], 3.14497, 1e-5);
  EXPECT_NEAR(of_motion.values()[0], 0, 1e-20);
}

}  // namespace
}  // namespace scree::bench
