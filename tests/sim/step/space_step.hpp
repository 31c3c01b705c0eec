// Tests of the step in both spaces and precisions: a fixture that simulates a scene in each, and parts of
// scenes.
#pragma once

#include "sim/step/simulation.hpp"
#include "tests/sim/step/simulations.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace scree {

/// A space and a precision in which steps are taken: Host always, Device where there is one.
struct Way {
  const char* name;
  SimulationOptions options;
  const char* precision;
};

/// Returns the ways of a test over spaces and precisions.
inline auto every_way() {
  return testing::Values(Way{"host_double", {SpaceChoice::host, 1}, "double"},
                         Way{"host_mixed", {SpaceChoice::host, 1}, "mixed"},
                         Way{"cuda_double", {SpaceChoice::cuda, 0}, "double"},
                         Way{"cuda_mixed", {SpaceChoice::cuda, 0}, "mixed"});
}
inline std::string name_of(const testing::TestParamInfo<Way>& way) { return way.param.name; }

class SpaceStep : public testing::TestWithParam<Way> {
 protected:
  void SetUp() override {
    if (const std::string why = why_not(GetParam().options); !why.empty()) GTEST_SKIP() << why;
  }
  bool is_mixed() const { return std::string(GetParam().precision) == "mixed"; }
  Simulation simulate(const std::string& text, SimulationOptions options) const {
    return Simulation(scene_of(text + "\nprecision: " + GetParam().precision + "\n"), options);
  }
  Simulation simulate(const std::string& text) const { return simulate(text, GetParam().options); }
};

inline constexpr const char* grain = "materials: {stone: {density: 1000, restitution: 0, friction: 0.5}}\n";

/// Returns a floor and walls of stone, `half` from the middle to a wall (m).
inline std::string open_box(double half) {
  std::string planes = "\n  - {plane: {normal: [0, 0, 1], offset: 0}, material: stone}";
  for (const char* normal : {"1, 0", "-1, 0", "0, 1", "0, -1"})
    planes += fmt::format("\n  - {{plane: {{normal: [{}, 0], offset: {}}}, material: stone}}", normal, -half);
  return planes;
}

}  // namespace scree
