// scree run: a scene from its file to a run folder.
#include "core/error.hpp"
#include "sim/cli/check_table.hpp"
#include "sim/cli/checkpoints.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/console.hpp"
#include "sim/cli/failure_picture.hpp"
#include "sim/cli/interrupt.hpp"
#include "sim/cli/picture_context.hpp"
#include "sim/cli/recorder.hpp"
#include "sim/record/final_state.hpp"
#include "sim/record/manifest.hpp"
#include "sim/record/outcome.hpp"
#include "sim/record/report/report.hpp"
#include "sim/record/run_folder.hpp"
#include "sim/record/trajectory_reader.hpp"
#include "sim/step/step_failure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <new>
#include <optional>
#include <string_view>
#include <thread>
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

std::string progress_line(const Simulation& simulation, const Recorder& recorder, std::int64_t first_step,
                          std::int64_t last_step, double end, double elapsed) {
  const Observation& seen = recorder.newest();
  const double rate = static_cast<double>(simulation.steps() - first_step) / elapsed;
  const double left = static_cast<double>(last_step - simulation.steps()) / rate;
  return fmt::format(
      "t {:.4g}/{:.4g} s, {:.3g} steps/s, {} left, {} contacts, penetration {:.2g} m, energy error {:.2g}",
      simulation.time(), end, rate, duration_words(left), seen.contacts, recorder.worst_penetration(),
      seen.unexplained);
}

