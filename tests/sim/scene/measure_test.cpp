// Tests of the grammar of measures, and that each measure has the value that its name says.
#include "sim/scene/measure.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace scree {
namespace {

Scene named_scene() {
  Scene scene;
  scene.body_names = {{"puck", 4}, {"bed[0]", 7}, {"bed[12]", 19}};
  scene.regions = {{.name = "entry"}, {.name = "exit"}};
  scene.bodies.position.resize(22, Vec3(20, 2, 3));
  scene.meshes = {{.name = "floor", .file = {}, .bodies = {20, 2}, .place = {20, 2, 3}, .report = {}}};
  return scene;
}
const Scene names = named_scene();

/// Returns an observation in which every quantity is a different number, so that no two measures can be
/// confused.
Observation numbered() {
  Observation o;
  o.kinetic_linear = 1;
  o.kinetic_angular = 2;
  o.potential = 4;
  o.ledger = {8, 16, 32, 64, 128, Vec3::Zero()};
  o.exchange.energy = 130;
  o.unexplained = 256;
  o.momentum = {3, 4, 12};
  o.angular_momentum = {30, 40, 120};
  o.penetration = {512, 513, 514, 515, 516};
  o.gap_mean = 517;
  o.contacts = 518;
  o.pairs = 519;
  o.bodies = 520;
  o.speed_max = 521;
  o.speed_rms = 522;
  o.speed_kurtosis = 530;
  o.counters.impacts = 531;
  o.counters.redone = 540;
  o.left = 541;
  o.counters.unconverged = 542;
  o.counters.unfinished_impacts = 543;
  o.counters.long_direct_failed = 544;
  o.counters.narrowphase.ccd_stopped = 545;
  o.centre = {2, 3, 6};
  o.coordination_mean = 523;
  o.requested = 546;
  o.emitted = 547;
  o.regions = {{524, 525, 526, {548, 549}}, {527, 528, 529, {550, 551}}};
  return o;
}

BodyState state_of(std::int32_t body) {
  BodyState state;
  state.position = {1.0 * body, 2, 3};
  state.velocity = {4, 5, 6};
  state.spin = {7, 8, 9};
  state.acceleration = {10, 11, 12};
  state.force = {6, 8, 24};
  state.torque = {100, 0, 0};
  state.start_orientation = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  state.orientation = Quat(Eigen::AngleAxisd(0.3 + 1e-9, Vec3::UnitX()));
  return state;
}

double value(const char* text) { return evaluate(parse_measure(text, names), numbered(), state_of); }

TEST(Measure, EachNameHasItsValue) {
  const std::map<const char*, double> expected{
      {"energy.total", 7},
      {"energy.kinetic", 3},
      {"energy.linear", 1},
      {"energy.angular", 2},
      {"energy.potential", 4},
      {"energy.unexplained", 256},
      {"energy.work", 64},
      {"energy.integration", 128},
      {"energy.exchange", 130},
      {"energy.dissipated.restitution", 8},
      {"energy.dissipated.friction", 16},
      {"energy.dissipated.correction", 32},
      {"momentum.x", 3},
      {"momentum.y", 4},
      {"momentum.z", 12},
      {"momentum.norm", 13},
      {"angular_momentum.z", 120},
      {"angular_momentum.norm", 130},
      {"penetration.max", 512},
      {"penetration.mean", 513},
      {"penetration.p99", 514},
      {"penetration.relative_max", 515},
      {"penetration.relative_mean", 516},
      {"gap.mean", 517},
      {"contacts.count", 518},
      {"pairs.count", 519},
      {"bodies.count", 520},
      {"speed.max", 521},
      {"speed.rms", 522},
      {"speed.kurtosis", 530},
      {"impacts.count", 531},
      {"guards.redone", 540},
      {"guards.left", 541},
      {"guards.sweeps", 542},
      {"guards.impacts", 543},
      {"guards.newton", 544},
      {"guards.gjk", 545},
      {"emission.requested", 546},
      {"emission.emitted", 547},
      {"centre.y", 3},
      {"centre.norm", 7},
      {"coordination.mean", 523},
      {"region.entry.count", 524},
      {"region.exit.count", 527},
      {"region.entry.fraction", 525},
      {"region.exit.flux", 529},
      {"region.entry.removed", 548},
      {"region.exit.removed_mass", 551},
      {"puck.position.x", 4},
      {"bed[0].position.x", 7},
      {"bed[12].position.x", 19},
      {"puck.velocity.y", 5},
      {"puck.spin.z", 9},
      {"puck.acceleration.x", 10},
      {"puck.force.norm", 26},
      {"floor.force.x", 12},
      {"floor.force.norm", 52},
      // The second triangle is 1 m from the place of the mesh, along x.
      {"floor.torque.x", 200},
      {"floor.torque.y", -24},
      {"floor.torque.z", 8},
  };
  std::set<const MeasureInfo*> seen{parse_measure("puck.tilt", names).info};
  for (const auto& [name, worth] : expected) {
    EXPECT_EQ(value(name), worth) << name;
    seen.insert(parse_measure(name, names).info);
  }
  EXPECT_EQ(seen.size(), measure_table().size());
}

TEST(Measure, TiltIsExactForSmallAngles) { EXPECT_NEAR(value("puck.tilt"), 1e-9, 1e-16); }

TEST(Measure, UnknownContactsAreNoNumber) {
  Observation unknown = numbered();
  unknown.contacts = -1;
  const auto none = [](std::int32_t) -> BodyState { throw std::logic_error("asked for a body"); };
  EXPECT_TRUE(std::isnan(evaluate(parse_measure("contacts.count", Scene{}), unknown, none)));
}

TEST(Measure, OfTheRunAsksForNoBody) {
  const auto none = [](std::int32_t) -> BodyState { throw std::logic_error("asked for a body"); };
  EXPECT_EQ(evaluate(parse_measure("energy.total", Scene{}), numbered(), none), 7);
  EXPECT_EQ(parse_measure("energy.total", Scene{}).body, -1);
}

TEST(Measure, UnknownNamesAreErrors) {
  const auto message = [](const char* text) {
    try {
      parse_measure(text, names);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message("flor.force.x"),
            "flor.force.x is no measure: there is no body called flor (did you mean floor?)");
  EXPECT_EQ(message("pucks.tilt"),
            "pucks.tilt is no measure: there is no body called pucks (did you mean puck?)");
  EXPECT_EQ(message("enrgy.total"),
            "enrgy.total is no measure: there is no body called enrgy (did you mean energy?)");
  EXPECT_EQ(message("energy"),
            "energy is no measure: energy is unknown (scree plan --reference lists all measures)");
  EXPECT_EQ(message("puck"), "puck is no measure: it says nothing about puck, such as .position.z");
  EXPECT_EQ(message("puck.positon.z"),
            "puck.positon.z is no measure: positon.z is unknown (did you mean position?)");
  EXPECT_EQ(message("puck.position.w"), "puck.position.w is no measure: position needs .x, .y, .z or .norm");
  EXPECT_EQ(message("momentum"), "momentum is no measure: momentum needs .x, .y, .z or .norm");
  EXPECT_EQ(message("region.exti.flux"),
            "region.exti.flux is no measure: there is no region called exti (did you mean exit?)");
  EXPECT_EQ(message("region.exit"), "region.exit is no measure: it says nothing about exit, such as .count");
  EXPECT_EQ(message("region.exit.flow"),
            "region.exit.flow is no measure: flow is unknown (did you mean flux?)");
  for (const char* text :
       {"", ".", "puck.", ".x", "puck.tilt.x", "energy.total.x", "momentum.x.y", "bed.tilt"})
    EXPECT_NE(message(text), "no error") << text;
}

}  // namespace
}  // namespace scree
