// Tests of regions against a count of every body by hand.
#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

RegionState counted(const Region& region, const BodyTable& bodies, double& mass) {
  RegionState state;
  mass = 0;
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    if (bodies.mobility[k] != Mobility::free) continue;
    bool inside = true;
    for (int c = 0; c < 3; ++c)
      inside = inside && region.from[c] <= bodies.position[k][c] && bodies.position[k][c] <= region.to[c];
    if (!inside) continue;
    ++state.count;
    mass += 1 / bodies.inverse_mass[k];
    const Vec3 s = bodies.size[k];
    state.fraction +=
        (bodies.shape[k] == Shape::sphere ? 4 * pi / 3 * s.x() * s.x() * s.x() : 8 * s.x() * s.y() * s.z()) /
        (region.to - region.from).prod();
  }
  return state;
}

TEST(Region, HoldsWhatACountFindsAndFluxIsTheChangeOfItsMass) {
  const Scene scene = scene_of(R"(
gravity: [0, 0, -10]
materials: {a: {density: 1000}, b: {density: 3000}}
time: {end: 0.5, step: 0.003}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: a}
  - {box: {size: 1}, fixed: true, at: [0, 0, 0.4], material: a}
  - {sphere: {radius: 0.02}, at: [0, 0, 1], repeat: {count: [3, 3, 4], spacing: [0.1, 0.1, 0.1]}, material: a}
  - {box: {size: [0.04, 0.03, 0.02]}, at: [1, 0, 0.3], repeat: {count: [3, 3, 4], spacing: [0.1, 0.1, 0.1]}, material: b}
regions:
  high: {from: [-1, -1, 0.9], to: [2, 1, 1.2]}
  low: {from: [0.95, -1, 0], to: [1.15, 1, 0.1]}
)");
  Simulation simulation(scene, one_thread);
  Snapshot snapshot;
  std::vector<double> before(2);
  std::vector<double> first(2);
  while (true) {
    simulation.snapshot(snapshot);
    const Observation& o = simulation.observe();
    ASSERT_EQ(o.regions.size(), 2u);
    for (std::size_t r = 0; r < 2; ++r) {
      double mass = 0;
      const RegionState expected = counted(scene.regions[r], snapshot.bodies, mass);
      ASSERT_EQ(o.regions[r].count, expected.count);
      ASSERT_NEAR(o.regions[r].fraction, expected.fraction, 1e-14);
      const double flux =
          o.step > 0 ? (mass - before[r]) / (o.step < simulation.steps_total() ? 0.003 : 0.002) : 0;
      // The tolerance is the rounding of masses of some kg, over a step.
      ASSERT_NEAR(o.regions[r].flux, flux, 1e-10) << r << " at " << o.time;
      if (o.step == 0) first[r] = mass;
      before[r] = mass;
    }
    if (simulation.finished()) break;
    simulation.step();
  }
  EXPECT_NE(first[0], before[0]) << "nothing came or went";
  EXPECT_LT(first[1], before[1]) << "nothing fell in";
}

}  // namespace
}  // namespace scree
