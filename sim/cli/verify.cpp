// scree verify: every scene that has checks, several at once; the table of what was measured and what was
// expected.
#include "core/error.hpp"
#include "sim/cli/check_table.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/process_pool.hpp"
#include "sim/cli/recorder.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/files.hpp"
#include "sim/record/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace scree::cli {

namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& file) { return file.extension() == ".yaml" || file.extension() == ".yml"; }

/// The scene files under the paths, each once, sorted within each path so that the table does not depend on
/// the disk.
std::vector<fs::path> scenes_under(const std::vector<fs::path>& paths) {
  std::vector<fs::path> scenes;
  const auto add = [&scenes](const fs::path& file) {
    if (std::ranges::find(scenes, file) == scenes.end()) scenes.push_back(file);
  };
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) throw InputError(fmt::format("{}: no such file or folder", path.string()));
    if (!fs::is_directory(path)) {
      add(path);
      continue;
    }
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      if (entry.is_regular_file() && is_scene(entry.path())) found.push_back(entry.path());
    }
    if (found.empty()) throw InputError(fmt::format("{}: no scenes (.yaml) in this folder", path.string()));
    std::ranges::sort(found);
    std::ranges::for_each(found, add);
  }
  return scenes;
}

std::string reason_to_leave_out(const Scene& scene, const VerifyArguments& arguments) {
  if (scene.checks.empty()) return "has no checks";
  if (arguments.all || scene.label == arguments.label) return {};
  if (!arguments.label.empty()) return fmt::format("is not labelled {}", arguments.label);
  return scene.label == "long" ? "is labelled long (--label long or --all runs it)" : "";
}

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

/// In a child process: never throws.
SceneOutcome verify_scene(const fs::path& file, const VerifyArguments& arguments) {
  SceneOutcome outcome{.scene = file.string()};
  try {
    const Scene scene = read_scene(file, arguments.overrides);
    outcome.left_out = reason_to_leave_out(scene, arguments);
    if (!outcome.left_out.empty()) return outcome;
    outcome.checks = run_checks(scene, arguments.simulation);
    outcome.status = status_of(outcome.checks);
  } catch (const InputError& error) {
    outcome.status = status_bad_input;
    outcome.message = error.what();
  } catch (const std::exception& error) {
    outcome.status = status_run_failed;
    outcome.message = error.what();
  }
  return outcome;
}

SceneOutcome outcome_of(const fs::path& file, const ProcessResult& result) {
  SceneOutcome outcome{.scene = file.string(), .status = status_run_failed, .message = result.death};
  if (result.death.empty()) outcome = outcome_from_json(result.text);
  outcome.wall = result.wall;
  return outcome;
}

void print_outcome(const SceneOutcome& outcome) {
  if (!outcome.left_out.empty()) {
    fmt::print("{}  left out: {}\n", outcome.scene, outcome.left_out);
  } else if (!outcome.message.empty()) {
    fmt::print("{}  FAIL: {}\n", outcome.scene, outcome.message);
  } else {
    fmt::print("{}  {:.3g} s\n", outcome.scene, outcome.wall);
  }
  for (const std::string& line : check_lines(outcome.checks)) fmt::print("{}\n", line);
  std::fflush(stdout);
}

}  // namespace

int verify(const VerifyArguments& arguments) {
  const std::vector<fs::path> scenes = scenes_under(arguments.paths);
  const int threads = std::max(arguments.simulation.threads, 1);
  const int at_once = std::max(static_cast<int>(machine_info().cores) / threads, 1);

  std::vector<SceneOutcome> outcomes;
  fmt::print("{}\n", check_header());
  in_processes(
      static_cast<int>(scenes.size()), at_once,
      [&](int k) { return to_json(verify_scene(scenes[static_cast<std::size_t>(k)], arguments)); },
      [&](int k, const ProcessResult& result) {
        outcomes.push_back(outcome_of(scenes[static_cast<std::size_t>(k)], result));
        print_outcome(outcomes.back());
      });

  const Tally tally = tally_of(outcomes);
  const std::string left_out =
      tally.left_out == 0 ? "" : fmt::format(", scenes left out: {}", tally.left_out);
  fmt::print("{} passed, {} failed{}\n", tally.passed, tally.failed, left_out);
  if (!arguments.json.empty()) write_file(arguments.json, to_json(outcomes));
  return std::ranges::max(outcomes, {}, &SceneOutcome::status).status;
}

}  // namespace scree::cli
