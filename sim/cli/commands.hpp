// The commands of the program: plain arguments in, exit status out. They throw InputError and RunError.
#pragma once

#include "sim/scene/scene.hpp"
#include "sim/simulation.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree::cli {

struct RunArguments {
  std::filesystem::path scene;
  std::filesystem::path output;  ///< empty: output/NAME
  std::vector<Override> overrides;
  SimulationOptions simulation;
  std::optional<double> until;  ///< s
  bool draw = true;
  bool overwrite = false;
  bool resume = false;
};
int run(const RunArguments& arguments);

struct VerifyArguments {
  std::vector<std::filesystem::path> paths;
  std::vector<Override> overrides;
  SimulationOptions simulation;  ///< of each scene
  std::filesystem::path json;    ///< empty: none
  std::string label;             ///< only scenes with this label; empty: all but the long ones
  bool all = false;              ///< whatever the label
};
int verify(const VerifyArguments& arguments);

struct PlanArguments {
  std::filesystem::path scene;
  std::vector<Override> overrides;
};
int plan(const PlanArguments& arguments);
/// The JSON Schema, or the reference page, of the scene language.
int print_schema();
int print_reference();

int info();

}  // namespace scree::cli
