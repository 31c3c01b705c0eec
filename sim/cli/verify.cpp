// scree verify: runs every scene that has checks, several at a time, and prints a table of what was measured
// and what was expected.
#include "core/error.hpp"
#include "sim/cli/check_table.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/console.hpp"
#include "sim/cli/process_pool.hpp"
#include "sim/cli/trial.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/files.hpp"
#include "sim/record/outcome.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <unistd.h>

namespace scree::cli {

namespace {

namespace fs = std::filesystem;

bool is_scene(const fs::path& file) { return file.extension() == ".yaml" || file.extension() == ".yml"; }

/// Returns the scene files under the paths, each once, sorted within each path so that the table does not
/// depend on the order in which the disk has them.
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

/// A scene, and the settings to run it with.
struct Job {
  fs::path file;
  std::vector<Override> settings;

  SceneOutcome outcome() const { return {.scene = file.string(), .settings = describe(settings)}; }
};

/// Runs a scene for its checks. Runs in a child process and never throws.
SceneOutcome verify_scene(const Job& job, const VerifyArguments& arguments) {
  SceneOutcome outcome = job.outcome();
  try {
    std::vector<Override> overrides = arguments.overrides;
    overrides.insert(overrides.end(), job.settings.begin(), job.settings.end());
    const Scene scene = read_scene(job.file, overrides);
    outcome.left_out = reason_to_leave_out(scene, arguments);
    if (!outcome.left_out.empty()) return outcome;
    outcome.notes = scene.notes;
    outcome.checks = run_checks(scene, overrides, arguments.simulation);
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

SceneOutcome outcome_of(const Job& job, const ProcessResult& result) {
  SceneOutcome outcome = job.outcome();
  outcome.status = status_run_failed;
  outcome.message = result.death;
  if (result.death.empty()) outcome = outcome_from_json(result.text);
  outcome.wall = result.wall;
  return outcome;
}

std::string title(const SceneOutcome& outcome) {
  return outcome.scene + (outcome.settings.empty() ? "" : "  " + outcome.settings);
}

void print_outcome(const SceneOutcome& outcome) {
  if (!outcome.left_out.empty()) {
    fmt::print("{}  left out: {}\n", title(outcome), outcome.left_out);
  } else if (!outcome.message.empty()) {
    fmt::print("{}  FAIL: {}\n", title(outcome), outcome.message);
  } else {
    fmt::print("{}  {:.3g} s\n", title(outcome), outcome.wall);
  }
  for (const std::string& note : outcome.notes) fmt::print("  note: {}\n", note);
  for (const std::string& line : check_lines(outcome.checks)) fmt::print("{}\n", line);
  std::fflush(stdout);
}

/// Prints a line for each combination of settings, if they vary: the number of checks that passed and failed,
/// and the sum of the wall times.
void print_matrix(const std::vector<SceneOutcome>& outcomes) {
  const auto groups = by_settings(outcomes);
  if (groups.size() < 2) return;
  fmt::print("\n{:>8}  {:>8}  {:>10}  settings\n", "passed", "failed", "s");
  for (const std::vector<SceneOutcome>& group : groups) {
    double wall = 0;
    for (const SceneOutcome& outcome : group) wall += outcome.wall;
    const Tally tally = tally_of(group);
    fmt::print("{:>8}  {:>8}  {:>10.3g}  {}\n", tally.passed, tally.failed, wall, group.front().settings);
  }
}

/// Throws InputError if the table could not be written after the scenes have run, which may take hours.
void expect_writable(const fs::path& file) {
  if (file.empty()) return;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!fs::is_directory(folder))
    throw InputError(fmt::format("--json: {}: there is no such folder", folder.string()));
  if (access(folder.c_str(), W_OK) != 0)
    throw InputError(fmt::format("--json: cannot write in {}: {}", folder.string(), std::strerror(errno)));
  if (fs::is_directory(file)) throw InputError(fmt::format("--json: {}: is a folder", file.string()));
}

/// Throws InputError if every scene was left out: a misspelt label is no success.
void expect_some_run(const std::vector<SceneOutcome>& outcomes, const std::string& label) {
  const auto was_run = [](const SceneOutcome& outcome) { return outcome.left_out.empty(); };
  if (std::ranges::any_of(outcomes, was_run)) return;
  throw InputError("no scene was run: " + (label.empty()
                                               ? std::string("all were left out")
                                               : "none with checks has the label " + printable(label)));
}

}  // namespace

int verify(const VerifyArguments& arguments) {
  expect_writable(arguments.json);
  std::vector<Job> jobs;
  for (const fs::path& file : scenes_under(arguments.paths)) {
    for (const auto& settings : combinations(arguments.variations)) jobs.push_back({file, settings});
  }
  const auto job = [&jobs](int k) -> const Job& { return jobs[static_cast<std::size_t>(k)]; };
  const int threads = std::max(arguments.simulation.threads, 1);
  const int at_once = std::max(static_cast<int>(machine_info().cores) / threads, 1);

  std::vector<SceneOutcome> outcomes;
  fmt::print("{}\n", check_header());
  in_processes(
      static_cast<int>(jobs.size()), at_once, [&](int k) { return to_json(verify_scene(job(k), arguments)); },
      [&](int k, const ProcessResult& result) {
        outcomes.push_back(outcome_of(job(k), result));
        print_outcome(outcomes.back());
      });

  print_matrix(outcomes);
  const Tally tally = tally_of(outcomes);
  const std::string left_out =
      tally.left_out == 0 ? "" : fmt::format(", scenes left out: {}", tally.left_out);
  fmt::print("{} passed, {} failed{}\n", tally.passed, tally.failed, left_out);
  if (!arguments.json.empty()) write_file(arguments.json, to_json(outcomes));
  expect_some_run(outcomes, arguments.label);
  return std::ranges::max(outcomes, {}, &SceneOutcome::status).status;
}

}  // namespace scree::cli
