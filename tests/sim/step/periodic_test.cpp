// Tests of periodic spaces, in each way to take a step: the events in them do not depend on where the cell
// ends.
#include "core/error.hpp"
#include "core/rng.hpp"
#include "narrowphase/pair_contacts.hpp"
#include "sim/step/step_failure.hpp"
#include "tests/sim/ways.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace scree {
namespace {

class Periodic : public WayTest {};

BodyTable state_of(const Simulation& run) {
  Snapshot snapshot;
  run.snapshot(snapshot);
  return snapshot.bodies;
}

constexpr const char* elastic = "materials: {steel: {density: 1000, restitution: 1, friction: 0}}\n";

/// Returns five bodies on a ring of 1 m, 0.1 m apart, of which the first one moves at 1 m/s.
std::string ring_of(const char* shape) {
  return std::string(elastic) + fmt::format(R"(
time: {{end: 1.65, step: 0.0113}}
periodic: {{x: [-0.3, 0.7]}}
bodies:
  - {{{0}, name: first, at: [0, 0, 0], velocity: [1, 0, 0], material: steel}}
  - {{{0}, name: other, at: [0.2, 0, 0], repeat: {{count: [4, 1, 1], spacing: [0.2, 0, 0]}}, material: steel}}
)",
                                            shape);
}

/// The ring without steps: the body that moves meets the next one after the gap between them.
struct Ring {
  double at[5] = {0, 0.2, 0.4, 0.6, 0.8};
  int moving = 0;
  int impacts = 0;

  void go_on(double time) {
    for (;;) {
      const int next = (moving + 1) % 5;
      const double ahead = at[next] - at[moving];
      const double gap = ahead - std::floor(ahead) - 0.1;
      at[moving] += std::min(gap, time);
      if (gap > time) return;
      time -= gap;
      moving = next;
      ++impacts;
    }
  }
};

TEST_P(Periodic, MomentumGoesRoundARing) {
  for (const char* shape : {"sphere: {radius: 0.05}", "box: {size: [0.1, 0.08, 0.06]}"}) {
    Simulation run = simulate(ring_of(shape));
    Ring ring;
    // A box that leans by rounding meets the next one at a slant.
    const double close = is_mixed() ? 1e-6 : 1e-9;
    while (!run.finished()) {
      const double before = run.time();
      run.step();
      ring.go_on(run.time() - before);
      for (int k = 0; k < 5; ++k) {
        ASSERT_NEAR(run.body(k).velocity.x(), ring.moving == k ? 1 : 0, close)
            << shape << " at " << run.time();
        ASSERT_NEAR(run.body(k).position.x(), ring.at[k], 2 * close) << shape << " at " << run.time();
      }
    }
    EXPECT_EQ(run.observe().counters.impacts, ring.impacts);
    EXPECT_LT(run.observe().unexplained, is_mixed() ? 1e-6 : 1e-12);
  }
}

TEST_P(Periodic, ABodyAloneCrossesAsIfThereWereNoEnds) {
  const std::string scene = std::string(elastic) + R"(
time: {end: 2, step: 0.01}
gravity: [0.3, 0.1, 0]
bodies:
  - {box: {size: [0.1, 0.2, 0.15]}, name: box, at: [0.4, 0.4, 0.4], velocity: [1.3, -0.7, 2], spin: [3, 2, 1], material: steel}
)";
  Simulation alone = simulate(scene);
  Simulation crossing = simulate(scene + "periodic: {x: [0, 1], y: [0, 1], z: [0, 1]}\n");
  while (!alone.finished()) {
    alone.step();
    crossing.step();
    ASSERT_EQ(crossing.state_hash(), alone.state_hash()) << alone.time();
  }
  EXPECT_GT(crossing.body(0).position.z(), 4) << "it counts on";
  EXPECT_EQ(crossing.observe().total(), alone.observe().total());
}

