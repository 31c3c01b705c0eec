// Scenes written in a test and their simulations, without pictures, on one thread.
#pragma once

#include "sim/step/simulation.hpp"

#include <string>

namespace scree {

inline Scene scene_of(const std::string& text) {
  return parse_scene("format: 1\nrender: false\n" + text, "test.yaml");
}

inline constexpr SimulationOptions one_thread{SpaceChoice::host, 1};

inline Simulation simulation_of(const std::string& text) { return Simulation(scene_of(text), one_thread); }

/// Returns why the machine cannot run with these options; empty if it can.
inline std::string why_not(const SimulationOptions& options) {
  const DeviceInfo device = device_info();
  return options.space == SpaceChoice::cuda && !device.available ? "no GPU: " + device.name : "";
}

inline void run_to_end(Simulation& simulation) {
  while (!simulation.finished()) simulation.step();
}

}  // namespace scree
