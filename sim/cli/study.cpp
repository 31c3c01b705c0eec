// scree study: runs a scene in every combination of some settings, and writes tables and plots of its errors
// and its speed, with the settings that no others beat.
#include "sim/record/study.hpp"

#include "core/error.hpp"
#include "core/program.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/process_pool.hpp"
#include "sim/cli/trial.hpp"
#include "sim/record/build_info.hpp"
#include "sim/record/files.hpp"
#include "sim/record/outcome.hpp"
#include "sim/record/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace scree::cli {

namespace {

namespace fs = std::filesystem;

std::vector<Override> with(const std::vector<Override>& settings, const StudyArguments& arguments) {
  std::vector<Override> all = arguments.overrides;
  all.insert(all.end(), settings.begin(), settings.end());
  return all;
}

/// Runs the scene with some settings for its errors. Runs in a child process and never throws.
SceneOutcome find_errors(const std::vector<Override>& settings, const StudyArguments& arguments) {
  SceneOutcome outcome{.scene = arguments.scene.string()};
  try {
    const std::vector<Override> overrides = with(settings, arguments);
    outcome.checks = run_checks(read_scene(arguments.scene, overrides), overrides, arguments.simulation);
  } catch (const std::exception& error) {
    outcome.message = error.what();
  }
  return outcome;
}

/// Runs the scene with some settings for its cost, which it returns as `wall` (s per simulated second). Runs
/// in a child process and never throws.
SceneOutcome find_cost(const std::vector<Override>& settings, const StudyArguments& arguments) {
  SceneOutcome outcome{.scene = arguments.scene.string()};
  try {
    const Scene scene = read_scene(arguments.scene, with(settings, arguments));
    outcome.wall = time_steps(scene, arguments.simulation) / scene.time.end;
  } catch (const std::exception& error) {
    outcome.message = error.what();
  }
  return outcome;
}

SceneOutcome reported(const ProcessResult& result) {
  if (result.death.empty()) return outcome_from_json(result.text);
  return {.scene = "", .message = result.death};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Finds the errors, several combinations at a time, and then the times, one run at a time. All combinations
/// are timed once, then all again: so a machine that slows down slows all of them alike.
Study carry_out(const StudyArguments& arguments, int at_once) {
  Study study{.scene = arguments.scene.stem().string(), .variations = arguments.variations, .points = {}};
  for (const auto& settings : combinations(arguments.variations)) study.points.push_back({settings});
  const int count = static_cast<int>(study.points.size());
  const auto point = [&study](int k) -> StudyPoint& { return study.points[static_cast<std::size_t>(k)]; };
  fmt::print("{} combinations. Measuring errors, {} runs at a time:\n", count, at_once);
  in_processes(
      count, at_once, [&](int k) { return to_json(find_errors(point(k).settings, arguments)); },
      [&](int k, const ProcessResult& result) {
        const SceneOutcome outcome = reported(result);
        point(k).checks = outcome.checks;
        point(k).problem = outcome.message;
        fmt::print("  {}  {}\n", describe(point(k).settings),
                   outcome.message.empty() ? fmt::format("{:.3g} s", result.wall) : outcome.message);
        std::fflush(stdout);
      });
  fmt::print("Measuring times, one run at a time, median of {}:\n", arguments.repeats);
  std::vector<std::vector<double>> times(study.points.size());
  in_processes(
      count * arguments.repeats, 1,
      [&](int run) {
        const StudyPoint& of = point(run % count);
        return to_json(of.problem.empty() ? find_cost(of.settings, arguments) : SceneOutcome{.scene = ""});
      },
      [&](int run, const ProcessResult& result) {
        const int k = run % count;
        const SceneOutcome outcome = reported(result);
        if (point(k).problem.empty()) point(k).problem = outcome.message;
        times[static_cast<std::size_t>(k)].push_back(outcome.wall);
      });
  for (int k = 0; k < count; ++k) {
    point(k).cost = point(k).problem.empty() ? median(times[static_cast<std::size_t>(k)])
                                             : std::numeric_limits<double>::quiet_NaN();
  }
  return study;
}

void print_check(const Study& study, std::size_t check) {
  if (study.has_no_error(check)) {
    fmt::print("\nno error of {}: a check with `above` has one only with `expect`\n", study.checks()[check]);
    return;
  }
  fmt::print("\nerror of {}\n  {:>10}  {:>12}  settings (* = no other is faster and as exact)\n",
             study.checks()[check], "error", "s per sim. s");
  const std::vector<std::size_t> front = pareto_front(study, check);
  for (std::size_t k = 0; k < study.points.size(); ++k) {
    const StudyPoint& point = study.points[k];
    const bool best = std::ranges::find(front, k) != front.end();
    fmt::print("{} {:>10}  {:>12}  {}\n", best ? '*' : ' ',
               std::isfinite(point.error(check)) ? fmt::format("{:.2e}", point.error(check)) : "no result",
               std::isfinite(point.cost) ? fmt::format("{:.4g}", point.cost) : "-", describe(point.settings));
  }
  for (const Curve& curve : curves_of(study)) {
    const double order = fitted_order(study, curve, check);
    if (std::isfinite(order)) {
      fmt::print("  order in {}: {:.2f}  {}\n", study.variations.front().key, order, curve.settings);
    }
  }
  for (const Reached& reached : cheapest_to(study, check)) {
    const StudyPoint& point = study.points[reached.point];
    fmt::print("  time to reach {:g}: {:.4g} s per simulated second, {}\n", reached.error, point.cost,
               describe(point.settings));
  }
}

void draw(const Study& study, const RunFolder& folder) {
  std::string place;  // the folder for gnuplot's single quotes, in which two of them are one
  for (const char c : folder.path().string()) place += c == '\'' ? std::string("''") : std::string(1, c);
  for (std::size_t k = 0; k < study.checks().size(); ++k) {
    if (pareto_front(study, k).empty()) continue;
    const std::string name = fmt::format("error_{}", k + 1);
    const std::string script = plot_script(study, k, name);
    write_file(folder / (name + ".gp").c_str(), script);
    try {
      run_program({"gnuplot"}, fmt::format("cd '{}'\n{}", place, script));
    } catch (const RunError& error) {
      fmt::print("no plot: {}; its script is {}\n", error.what(), (folder / (name + ".gp").c_str()).string());
    }
  }
}

}  // namespace

int study(const StudyArguments& arguments) {
  if (arguments.variations.empty())
    throw InputError("--vary KEY=V1,V2,... is missing: study needs at least one setting to vary");
  std::string name;
  // Every combination is read before the first one runs: bad input writes nothing.
  for (const auto& settings : combinations(arguments.variations)) {
    const Scene scene = read_scene(arguments.scene, with(settings, arguments));
    if (std::ranges::none_of(scene.checks, gives_error))
      throw InputError(
          fmt::format("{}: has no check with `expect`, or with `below` alone, so that nothing says "
                      "what its error is",
                      arguments.scene.string()));
    name = scene.name;
  }
  const RunFolder folder(
      arguments.output.empty() ? "output/" + name + "-study" : arguments.output.string(),
      arguments.overwrite ? RunFolder::Earlier::replaced : RunFolder::Earlier::refused_results);
  const int threads = std::max(arguments.simulation.threads, 1);
  const int at_once = std::max(static_cast<int>(machine_info().cores) / threads, 1);
  const Study result = carry_out(arguments, at_once);
  for (std::size_t k = 0; k < result.checks().size(); ++k) print_check(result, k);
  write_file(folder / "study.csv", to_csv(result));
  write_file(folder / "study.json", to_json(result));
  draw(result, folder);
  fmt::print("\nstudy: {}/\n", folder.path().string());
  return result.checks().empty() ? status_run_failed : status_done;
}

}  // namespace scree::cli
