#include "sim/cli/trial.hpp"

#include "sim/cli/recorder.hpp"

#include <chrono>

namespace scree::cli {

std::vector<CheckResult> run_checks(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  Checks checks(scene, TimeGrid(scene.time));
  const Probe probe = probe_of(simulation);
  checks.record(0, probe);
  while (!simulation.finished()) {
    simulation.step();
    checks.record(simulation.steps(), probe);
  }
  return checks.results(simulation.observe().energy_scale);
}

double time_steps(const Scene& scene, const SimulationOptions& options) {
  Simulation simulation(scene, options);
  const auto start = std::chrono::steady_clock::now();
  while (!simulation.finished()) simulation.step();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace scree::cli
