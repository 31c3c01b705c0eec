// Tests that a simulation that is saved and loaded goes on with the same bits as one that never stopped.
#include "core/error.hpp"
#include "sim/step/simulation.hpp"
#include "tests/sim/ways.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace scree {
namespace {

class Resume : public WayTest {};

/// Returns the numbers that a row of the metrics could hold, to the bit.
std::string seen(Simulation& run) {
  const Observation& o = run.observe();
  return fmt::format("{:016x} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", run.state_hash(), o.step,
                     o.unexplained, o.energy_scale, o.ledger.friction, o.exchange.energy, o.counters.sweeps,
                     o.counters.pcs_made, o.pairs, o.contacts, o.penetration.mean, o.bodies, o.left,
                     o.emitted, o.regions.empty() ? 0.0 : o.regions.front().flux,
                     o.regions.empty() ? 0.0 : o.regions.back().removed.mass);
}

SavedState saved(Simulation& run) {
  SavedState state;
  Archive archive = Archive::saving(state);
  run.archive(archive);
  return state;
}

/// Saves every `every` steps, and from each state goes on in a new simulation for as many steps and some
/// more. It observes every state, as a run that writes rows does. Sets `contacts` to the largest number of
/// contacts.
template <class Make>
void expect_same_after_resume(const Make& simulate, int every, std::int64_t& contacts) {
  Simulation whole = simulate();
  std::vector<std::string> expected = {seen(whole)};
  std::vector<SavedState> states;
  while (!whole.finished()) {
    if (whole.steps() % every == 0) states.push_back(saved(whole));
    whole.step();
    expected.push_back(seen(whole));
    contacts = std::max(contacts, whole.observe().contacts);
  }
  ASSERT_GT(states.size(), 5u);
  for (const SavedState& state : states) {
    Simulation resumed = simulate();
    resumed.step();  // its own contacts must not be taken for those of the state
    Archive archive = Archive::loading(state);
    resumed.archive(archive);
    EXPECT_EQ(seen(resumed), expected[static_cast<std::size_t>(resumed.steps())]);
    EXPECT_TRUE(resumed.contact_forces().empty()) << "there are no contacts until the next step";
    EXPECT_TRUE(resumed.contact_problem().contacts.empty());
    for (const std::int64_t first = resumed.steps();
         !resumed.finished() && resumed.steps() < first + every + 3;) {
      resumed.step();
      ASSERT_EQ(seen(resumed), expected[static_cast<std::size_t>(resumed.steps())])
          << "saved at step " << first;
    }
  }
}

constexpr const char* common =
    "gravity: [0, 0, -9.81]\n"
    "materials: {stone: {density: 1000, restitution: 0.2, friction: 0.5, rolling_friction: 0.1}}\n";

/// The scene has all shapes, a drum that turns, a gate that goes, a ball that comes, one that leaves the
/// world, an emitter that waits for room, a region that removes bodies, and a force that acts for a time.
TEST_P(Resume, EverythingGoesOnWithTheSameBits) {
  const std::string scene = std::string(common) + R"(
time: {end: 0.5, step: 0.004}
world: {from: [-2, -2, -2], to: [2, 2, 2], leaving: remove}
regions:
  low: {from: [-1, -1, -1], to: [1, 1, -0.3]}
  end: {from: [-1, -1, -0.9], to: [-0.1, 1, -0.75], removes: true}
forces:
  - {on: late, force: [3, 0, 0], torque: [0, 0.1, 0], from: 0.15, until: 0.4}
checks:
  - {measure: drum.force.z, below: 1.0e+9}
bodies:
  - {plane: {normal: [0, 0, 1], offset: -1.5}, material: stone}
  - {tube: {radius: 1, length: 1}, name: drum, at: [0, 0, 0], rotate: {axis: [1, 0, 0], degrees: 90}, motion: {spin: [0, 1, 0]}, material: stone}
  - {box: {size: [0.6, 0.6, 0.1]}, at: [0, 0, -0.2], fixed: true, until: 0.2, material: stone}
  - {sphere: {radius: 0.1}, name: late, at: [0, 0, 0.6], from: 0.1, material: stone}
  - {sphere: {radius: 0.1}, at: [1.8, 1.8, 0], velocity: [1, 0, 0], material: stone}
  - {sphere: {radius: {uniform: [0.03, 0.05]}}, emit: {count: 60, rate: 200, from: [0.3, -0.2, 0.1], to: [0.4, 0.2, 0.2]}, material: stone}
  - sphere: {radius: {uniform: [0.05, 0.08]}}
    at: [-0.3, -0.3, 0]
    repeat: {count: [3, 3, 3], spacing: [0.2, 0.2, 0.2], jitter: 0.01}
    material: stone
  - box: {size: [0.12, 0.1, 0.08]}
    at: [-0.2, -0.2, -0.6]
    repeat: {count: [3, 3, 1], spacing: [0.2, 0.2, 0.2]}
    material: stone)";
  std::int64_t contacts = 0;
  expect_same_after_resume([&] { return simulate(scene); }, 9, contacts);
  EXPECT_GT(contacts, 15);
}

