// Tests on every scene of the repository, at the start and as it moves: the PCS of the grid, on Host and on
// Device, is that of another method, and the run does not depend on the space that computes it.
#include "core/space.hpp"
#include "core/tolerances.hpp"
#include "sim/bodies/motion.hpp"
#include "sim/pairs/pair_finder.hpp"
#include "sim/step/simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

namespace scree {
namespace {

using PairSet = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// Returns all scenes except those of configs/bench, which take long and have nothing that the others lack.
std::vector<std::filesystem::path> all_scenes() {
  std::vector<std::filesystem::path> scenes;
  const std::filesystem::path configs = std::filesystem::path(SCREE_SOURCE_DIR) / "configs";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(configs)) {
    const bool is_benchmark = entry.path().parent_path().filename() == "bench";
    if (entry.path().extension() == ".yaml" && !is_benchmark) scenes.push_back(entry.path());
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

std::string name_of(const testing::TestParamInfo<std::filesystem::path>& info) {
  // Some scenes in different folders have the same name.
  std::string name = info.param.parent_path().filename().string() + "_" + info.param.stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

PairSet pairs_of(BroadPhaseMethod method, bool on_device, const Snapshot& state, const Scene& scene) {
  Bodies<Host> bodies;
  copy_bodies(bodies, state.bodies);
  Array<double, Host> margin;
  ResponseParameters parameters;
  parameters.gravity = scene.gravity;
  contact_margins(bodies, 2 * scene.time.step, tolerance::contact_slack, parameters, {}, margin);
  const auto finder = make_pair_finder<Host>({.method = method}, on_device, state.bodies.position.front());
  PairSet set;
  for (const Pair& pair : finder->find(bodies, margin, {})) set.emplace_back(pair.i, pair.j);
  std::sort(set.begin(), set.end());
  return set;
}

class ScenePairs : public testing::TestWithParam<std::filesystem::path> {
 protected:
  /// Compares at the start and after each of a few stretches of the run. With many bodies it compares with
  /// sweep and prune. Brute force takes their number squared, and nearly so does a uniform grid where sizes
  /// differ much, since its cells are as wide as the largest body.
  void compare(bool on_device) {
    const Scene scene = read_scene(GetParam());
    const bool many = scene.bodies.count() > 10000;
    const BroadPhaseMethod oracle = many ? BroadPhaseMethod::sweep_and_prune : BroadPhaseMethod::brute_force;
    Simulation simulation(scene, {on_device ? SpaceChoice::cuda : SpaceChoice::host, 0});
    Snapshot state;
    const std::int64_t bodies = scene.bodies.count();
    const std::int64_t stretch = many ? 3 : bodies > 1000 ? 10 : bodies > 100 ? 25 : 200;
    for (int k = 0; k < 4; ++k) {
      simulation.snapshot(state);
      ASSERT_EQ(pairs_of(BroadPhaseMethod::hierarchical_grid, on_device, state, scene),
                pairs_of(oracle, on_device, state, scene))
          << "at t = " << simulation.time();
      for (std::int64_t s = 0; s < stretch && !simulation.finished(); ++s) simulation.step();
    }
    if (!on_device) return;
    Simulation again(scene, {SpaceChoice::cuda, 0});
    while (again.steps() < simulation.steps()) again.step();
    EXPECT_EQ(again.state_hash(), simulation.state_hash());
  }
};

TEST_P(ScenePairs, OnHostAreThoseOfTheOracle) { compare(false); }

TEST_P(ScenePairs, OnDeviceAreThoseOfTheOracleAndTheStepsRepeat) {
  const DeviceInfo device = device_info();
  if (!device.available) GTEST_SKIP() << "no GPU: " << device.name;
  compare(true);
}

INSTANTIATE_TEST_SUITE_P(AllScenes, ScenePairs, testing::ValuesIn(all_scenes()), name_of);

}  // namespace
}  // namespace scree