/// Returns a crowd of balls and boxes that falls on a floor. Each body is moved by `shift`, and with `images`
/// by a random number of whole periods along x and y. Each `seed` gives another crowd.
std::string crowd(const Vec3& shift, bool images, int copies = 1, std::uint64_t seed = 11) {
  std::string bodies;
  for (int copy = 0; copy < copies; ++copy) {
    for (int k = 0; k < 60; ++k) {
      Random random(seed, static_cast<std::uint64_t>(k));
      const int column = k % 9, layer = k / 9;
      Vec3 at(column % 3 * 0.33 + 0.16, column / 3 * 0.33 + 0.16, 0.2 + 0.24 * layer);
      for (int a = 0; a < 2; ++a) at[a] += random.uniform(-0.05, 0.05);
      const Vec3 v(random.uniform(-1, 1) + 0.7, random.uniform(-1, 1), 0);
      at += shift;
      at.x() += copy;
      if (images) {
        at.x() += copies * std::floor(random.uniform(-3, 4));
        at.y() += std::floor(random.uniform(-3, 4));
      }
      bodies += fmt::format("  - {{{}, at: [{}, {}, {}], velocity: [{}, {}, 0], material: stone}}\n",
                            k % 4 == 1 ? "box: {size: [0.16, 0.13, 0.1]}" : "sphere: {radius: 0.08}", at.x(),
                            at.y(), at.z(), v.x(), v.y());
    }
    bodies += fmt::format("  - {{box: {{size: 0.2}}, at: [{}, {}, 0.05], fixed: true, material: stone}}\n",
                          0.02 + shift.x() + copy, 0.5 + shift.y());
  }
  return fmt::format(
             "time: {{end: 0.3, step: 0.005}}\ngravity: [0, 0, -9.81]\n"
             "materials: {{stone: {{density: 1000, restitution: 0.3, friction: 0.4}}}}\n"
             "periodic: {{x: [{0}, {1}], y: [0, 1]}}\nbodies:\n",
             copies == 1 ? 0.0 : -0.25, copies == 1 ? 1.0 : -0.25 + copies) +
         bodies + "  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone}\n";
}

/// Returns the number of pairs in contact whose bodies are in different images.
std::int64_t in_other_images(Simulation& run) {
  const BodyTable bodies = state_of(run);
  return std::ranges::count_if(run.contact_forces(), [&](const ContactForce& c) {
    const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
    if (bodies.shape[i] == Shape::plane || bodies.shape[j] == Shape::plane) return false;
    return (bodies.position[i] - bodies.position[j]).norm() > 0.5;
  });
}

TEST_P(Periodic, WhereTheCellEndsAndWhichImagesAreGivenDoesNotMatter) {
  const Vec3 shift(0.375, 0.75, 0);
  Simulation here = simulate(crowd(Vec3::Zero(), false));
  Simulation there = simulate(crowd(shift, true));
  const BodyTable start_here = state_of(here), start_there = state_of(there);
  std::int64_t through = 0;
  while (!here.finished()) {
    here.step();
    there.step();
    through += in_other_images(there);
    EXPECT_LT(there.observe(false).unexplained, is_mixed() ? 1e-6 : 1e-12);
  }
  EXPECT_GT(through, 80);
  EXPECT_EQ(here.observe().contacts, there.observe().contacts);
  const BodyTable end_here = state_of(here), end_there = state_of(there);
  double largest = 0;
  for (std::size_t k = 0; k < end_here.position.size(); ++k) {
    const Vec3 a = end_here.position[k] - start_here.position[k];
    const Vec3 b = end_there.position[k] - start_there.position[k];
    largest = std::max(largest, (a - b).norm());
  }
  // Rounding differs, and its effect grows with each impact.
  EXPECT_LT(largest, is_mixed() ? 1e-2 : 1e-5);
}

/// Rounding differs, and its effect grows with each impact: of ten crowds on Host, the one that differs most
/// does so by 3e-3, and half of them by less than 1e-7. So the test is of the median of five.
TEST_P(Periodic, TwicePeriodIsTwoCopies) {
  std::vector<double> differences;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Simulation one = simulate(crowd(Vec3::Zero(), false, 1, seed));
    Simulation two = simulate(crowd(Vec3::Zero(), true, 2, seed));
    const BodyTable start_one = state_of(one), start_two = state_of(two);
    run_to_end(one);
    run_to_end(two);
    const BodyTable end_one = state_of(one), end_two = state_of(two);
    double largest = 0;
    for (std::size_t copy = 0; copy < 2; ++copy) {
      for (std::size_t k = 0; k < 61; ++k) {
        const std::size_t other = k + 61 * copy;
        const Vec3 a = end_one.position[k] - start_one.position[k];
        const Vec3 b = end_two.position[other] - start_two.position[other];
        largest = std::max(largest, (a - b).norm());
      }
    }
    differences.push_back(largest);
  }
  std::ranges::sort(differences);
  EXPECT_LT(differences[2], is_mixed() ? 1e-2 : 1e-5);
}

