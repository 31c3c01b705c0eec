#include "sim/cli/trial.hpp"

#include "sim/cli/recorder.hpp"

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

}  // namespace

std::vector<CheckResult> run_checks(const Scene& scene, const std::vector<Override>& overrides,
                                    const SimulationOptions& options) {
  if (scene.seeds == 1) return run_once(scene, options);
  std::vector<std::vector<CheckResult>> runs;
  for (int k = 0; k < scene.seeds; ++k) {
    std::vector<Override> of_seed = overrides;
    of_seed.push_back({"seed", std::to_string(scene.seed + static_cast<std::uint64_t>(k))});
    runs.push_back(run_once(read_scene(scene.source, of_seed), options));
  }
  return pooled(scene.checks, runs);
}

double time_steps(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  const auto start = std::chrono::steady_clock::now();
  while (!simulation.finished()) simulation.step();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace scree::cli
