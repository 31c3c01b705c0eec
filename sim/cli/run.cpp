// scree run: a scene from its file to a run folder.
#include "core/error.hpp"
#include "sim/cli/check_table.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/console.hpp"
#include "sim/cli/interrupt.hpp"
#include "sim/cli/recorder.hpp"
#include "sim/record/final_state.hpp"
#include "sim/record/manifest.hpp"
#include "sim/record/outcome.hpp"
#include "sim/record/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <utility>

namespace scree::cli {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string duration_words(double seconds) {
  if (seconds < 60) return fmt::format("{:.3g} s", seconds);
  const auto whole = static_cast<std::int64_t>(seconds);
  if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
  return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

std::string progress_line(const Simulation& simulation, const Recorder& recorder, std::int64_t last_step,
                          double end, double elapsed) {
  const Observation& seen = recorder.newest();
  const double rate = static_cast<double>(simulation.steps()) / elapsed;
  const double left = static_cast<double>(last_step - simulation.steps()) / rate;
  return fmt::format(
      "t {:.4g}/{:.4g} s, {:.3g} steps/s, {} left, {} contacts, penetration {:.2g} m, energy error {:.2g}",
      simulation.time(), end, rate, duration_words(left), seen.contacts, recorder.worst_penetration(),
      seen.unexplained);
}

/// Steps until `last_step` or an interrupt.
void advance(Simulation& simulation, Recorder& recorder, Console& console, std::int64_t last_step,
             double end) {
  const auto start = Clock::now();
  recorder.record(simulation);
  while (simulation.steps() < last_step && !interrupted()) {
    simulation.step();
    recorder.record(simulation);
    if (console.wants_progress()) {
      console.progress(progress_line(simulation, recorder, last_step, end, seconds_since(start)));
    }
  }
}

void say_summary(const Scene& scene, const RunSummary& summary, const RunFolder& folder, Console& console) {
  console.say(fmt::format("{}: {} at t = {:.6g} s, {} steps in {} on {}, state {}", scene.name,
                          summary.status, summary.time, summary.steps, duration_words(summary.wall),
                          summary.space, hex(summary.state_hash)));
  if (!summary.checks.empty()) {
    const auto passed = std::ranges::count(summary.checks, Verdict::passed, &CheckResult::verdict);
    console.say(check_header());
    for (const std::string& line : check_lines(summary.checks)) console.say(line);
    const auto failed = std::ranges::count_if(summary.checks, is_failure, &CheckResult::verdict);
    const std::ptrdiff_t of_seeds = std::ssize(summary.checks) - passed - failed;
    console.say(fmt::format(
        "{} passed, {} failed{}", passed, failed,
        of_seeds > 0 ? fmt::format(", {} told by many seeds alone: scree verify", of_seeds) : ""));
  }
  if (summary.frames > 0) {
    console.say(fmt::format("pictures: {} frames in {}{}", summary.frames, folder.frames().string(),
                            summary.movie.empty() ? "" : ", " + (folder / summary.movie.c_str()).string()));
  }
  console.say(fmt::format("numbers:  {}", (folder / "metrics.csv").string()));
}

BodyTable state_of(const Simulation& simulation) {
  Snapshot snapshot;
  simulation.snapshot(snapshot);
  return std::move(snapshot.bodies);
}

/// Does a part of the run. If it fails the run has failed, but what there is by then is still written; the
/// first error is the one that counts.
void attempt(RunSummary& summary, Console& console, const std::function<void()>& part) {
  try {
    part();
  } catch (const RunError& error) {
    console.error(error.what());
    summary.status = "failed";
    if (summary.error.empty()) summary.error = error.what();
  }
}

int status_of(const RunSummary& summary) {
  if (summary.status == "interrupted") return status_interrupted;
  return summary.status == "failed" ? status_run_failed : status_of(summary.checks);
}

}  // namespace

int run(const RunArguments& arguments) {
  if (arguments.resume) {
    throw InputError("--resume: this version writes no checkpoints; --overwrite starts from the beginning");
  }
  const auto start = Clock::now();
  catch_interrupts();
  const Scene scene = read_scene(arguments.scene, arguments.overrides);
  const TimeGrid grid(scene.time);
  const double end = std::min(arguments.until.value_or(scene.time.end), scene.time.end);
  Simulation simulation(scene, arguments.simulation);

  // Only now is the input known to be good, and something is written.
  const RunFolder folder(arguments.output.empty() ? "output/" + scene.name : arguments.output.string(),
                         arguments.overwrite);
  Console console(folder / "log.txt");
  write_file(folder / "scene.yaml", scene.resolved);
  Recorder recorder(scene, folder, console, arguments.draw && scene.render.enabled);

  RunSummary summary{.space = simulation.space_name(),
                     .model = plan_model(scene).features(),
                     .steps_total = simulation.steps_total()};
  attempt(summary, console, [&] { advance(simulation, recorder, console, grid.nearest(end), end); });
  if (summary.status.empty()) {
    summary.status = simulation.steps() < grid.nearest(end) ? "interrupted" : "done";
  }
  attempt(summary, console, [&] { recorder.record_last(simulation); });
  attempt(summary, console, [&] { recorder.finish(); });
  if (summary.status == "done") {
    attempt(summary, console, [&] { write_final_state(state_of(simulation), scene, folder / "final.csv"); });
  }

  summary.steps = simulation.steps();
  summary.time = simulation.time();
  summary.last = recorder.newest();
  summary.checks = recorder.check_results();
  summary.state_hash = simulation.state_hash();
  if (const Film* film = recorder.film()) {
    summary.frames = film->frames();
    summary.movie = film->movie();
  }
  summary.wall = seconds_since(start);
  summary.warnings = console.warnings();
  say_summary(scene, summary, folder, console);
  console.close();
  write_file(folder / "manifest.json", manifest_of(scene, summary));
  return status_of(summary);
}

}  // namespace scree::cli
