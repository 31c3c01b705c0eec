#include "sim/cli/trial.hpp"

#include "core/error.hpp"
#include "sim/cli/recorder.hpp"

#include <fmt/format.h>

#include <chrono>

namespace scree::cli {

namespace {

std::vector<CheckResult> run_once(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  Checks checks(scene, TimeGrid(scene.time));
  const Probe probe = probe_of(simulation);
  checks.record(0, probe);
  while (!simulation.finished()) {
    simulation.step();
    checks.record(simulation.steps(), probe);
  }
  return checks.results(simulation.observe(false).energy_scale);
}

/// Reads the scene with its seed number k, counted from 0. Throws as read_scene(), with the seed in the text.
Scene read_seed(const Scene& scene, std::vector<Override> overrides, int k) {
  const std::string seed = std::to_string(scene.seed + static_cast<std::uint64_t>(k));
  overrides.push_back({"seed", seed});
  try {
    return read_scene(scene.source, overrides);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} (with seed {})", error.what(), seed));
  }
}

}  // namespace

void check_seeds(const Scene& scene, const std::vector<Override>& overrides) {
  for (int k = 1; k < scene.seeds; ++k) read_seed(scene, overrides, k);
}

std::vector<CheckResult> run_checks(const Scene& scene, const std::vector<Override>& overrides,
                                    const SimulationOptions& options) {
  if (scene.seeds == 1) return run_once(scene, options);
  // The seeds are checked before the first run, which may take long.
  check_seeds(scene, overrides);
  std::vector<std::vector<CheckResult>> runs;
  for (int k = 0; k < scene.seeds; ++k) runs.push_back(run_once(read_seed(scene, overrides, k), options));
  return pooled(scene.checks, runs);
}

double time_steps(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  const auto start = std::chrono::steady_clock::now();
  while (!simulation.finished()) simulation.step();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace scree::cli
