// The ways to take a step, for tests that hold in each of them: the space, the mode and the precision.
#pragma once

#include "tests/sim/step/simulations.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace scree {

struct Way {
  const char* name;
  SimulationOptions options;
  const char* settings;  ///< lines to add to the scene
};

class WayTest : public testing::TestWithParam<Way> {
 protected:
  void SetUp() override {
    if (const std::string why = why_not(GetParam().options); !why.empty()) GTEST_SKIP() << why;
  }
  bool is_mixed() const { return std::string(GetParam().settings) == "precision: mixed"; }
  Simulation simulate(const std::string& text) const {
    return Simulation(scene_of(text + "\n" + GetParam().settings + "\n"), GetParam().options);
  }
};

inline std::string way_name(const testing::TestParamInfo<Way>& way) { return way.param.name; }

inline std::vector<Way> double_ways() {
  return {{"host", {SpaceChoice::host, 1}, "precision: double"},
          {"host_accurate", {SpaceChoice::host, 1}, "response: {mode: accurate}"},
          {"host_threads", {SpaceChoice::host, 2}, "precision: double"},
          {"cuda", {SpaceChoice::cuda}, "precision: double"},
          {"cuda_accurate", {SpaceChoice::cuda}, "response: {mode: accurate}"}};
}

inline std::vector<Way> all_ways() {
  std::vector<Way> ways = double_ways();
  ways.push_back({"host_mixed", {SpaceChoice::host, 1}, "precision: mixed"});
  ways.push_back({"cuda_mixed", {SpaceChoice::cuda}, "precision: mixed"});
  return ways;
}

}  // namespace scree
