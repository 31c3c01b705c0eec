// The commands of the program: plain arguments in, exit status out. They throw InputError and RunError.
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
  std::optional<double> max_hours;  ///< of wall time
  bool draw = true;
  render::ContextChoice context = render::ContextChoice::automatic;
  bool overwrite = false;
  bool resume = false;
  std::filesystem::path reproduce;  ///< a manifest; empty: a run of its own
};
int run(const RunArguments& arguments);

/// The part of run() that runs what a manifest tells of again, writes nothing, and compares the states.
int reproduce(const RunArguments& arguments);

struct CompareArguments {
  std::filesystem::path first, second;  ///< run folders
  double tolerance = 0;                 ///< relative to the largest magnitude in a column
  double absolute = 0;                  ///< in each column's unit: what is no more is no difference
};
int compare(const CompareArguments& arguments);

struct ExportArguments {
  std::filesystem::path run;  ///< run folder
  ExportFormat format = ExportFormat::vtp;
  std::filesystem::path output;  ///< empty: the run folder's name and the format's
};
int export_trajectory(const ExportArguments& arguments);

/// Makes report.html of a run folder again.
int report(const std::filesystem::path& run);

struct RenderArguments {
  std::filesystem::path run;     ///< run folder
  std::filesystem::path output;  ///< empty: the run folder's name and -render
  std::vector<Override> overrides;
  render::ContextChoice context = render::ContextChoice::automatic;
  int jobs = 0;  ///< processes; 0: as many as suit the machine
  bool overwrite = false;
};
int render_again(const RenderArguments& arguments);

struct VerifyArguments {
  std::vector<std::filesystem::path> paths;
  std::vector<Override> overrides;
  std::vector<Variation> variations;  ///< each scene runs with every combination
  SimulationOptions simulation;       ///< of each run
  std::filesystem::path json;         ///< empty: none
  std::string label;                  ///< only scenes with this label; empty: all but the long ones
  bool all = false;                   ///< whatever the label
};
int verify(const VerifyArguments& arguments);

struct StudyArguments {
  std::filesystem::path scene;
  std::filesystem::path output;  ///< empty: output/NAME-study
  std::vector<Override> overrides;
  std::vector<Variation> variations;
  SimulationOptions simulation;  ///< of each run
  int repeats = 3;               ///< of each timing
  bool overwrite = false;
};
int study(const StudyArguments& arguments);

struct PlanArguments {
  std::filesystem::path scene;
  std::vector<Override> overrides;
};
int plan(const PlanArguments& arguments);
/// The JSON Schema, or the reference page, of the scene language.
int print_schema();
int print_reference();

struct NewArguments {
  std::filesystem::path name;  ///< of the scene file, .yaml or not; empty: list the templates
  std::string from;            ///< a template; empty: the one that the scene is named after
};
/// Writes a scene to start from; refuses a file that is there.
int write_new_scene(const NewArguments& arguments);
std::vector<std::string> template_names();

/// A benchmark's name, and what it is given; without any, lists those that there are. Becomes that program:
/// returns only if it starts none.
int bench(const std::vector<std::string>& arguments);
std::vector<std::string> benchmark_names();

int info();

}  // namespace scree::cli
