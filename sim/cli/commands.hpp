// The commands of the program: functions that take plain arguments and return the exit status. They throw
// InputError and RunError.
#pragma once

#include "render/renderer.hpp"
#include "sim/record/exports.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/variations.hpp"
#include "sim/step/simulation.hpp"

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
  std::optional<double> until;      ///< s
  std::optional<double> max_hours;  ///< wall time after which the run stops (h)
  bool draw = true;
  render::ContextChoice context = render::ContextChoice::automatic;
  bool overwrite = false;
  bool resume = false;
  std::filesystem::path reproduce;  ///< manifest of the run to repeat; empty: none
};
int run(const RunArguments& arguments);

/// Repeats the run of a manifest, writes nothing, and compares the states; run() calls it.
int reproduce(const RunArguments& arguments);

struct CompareArguments {
  std::filesystem::path first, second;  ///< run folders
  double tolerance = 0;                 ///< tolerance relative to the largest magnitude in a column
  double absolute = 0;                  ///< tolerance in the unit of each column
};
int compare(const CompareArguments& arguments);

struct ExportArguments {
  std::filesystem::path run;  ///< run folder
  ExportFormat format = ExportFormat::vtp;
  std::filesystem::path output;  ///< empty: the run folder's name and the format's
};
int export_trajectory(const ExportArguments& arguments);

/// Makes the report.html of a run folder again.
int report(const std::filesystem::path& run);

struct RenderArguments {
  std::filesystem::path run;     ///< run folder
  std::filesystem::path output;  ///< empty: the run folder's name and -render
  std::vector<Override> overrides;
  render::ContextChoice context = render::ContextChoice::automatic;
  int jobs = 0;  ///< number of processes; 0: as many as suit the machine
  bool overwrite = false;
};
int render_again(const RenderArguments& arguments);

struct VerifyArguments {
  std::vector<std::filesystem::path> paths;
  std::vector<Override> overrides;
  std::vector<Variation> variations;  ///< settings to vary: each scene runs with every combination
  SimulationOptions simulation;       ///< options of each run
  std::filesystem::path json;         ///< file for the table; empty: none
  std::string label;                  ///< only scenes with this label; empty: all but the long ones
  bool all = false;                   ///< whether scenes of every label run
};
int verify(const VerifyArguments& arguments);

struct StudyArguments {
  std::filesystem::path scene;
  std::filesystem::path output;  ///< empty: output/NAME-study
  std::vector<Override> overrides;
  std::vector<Variation> variations;
  SimulationOptions simulation;  ///< options of each run
  int repeats = 3;               ///< number of runs of each timing
  bool overwrite = false;
};
int study(const StudyArguments& arguments);

struct PlanArguments {
  std::filesystem::path scene;
  std::vector<Override> overrides;
};
int plan(const PlanArguments& arguments);
/// Prints the JSON Schema, or the reference page, of the scene language.
int print_schema();
int print_reference();

struct NewArguments {
  std::filesystem::path name;  ///< name of the scene file, with or without .yaml; empty: list the templates
  std::string from;            ///< name of a template; empty: that of the scene
};
/// Writes a scene to start from. Throws InputError if the file exists.
int write_new_scene(const NewArguments& arguments);
std::vector<std::string> template_names();

/// Replaces this process by a benchmark; `arguments` are its name and its own arguments. Returns only if it
/// starts none: without arguments it lists the benchmarks.
int bench(const std::vector<std::string>& arguments);
std::vector<std::string> benchmark_names();

int info();

}  // namespace scree::cli