/// Steps until `last_step`, an interrupt, or the end of the wall time.
void advance(Simulation& simulation, Recorder& recorder, Checkpoints& checkpoints, Console& console,
             const RunArguments& arguments, std::int64_t last_step, double end) {
  const auto start = Clock::now();
  const std::int64_t first_step = simulation.steps();
  const auto has_time = [&] {
    return !arguments.max_hours || seconds_since(start) < *arguments.max_hours * 3600;
  };
  if (checkpoints.resumed_at().empty()) recorder.record(simulation);
  while (simulation.steps() < last_step && !interrupted() && has_time()) {
    simulation.step();
    recorder.record(simulation);
    checkpoints.take_if_due(simulation, recorder);
    if (console.wants_progress()) {
      console.progress(progress_line(simulation, recorder, first_step, last_step, end, seconds_since(start)));
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
  if (summary.trajectory_frames > 0)
    console.say(fmt::format("motion:   {} frames in {}", summary.trajectory_frames,
                            (folder / trajectory_name).string()));
  console.say(fmt::format("numbers:  {}", (folder / "metrics.csv").string()));
  console.say(fmt::format("report:   {}", (folder / report_name).string()));
}

BodyTable state_of(const Simulation& simulation) {
  Snapshot snapshot;
  simulation.snapshot(snapshot);
  return std::move(snapshot.bodies);
}

constexpr const char* out_of_memory =
    "out of memory; --resume goes on from the last checkpoint where there is more, `scree plan` says how "
    "much";

/// The step that failed as the manifest has it, and a picture of the place.
void say_failure(const StepFailure& failure, const Scene& scene, Simulation& simulation,
                 const RunFolder& folder, render::ContextChoice context, RunSummary& summary,
                 Console& console) {
  if (failure.bodies().empty()) return;
  for (const std::int32_t id : failure.bodies()) {
    const BodyState body = simulation.body(id);
    summary.failed.push_back({words_for({id}, scene), body.position, body.velocity, body.spin});
  }
  const std::filesystem::path file = folder / "failure.png";
  try {
    draw_failure(scene, simulation, failure.bodies(), context, file);
    console.say(fmt::format("the place, as it was before: {}", file.string()));
  } catch (const RunError& error) {
    console.warn(fmt::format("no picture of the place: {}", error.what()));
  }
}

GuardedRun about_guards(const Scene& scene, const WorstOverlap& worst) {
  GuardedRun run{.worst = worst,
                 .bodies = words_for({worst.bodies[0], worst.bodies[1]}, scene),
                 .accurate = scene.response.mode == ResponseMode::accurate};
  for (const ContactLaw& law : scene.laws) run.restitution = std::max(run.restitution, law.restitution);
  return run;
}

/// What guards and bounds have counted, where that changes whether to trust the run. The report has the rest.
void say_guards(const RunSummary& summary, Console& console) {
  for (const GuardCount& guard : summary.guards)
    if (guard.count > 0 && guard.matters)
      console.say(
          fmt::format("guard: {} {}: {}; fewer by {}", guard.count, guard.what, guard.effect, guard.setting));
}

/// Whether the present state is one to go on from: no row or frame of it is missing. Where memory ran out,
/// what contacts remember went with the step that was undone: going on from there would give other bits,
/// while the checkpoint before it gives those of a run that nothing disturbed.
bool is_whole(const RunSummary& summary, const Simulation& simulation, const Recorder& recorder) {
  if (summary.error.empty()) return true;
  return summary.error != out_of_memory && recorder.recorded() == simulation.steps();
}

/// A page of what is there already: without it the run has come out no worse.
void try_report(const RunFolder& folder) {
  try {
    write_report(folder.path());
  } catch (const std::exception& error) {
    print_error(fmt::format("warning: no report: {}; `scree report` makes it again", error.what()));
  }
}

int status_of(const RunSummary& summary) {
  if (summary.status == "interrupted") return status_interrupted;
  return summary.status == "failed" ? status_run_failed : status_of(summary.checks);
}

RunFolder::Earlier what_becomes_of_an_earlier_run(const RunArguments& arguments) {
  if (arguments.resume) return RunFolder::Earlier::continued;
  return arguments.overwrite ? RunFolder::Earlier::replaced : RunFolder::Earlier::refused;
}

/// Threads that may help the run: where it is on a GPU the processor has nothing else to do.
int helpers_of(const Simulation& simulation, const RunArguments& arguments) {
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  return simulation.space_name() == std::string_view("cuda") && arguments.simulation.threads == 0
             ? std::max(cores, 1)
             : 1;
}

/// A run whose folder is open: its steps, and what is written when they end, in whichever way they do.
class Run {
 public:
  Run(const RunArguments& arguments, const Scene& scene, const RunFolder& folder, Simulation& simulation,
      Checkpoints& checkpoints, Console& console, Recorder& recorder)
      : arguments_(arguments),
        scene_(scene),
        folder_(folder),
        simulation_(simulation),
        checkpoints_(checkpoints),
        console_(console),
        recorder_(recorder),
        summary_{.space = simulation.space_name(),
                 .model = plan_model(scene).features(),
                 .steps_total = simulation.steps_total()} {}

  /// Takes steps until `last_step`, at the time `end` (s). Returns the exit status.
  int to_end(std::int64_t last_step, double end) {
    attempt([&] { take_steps(last_step, end); });
    if (summary_.status.empty()) summary_.status = simulation_.steps() < last_step ? "interrupted" : "done";
    const bool is_complete = summary_.status == "done" && simulation_.finished();
    if (!is_complete && simulation_.steps() > 0 && is_whole(summary_, simulation_, recorder_))
      attempt([&] { checkpoints_.take_last(simulation_, recorder_); });
    finish_files();
    complete_summary();
    say_summary(scene_, summary_, folder_, console_);
    say_guards(summary_, console_);
    console_.close();
    summary_.warnings = console_.warnings();
    write_file(folder_ / "manifest.json", manifest_of(scene_, summary_));
    if (is_complete && summary_.status == "done") {
      checkpoints_.drop();
      recorder_.drop();
    }
    try_report(folder_);
    return status_of(summary_);
  }

 private:
  /// Does a part of the run. If it fails the run has failed, but the other parts are still done; the first
  /// error is the one that counts.
  void attempt(const std::function<void()>& part) {
    const auto fail = [&](const char* why) {
      if (summary_.error != why) console_.error(why);
      summary_.status = "failed";
      if (summary_.error.empty()) summary_.error = why;
    };
    try {
      part();
    } catch (const RunError& error) {
      fail(error.what());
    } catch (const std::bad_alloc&) {
      fail(out_of_memory);
    }
  }

  void take_steps(std::int64_t last_step, double end) {
    try {
      advance(simulation_, recorder_, checkpoints_, console_, arguments_, last_step, end);
    } catch (const StepFailure& caught) {
      failure_ = caught;
      throw;
    }
  }

  void finish_files() {
    attempt([&] { recorder_.record_last(simulation_); });
    attempt([&] { recorder_.finish(); });
    if (summary_.status == "done")
      attempt([&] { write_final_state(state_of(simulation_), scene_, folder_ / "final.csv"); });
  }

  void complete_summary() {
    summary_.steps = simulation_.steps();
    summary_.time = simulation_.time();
    summary_.last = recorder_.newest();
    summary_.guards = guards_of(summary_.last, about_guards(scene_, recorder_.worst_overlap()));
    summary_.checks = recorder_.check_results();
    attempt([&] { summary_.state_hash = simulation_.state_hash(); });
    if (failure_) {
      attempt([&] {
        say_failure(*failure_, scene_, simulation_, folder_, arguments_.context, summary_, console_);
      });
    }
    summary_.states = recorder_.states();
    if (const Film* film = recorder_.film()) {
      summary_.frames = film->frames();
      summary_.movie = film->movie();
      summary_.renderer = film->renderer();
    }
    summary_.trajectory_frames = recorder_.trajectory_frames();
    summary_.wall = recorder_.wall();
    summary_.resumed_at = checkpoints_.resumed_at();
  }

  const RunArguments& arguments_;
  const Scene& scene_;
  const RunFolder& folder_;
  Simulation& simulation_;
  Checkpoints& checkpoints_;
  Console& console_;
  Recorder& recorder_;
  RunSummary summary_;
  std::optional<StepFailure> failure_;
};

}  // namespace

int run(const RunArguments& arguments) {
  if (!arguments.reproduce.empty()) return reproduce(arguments);
  catch_interrupts();
  const Scene scene = read_scene(arguments.scene, arguments.overrides);
  const TimeGrid grid(scene.time);
  const double end = std::min(arguments.until.value_or(scene.time.end), scene.time.end);
  const std::int64_t last_step = grid.nearest(end);
  std::optional<render::ContextChoice> draws;
  if (arguments.draw && scene.render.enabled) draws = arguments.context;
  if (draws) expect_context(*draws);
  Simulation simulation(scene, arguments.simulation);

  // Only now is the input known to be good, and something is written.
  const RunFolder folder(arguments.output.empty() ? "output/" + scene.name : arguments.output.string(),
                         what_becomes_of_an_earlier_run(arguments));
  if (arguments.resume && steps_done(folder / "manifest.json") >= last_step) {
    fmt::print("{}: done, there is nothing to resume\n", folder.path().string());
    return status_done;
  }
  Checkpoints checkpoints(folder, scene.record.checkpoint_every, identity_of(scene, simulation.space_name()),
                          draws.has_value());
  std::vector<std::string> warnings;
  const bool resumes = arguments.resume && checkpoints.find(warnings);
  if (arguments.resume && !resumes) folder.clear();
  const auto opening = resumes ? AtomicFile::Opening::again : AtomicFile::Opening::anew;
  Console console(folder / "log.txt", opening);
  for (const std::string& warning : warnings) console.warn(warning);
  for (const std::string& note : scene.notes) console.warn(note);
  write_file(folder / "scene.yaml", scene.resolved);
  Recorder recorder(scene, folder, console, draws, helpers_of(simulation, arguments), opening);
  if (resumes) {
    checkpoints.resume(simulation, recorder);
    folder.remove_results();
    console.say(fmt::format("resumed at t = {:.6g} s, step {}", simulation.time(), simulation.steps()));
  } else if (arguments.resume) {
    console.say("no checkpoint: from the beginning");
  }

  return Run(arguments, scene, folder, simulation, checkpoints, console, recorder).to_end(last_step, end);
}

}  // namespace scree::cli
