// Heaps that come to rest and that flow, in both spaces and precisions: the overlaps and sweeps that they
// take.
#include "core/tolerances.hpp"
#include "tests/sim/step/space_step.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

namespace scree {
namespace {

class HeapStep : public SpaceStep {};

/// Returns interleaved layers of spheres of two sizes, each `count` ("x, y, z") times.
std::string layers_of_two_sizes(const std::string& count) {
  return fmt::format(R"(
  - sphere: {{radius: {{uniform: [0.05, 0.06]}}}}
    at: [0.0608, 0.0608, 0.0605]
    repeat: {{count: [{0}], spacing: [0.1206, 0.1206, 0.1428], jitter: 0.0003}}
    material: stone
  - sphere: {{radius: {{uniform: [0.04, 0.05]}}}}
    at: [0.1211, 0.1211, 0.1319]
    repeat: {{count: [{0}], spacing: [0.1206, 0.1206, 0.1428], jitter: 0.0003}}
    material: stone)",
                     count);
}

/// In each way to take a step, the heap has the same centre of mass within what chaos leaves, and hardly any
/// overlap.
TEST_P(HeapStep, AHeapComesToRestAsOnHost) {
  const std::string heap = std::string(grain) + R"(
gravity: [0, 0, -9.81]
time: {end: 1, step: 0.004166666666666667}
bodies:)" + open_box(0.4) +
                           R"(
  - sphere: {radius: {uniform: [0.04, 0.06]}}
    at: [-0.33, -0.33, 0.07]
    repeat: {count: [6, 6, 12], spacing: [0.133, 0.133, 0.133], jitter: 0.005}
    material: stone)";
  Simulation run = simulate(heap);
  run_to_end(run);
  Simulation host = simulation_of(heap);
  run_to_end(host);
  const Observation& seen = run.observe();
  EXPECT_NEAR(seen.centre.z(), host.observe().centre.z(), 0.02);
  EXPECT_LT(seen.penetration.relative_mean, 1e-4);
  EXPECT_LT(seen.penetration.relative_max, 1e-2);
  EXPECT_NEAR(seen.coordination_mean, host.observe().coordination_mean, 0.3);
}

/// The column has 60 layers. With 6 sweeps always (response.iterations: 6) they still overlap by 8e-4 on
/// average, and swing. With the rule for sweeps, four seeds on Host have 8e-5 to 1.5e-4 (a GPU up to 1.6e-4),
/// and by 3.5 s 3e-5 to 9e-5.
TEST_P(HeapStep, ATallColumnComesToRest) {
  if (is_mixed()) GTEST_SKIP() << "sweeps go by the same rule";
  Simulation run = simulate(R"(
gravity: [0, 0, -9.81]
time: {end: 1.8, step: 0.004166666666666667}
materials:
  stone: {density: 1000, restitution: 0.1, friction: 0.5}
  wall: {density: 1000, restitution: 0.1, friction: 0}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone}
  - {plane: {normal: [1, 0, 0], offset: 0}, material: wall}
  - {plane: {normal: [-1, 0, 0], offset: -0.655}, material: wall}
  - {plane: {normal: [0, 1, 0], offset: 0}, material: wall}
  - {plane: {normal: [0, -1, 0], offset: -0.655}, material: wall})" +
                            layers_of_two_sizes("5, 5, 30"));
  run_to_end(run);
  const Observation& seen = run.observe();
  EXPECT_LT(seen.penetration.relative_mean, 3e-4);
  EXPECT_LT(seen.speed_rms, 6e-3);
  EXPECT_LT(std::abs(seen.unexplained), 1e-12);
}

/// A hundred layers fall together on their ground, without walls that would carry them. Where sweeps do not
/// find the impulses while the layers land, these sink in by centimetres.
TEST_P(HeapStep, ADeepHeapDoesNotSinkIn) {
  Simulation run = simulate(R"(
gravity: [0, 0, -9.81]
time: {end: 1, step: 0.004166666666666667}
periodic: {x: [0, 0.4824], y: [0, 0.4824]}
materials: {stone: {density: 1000, restitution: 0.1, friction: 0.5}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone})" +
                            layers_of_two_sizes("4, 4, 50"));
  run_to_end(run);
  const Observation& seen = run.observe();
  EXPECT_LT(seen.penetration.relative_mean, 1e-3);
  EXPECT_LT(seen.penetration.relative_max, 2e-2);
}