TEST_P(Periodic, AGasKeepsItsMomentumAndEnergy) {
  Simulation run = simulate(std::string(elastic) + R"(
time: {end: 6, step: 0.005}
seed: 3
periodic: {x: [0, 1], y: [-0.5, 0.5], z: [3, 4]}
bodies:
  - {sphere: {radius: {uniform: [0.04, 0.07]}}, scatter: {count: 100, from: [0, -0.5, 3], to: [1, 0.5, 4]}, velocity: [0.3, 0, 0], material: steel}
  - {box: {size: [0.1, 0.08, 0.12]}, scatter: {count: 20, from: [0, -0.5, 3], to: [1, 0.5, 4]}, velocity: [-1, 0.5, 0.2], spin: [1, 2, 3], material: steel}
)");
  const Observation first = run.observe();
  const double speed = first.speed_rms;
  run_to_end(run);
  const Observation& last = run.observe();
  EXPECT_GT(last.counters.impacts, 1000);
  const double mass = first.momentum.norm() / speed;
  EXPECT_LT((last.momentum - first.momentum).norm(), (is_mixed() ? 1e-6 : 1e-11) * mass * speed);
  if (!is_mixed()) {
    EXPECT_NEAR(last.total() / first.total(), 1, 1e-9);
  }
  EXPECT_LT(last.unexplained, is_mixed() ? 1e-5 : 1e-10);
  EXPECT_EQ(last.counters.unfinished_impacts, 0);
}

/// The oracle tests every pair, and each with every image of the other body.
TEST_P(Periodic, OverlapsAreThoseOverAllImages) {
  const std::string text = std::string(elastic) + R"(
time: {end: 1, step: 0.001}
seed: 5
periodic: {x: [0, 1], y: [0, 1.25]}
bodies:
  - {sphere: {radius: {uniform: [0.02, 0.12]}}, at: [0, 0, 0], repeat: {count: [5, 5, 3], spacing: [0.2, 0.25, 0.2], jitter: 0.1}, material: steel}
  - {box: {size: {uniform: [[0.1, 0.1, 0.1], [0.2, 0.15, 0.1]]}}, at: [1.97, -3, 0], rotate: {axis: [1, 2, 3], degrees: 40}, repeat: {count: [1, 6, 3], spacing: [0, 0.21, 0.2], jitter: 0.08}, material: steel}
  - {box: {size: [0.2, 0.1, 0.1]}, at: [7, 0.3, 0.2], fixed: true, material: steel}
)";
  const Simulation run = simulate(text);
  Simulation observed = simulate(text);
  const BodyTable bodies = state_of(run);
  double sum = 0, largest = 0;
  int overlaps = 0, by_images = 0;
  for (std::size_t i = 0; i < bodies.shape.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.shape.size(); ++j) {
      double depth = 0;
      // The images of body i are up to seven periods away from here.
      for (int x = -9; x <= 9; ++x) {
        for (int y = -9; y <= 9; ++y) {
          const Vec3 by(x, 1.25 * y, 0);
          Manifold found[max_pair_manifolds];
          const int count = find_pair_contacts(
              bodies.shape[i], {bodies.position[i], bodies.orientation[i], bodies.size[i]}, bodies.shape[j],
              {bodies.position[j] + by, bodies.orientation[j], bodies.size[j]}, 0.0, found);
          for (int m = 0; m < count; ++m)
            for (int p = 0; p < found[m].count; ++p) depth = std::max(depth, -found[m].points[p].gap);
          if (count > 0 && !by.isZero(0)) ++by_images;
        }
      }
      if (depth <= 0) continue;
      ++overlaps;
      sum += depth;
      largest = std::max(largest, depth);
    }
  }
  ASSERT_GT(overlaps, 50);
  ASSERT_GT(by_images, 25);
  const Penetration& penetration = observed.observe().penetration;
  EXPECT_NEAR(penetration.max, largest, 1e-12);
  EXPECT_NEAR(penetration.mean, sum / overlaps, 1e-12);
}

TEST_P(Periodic, WhatIsTooFastIsTakenInSmallerStepsOrRefused) {
  const auto scene = [](double speed) {
    return std::string(elastic) + fmt::format(R"(
time: {{end: 0.3, step: 0.01}}
periodic: {{x: [0, 1]}}
bodies:
  - {{sphere: {{radius: 0.05}}, at: [0, 0, 0], velocity: [{}, 0, 0], material: steel}}
  - {{sphere: {{radius: 0.05}}, at: [0.5, 0, 0], material: steel}}
)",
                                              speed);
  };
  // The ball goes 0.3 m in a step, and the ball in its way may go as far after the impact.
  Simulation fast = simulate(scene(30));
  run_to_end(fast);
  EXPECT_GT(fast.observe().counters.redone, 0);
  EXPECT_EQ(fast.observe().counters.impacts, 11)
      << "the first after 0.4 m, the others after 0.8 m each, in 9 m";
  EXPECT_NEAR(fast.body(0).velocity.x() + fast.body(1).velocity.x(), 30, 1e-4);
  Simulation too_fast = simulate(scene(3000));
  try {
    too_fast.step();
    FAIL() << "a body goes 30 periods in a step";
  } catch (const StepFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("period"), std::string::npos) << failure.what();
  }
}