/// There are so many balls that the number of sweeps follows the residual of the last substeps, and that of
/// the substeps follows the overlaps.
TEST_P(Resume, AHeapGoesOnWithTheSameBits) {
  if (std::string(GetParam().name) == "host_accurate") GTEST_SKIP() << "a heap is not for the accurate mode";
  const std::string scene = std::string(common) + R"(
time: {end: 0.2, step: 0.004166666666666667}
bodies:
  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone}
  - {plane: {normal: [1, 0, 0], offset: -0.5}, material: stone}
  - {plane: {normal: [-1, 0, 0], offset: -0.5}, material: stone}
  - {plane: {normal: [0, 1, 0], offset: -0.5}, material: stone}
  - {plane: {normal: [0, -1, 0], offset: -0.5}, material: stone}
  - {sphere: {radius: 0.3}, at: [0, 0, 1.55], velocity: [0, 0, -6], material: stone}
  - sphere: {radius: 0.05}
    at: [-0.45, -0.45, 0.05]
    repeat: {count: [10, 10, 10], spacing: [0.1, 0.1, 0.1]}
    material: stone)";
  std::int64_t contacts = 0;
  expect_same_after_resume([&] { return simulate(scene); }, 9, contacts);
  EXPECT_GT(contacts, 2500) << "a heap, in is_heap()'s words";
}

/// A floor shakes, a paddle goes from place to place, and a wall holds a force, while gravity turns.
TEST_P(Resume, WhatIsInMotionGoesOnWithTheSameBits) {
  const std::string scene = R"(
gravity: {vector: [0, 0, -9.81], spin: [0, 0.5, 0.1]}
materials: {stone: {density: 1000, restitution: 0.2, friction: 0.5}}
time: {end: 0.5, step: 0.004, substeps: 2}
bodies:
  - {plane: {normal: [1, 0, 0], offset: -0.5}, material: stone}
  - {plane: {normal: [-1, 0, 0], offset: -0.5}, material: stone}
  - {plane: {normal: [0, 1, 0], offset: -0.5}, material: stone}
  - {plane: {normal: [0, -1, 0], offset: -0.5}, material: stone}
  - {box: {size: [1.2, 1.2, 0.2]}, motion: {oscillate: {displacement: [0, 0, 0.01], angle: [0.05, 0, 0], frequency: 5, phase: 1}}, material: stone}
  - {box: {size: [0.3, 0.1, 0.1]}, from: 0.1, motion: {keyframes: [{at: 0, position: [0, 0, 0.4], rotate: {axis: [0, 0, 1], degrees: 10}}, {at: 0.2, position: [0.2, 0, 0.3], rotate: {axis: [0, 1, 1], degrees: 50}}]}, material: stone}
  - sphere: {radius: {uniform: [0.05, 0.08]}}
    at: [-0.3, -0.3, 0.2]
    repeat: {count: [3, 3, 2], spacing: [0.2, 0.2, 0.2], jitter: 0.01}
    material: stone
)";
  const bool servos = std::string(GetParam().settings).find("mixed") == std::string::npos;
  const std::string wall =
      "  - {box: {size: [0.9, 0.9, 0.1]}, at: [0, 0, 0.7], servo: {axis: [0, 0, -1], force: 300}, material: "
      "stone}";
  std::int64_t contacts = 0;
  expect_same_after_resume([&] { return simulate(scene + (servos ? wall : "")); }, 9, contacts);
  EXPECT_GT(contacts, 15);
}

/// Bodies lie across the ends of the cell and go through them; some start in other images.
TEST_P(Resume, APeriodicSpaceGoesOnWithTheSameBits) {
  const std::string scene = std::string(common) + R"(
time: {end: 0.35, step: 0.005}
periodic: {x: [0, 1], y: [0, 1]}
regions:
  end: {from: [0.8, 0, 0], to: [1.2, 1, 1]}
bodies:
  - {plane: {normal: [0, 0, 1]}, material: stone}
  - {box: {size: 0.2}, at: [1, 0.5, 0.05], fixed: true, material: stone}
  - {box: {size: [0.2, 0.1, 0.1]}, at: [0, 0, 0.3], motion: {velocity: [2, 0, 0], spin: [0, 0, 3]}, material: stone}
  - {sphere: {radius: 0.05}, emit: {count: 8, rate: 40, from: [0.9, 0, 0.6], to: [1.1, 1, 0.9]}, material: stone}
  - sphere: {radius: {uniform: [0.05, 0.08]}}
    at: [-4.9, 3.1, 0.1]
    repeat: {count: [5, 4, 1], spacing: [0.2, 0.25, 0.2], jitter: 0.01}
    velocity: [3, 1, 0]
    material: stone
  - box: {size: [0.12, 0.1, 0.08]}
    at: [0, 0, 0.2]
    repeat: {count: [3, 2, 1], spacing: [0.3, 0.5, 0.2]}
    velocity: [-2, 1, -1]
    material: stone)";
  std::int64_t contacts = 0;
  expect_same_after_resume([&] { return simulate(scene); }, 9, contacts);
  EXPECT_GT(contacts, 15);
}

/// Removes the last row of a field.
void shorten(SavedField& field) { field.bytes.resize(field.bytes.size() - field.type.row()); }

TEST_P(Resume, AStateOfAnotherKindIsRefused) {
  const std::string scene = std::string(common) + R"(
time: {end: 1, step: 0.01}
bodies:
  - {sphere: {radius: 0.1}, at: [0, 0, 1], material: stone})";
  // A simulation that has refused a state cannot go on, so each case has its own.
  for (const char* name : {"stepper/bodies/position", "stepper/bodies/id", "stepper/velocity_before"}) {
    Simulation run = simulate(scene);
    SavedState state = saved(run);
    shorten(*std::ranges::find(state.fields, name, &SavedField::name));
    Archive archive = Archive::loading(state);
    EXPECT_THROW(run.archive(archive), InputError) << name;
  }
  Simulation run = simulate(scene);
  SavedState state = saved(run);
  std::erase_if(state.fields, [](const SavedField& field) { return field.name == "stepper/last_substep"; });
  Archive archive = Archive::loading(state);
  EXPECT_THROW(run.archive(archive), InputError);
}

INSTANTIATE_TEST_SUITE_P(Ways, Resume, testing::ValuesIn(all_ways()), way_name);

}  // namespace
}  // namespace scree