/// Balls fall on a heap, which is swept until its impulses have converged. The sweeps have momentum, since
/// plain sweeps would need twice as many.
TEST_P(HeapStep, AFallOntoAHeapTakesFewSweeps) {
  Simulation run = simulate(std::string(grain) + R"(
gravity: [0, 0, -9.81]
time: {end: 0.7, step: 0.004166666666666667}
bodies:)" + open_box(0.4) +
                            R"(
  - sphere: {radius: {uniform: [0.04, 0.06]}}
    at: [-0.3333333, -0.3333333, 0.0666667]
    repeat: {count: [6, 6, 40], spacing: [0.1333333, 0.1333333, 0.1333333], jitter: 0.005}
    material: stone)");
  while (run.time() < 0.6) run.step();
  const Counters before = run.observe(false).counters;
  run_to_end(run);
  const Counters& after = run.observe(false).counters;
  const auto sweeps = static_cast<double>(after.sweeps - before.sweeps);
  EXPECT_LT(sweeps / static_cast<double>(after.substeps - before.substeps), 50);
}

/// Returns a column of 2,560 balls, which collapses as a wall is taken away.
std::string falling_column(double quality) {
  return fmt::format(R"(
gravity: [0, 0, -9.81]
time: {{end: 0.56, step: 0.0020833333333333333}}
response: {{quality: {}}}
materials: {{stone: {{density: 2500, restitution: 0.5, friction: 0.4}}}}
bodies:
  - {{plane: {{normal: [0, 0, 1], offset: 0}}, material: stone}}
  - {{plane: {{normal: [1, 0, 0], offset: 0}}, material: stone}}
  - {{plane: {{normal: [-1, 0, 0], offset: -0.18}}, until: 0.3, material: stone}}
  - {{plane: {{normal: [0, 1, 0], offset: 0}}, material: stone}}
  - {{plane: {{normal: [0, -1, 0], offset: -0.18}}, material: stone}}
  - sphere: {{radius: {{uniform: [0.009, 0.011]}}}}
    at: [0.01125, 0.01125, 0.01125]
    repeat: {{count: [8, 8, 40], spacing: [0.0225, 0.0225, 0.0225], jitter: 0.0002}}
    material: stone)",
                     quality);
}

/// The overlaps that a run leaves from 0.36 s on, at every eighth step, and its counts.
struct LeftInFlow {
  double mean = 0, worst = 0;
  std::int64_t sweeps = 0, substeps = 0;

  explicit LeftInFlow(Simulation run) {
    while (run.time() < 0.36) run.step();
    const Counters before = run.observe(false).counters;
    int looks = 0;
    for (; !run.finished(); ++looks) {
      for (int k = 0; k < 8 && !run.finished(); ++k) run.step();
      const Penetration& seen = run.observe().penetration;
      mean += seen.relative_mean;
      worst = std::max(worst, seen.relative_max);
    }
    mean /= looks;
    const Counters& after = run.observe(false).counters;
    sweeps = after.sweeps - before.sweeps;
    substeps = after.substeps - before.substeps;
  }
};

/// A column whose wall is taken away: it keeps what docs/accuracy.md states of heaps in motion.
TEST_P(HeapStep, WhatFlowsOverlapsLittle) {
  const LeftInFlow left(simulate(falling_column(1)));
  EXPECT_LT(left.mean, tolerance::mean_overlap_left);
  EXPECT_LT(left.worst, tolerance::worst_overlap_left);
  // The number was 18 to 20.2, and 28 where sweeps end at the change of a heap at rest (docs/decisions/0052).
  EXPECT_LT(left.sweeps, 24 * left.substeps);
}