TEST_P(Periodic, RegionsAndTheWorldSeeTheCell) {
  Simulation run = simulate(std::string(elastic) + R"(
time: {end: 3, step: 0.01}
periodic: {x: [0, 1]}
world: {from: [0, -1, -1], to: [1, 1, 1], leaving: remove}
regions:
  end: {from: [0.75, -1, -1], to: [1.25, 1, 1]}
bodies:
  - {sphere: {radius: 0.05}, name: ball, at: [0.5, 0, 0], velocity: [1, 0, 0], material: steel}
  - {sphere: {radius: 0.05}, at: [0.5, 0.5, 0], velocity: [1, 0.3, 0], material: steel}
)");
  while (!run.finished()) {
    run.step();
    const double x = run.body(0).position.x() - 0.75;
    const double in = x - std::floor(x);
    if (std::abs(in - 0.5) > 0.01 && std::min(in, 1 - in) > 0.01) {
      EXPECT_EQ(run.observe(false).regions[0].count, (in < 0.5 ? 1 : 0) * run.observe(false).bodies)
          << run.time();
    }
  }
  EXPECT_EQ(run.observe().bodies, 1) << "one left along y, none along x";
  EXPECT_NEAR(run.body(0).position.x(), 3.5, 1e-9);
}

TEST_P(Periodic, ScatteredAndEmittedBodiesKeepClearOfImages) {
  Simulation run = simulate(std::string(elastic) + R"(
time: {end: 1, step: 0.01}
periodic: {x: [0, 1], y: [2, 3]}
bodies:
  - {box: {size: [0.3, 0.1, 0.1]}, at: [4, 2, 0.1], fixed: true, material: steel}
  - {sphere: {radius: {uniform: [0.03, 0.1]}}, scatter: {count: 60, from: [0, 2, 0], to: [1, 3, 0.3]}, material: steel}
  - {sphere: {radius: 0.06}, emit: {count: 20, rate: 1000, from: [0.9, 2, 0.3], to: [1.3, 3, 0.6]}, material: steel}
)");
  run_to_end(run);
  const Observation& o = run.observe();
  EXPECT_GT(o.emitted, 12);
  EXPECT_EQ(o.penetration.max, 0);
  EXPECT_EQ(o.contacts, 0);
  EXPECT_EQ(o.counters.impacts, 0);
}

TEST_P(Periodic, AnyNumberOfThreadsGivesTheSameBits) {
  SimulationOptions options = GetParam().options;
  if (options.space == SpaceChoice::cuda) GTEST_SKIP() << "threads are for the host";
  const Scene scene = scene_of(crowd(Vec3::Zero(), true) + GetParam().settings + "\n");
  Simulation one(scene, options);
  options.threads = 3;
  Simulation three(scene, options);
  for (int step = 0; step < 60; ++step) {
    one.step();
    three.step();
  }
  EXPECT_EQ(one.state_hash(), three.state_hash());
}

// A ball rolls down a chute without an end. Its speed is v = 5/7 g t, with the component of gravity along the
// chute.
TEST_P(Periodic, ABallRollsDownForPeriods) {
  Simulation run = simulate(R"(
materials: {stone: {density: 1000, restitution: 0, friction: 0.9}}
time: {end: 2, step: 0.005}
gravity: [3, 0, -9]
periodic: {x: [0, 1]}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone}
  - {sphere: {radius: 0.1}, at: [0.5, 0, 0.1], material: stone}
)");
  run_to_end(run);
  EXPECT_NEAR(run.body(1).velocity.x(), 5.0 / 7 * 3 * 2, is_mixed() ? 1e-5 : 1e-11);
  EXPECT_NEAR(run.body(1).position.x(), 0.5 + 0.5 * 5.0 / 7 * 3 * 4, is_mixed() ? 1e-5 : 1e-11);
  EXPECT_LT(run.observe().unexplained, is_mixed() ? 1e-6 : 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Ways, Periodic, testing::ValuesIn(all_ways()), way_name);

}  // namespace
}  // namespace scree