/// One measurement of four may find a deeper overlap than the bound, without more substeps after it.
TEST_P(HeapStep, QualityDividesWhatFlowsOverlaps) {
  const LeftInFlow fine(simulate(falling_column(4))), coarse(simulate(falling_column(0.25)));
  for (const auto& [left, quality] : {std::pair(&fine, 4.0), std::pair(&coarse, 0.25)}) {
    EXPECT_LT(left->mean, 2 * tolerance::mean_overlap_left / quality);
    EXPECT_LT(left->worst, 2 * tolerance::worst_overlap_left / quality);
  }
  EXPECT_LT(2 * fine.mean, coarse.mean);
  // More sweeps come before more substeps, and may be enough.
  EXPECT_LE(coarse.substeps, fine.substeps);
  EXPECT_LT(2 * coarse.sweeps, fine.sweeps);
}

/// Boxes and balls tumble down a slope, a step at a time. Most bodies are struck after the midpoint of some
/// steps, and the response then turns them. Where the gaps at the end of the step were predicted with spins
/// that begin at the blow, 60 of these steps left overlaps of more than a hundredth on Host.
TEST_P(HeapStep, BodiesThatAreStruckLateAreCorrected) {
  Simulation run = simulate(R"(
gravity: [4.905, 0, -8.4957]
time: {end: 0.4, step: 0.0020833333333333333, substeps: 1}
materials: {stone: {density: 2500, restitution: 0.5, friction: 0.4}}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone}
  - {plane: {normal: [1, 0, 0], offset: -0.02}, material: stone}
  - {plane: {normal: [0, 1, 0], offset: -0.106}, material: stone}
  - {plane: {normal: [0, -1, 0], offset: -0.106}, material: stone}
  - box: {size: {uniform: [[0.014, 0.014, 0.014], [0.022, 0.022, 0.022]]}}
    at: [0, -0.091, 0.02]
    repeat: {count: [4, 8, 4], spacing: [0.052, 0.026, 0.026], jitter: 0.001}
    material: stone
  - sphere: {radius: {uniform: [0.008, 0.011]}}
    at: [0.026, -0.091, 0.02]
    repeat: {count: [4, 8, 4], spacing: [0.052, 0.026, 0.026], jitter: 0.001}
    material: stone)");
  int deep = 0;
  while (!run.finished()) {
    run.step();
    deep += run.observe().penetration.relative_max > tolerance::worst_corrected_overlap;
  }
  EXPECT_GT(run.observe().counters.impacts, 1000);
  EXPECT_LT(deep, 10);
}

/// Boxes land layer by layer, a step at a time. Most are struck by the next layer after the midpoint, while
/// the layer below turns them, and many fly past each other beside overlaps that are corrected. On Host 40 of
/// these steps left overlaps of more than a hundredth while only the places of late impacts were kept and
/// bodies that fly past each other had no gap; 13 do now.
TEST_P(HeapStep, BoxesThatLandInLayersOverlapLittle) {
  int deep = 0;
  for (const int seed : {1, 2, 3}) {
    Simulation run = simulate(fmt::format(R"(
seed: {}
gravity: [4.905, 0, -8.4957]
time: {{end: 0.25, step: 0.0020833333333333333, substeps: 1}}
materials: {{stone: {{density: 2500, restitution: 0.5, friction: 0.4}}}}
bodies:
  - {{plane: {{normal: [0, 0, 1], offset: 0}}, material: stone}}
  - {{plane: {{normal: [1, 0, 0], offset: -0.02}}, material: stone}}
  - {{plane: {{normal: [0, 1, 0], offset: -0.106}}, material: stone}}
  - {{plane: {{normal: [0, -1, 0], offset: -0.106}}, material: stone}}
  - box: {{size: {{uniform: [[0.014, 0.014, 0.014], [0.022, 0.022, 0.022]]}}}}
    at: [0, -0.091, 0.02]
    repeat: {{count: [8, 8, 8], spacing: [0.026, 0.026, 0.026], jitter: 0.001}}
    material: stone)",
                                          seed));
    while (!run.finished()) {
      run.step();
      deep += run.observe().penetration.relative_max > tolerance::worst_corrected_overlap;
    }
  }
  EXPECT_LT(deep, 24);
}

INSTANTIATE_TEST_SUITE_P(Ways, HeapStep, every_way(), name_of);

}  // namespace
}  // namespace scree
