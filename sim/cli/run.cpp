// scree run: runs a scene file and writes a run folder.
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
#include <vector>

namespace scree::cli {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns the parts of a progress line, the most important one first.
std::vector<std::string> progress_of(const Simulation& simulation, const Recorder& recorder,
                                     std::int64_t first_step, std::int64_t last_step, double end,
                                     double elapsed) {
  const Observation& seen = recorder.newest();
  const double rate = static_cast<double>(simulation.steps() - first_step) / elapsed;
  const double left = static_cast<double>(last_step - simulation.steps()) / rate;
  return {fmt::format("t {:.4g}/{:.4g} s", simulation.time(), end),
          fmt::format("{} left", duration_words(left)),
          fmt::format("{} contacts", seen.contacts),
          fmt::format("overlap {:.2g} m", recorder.worst_penetration()),
          fmt::format("energy err. {:.2g}", seen.unexplained),
          fmt::format("{:.3g} steps/s", rate)};
}

/// Takes steps until `last_step` is done, an interrupt comes, or the wall time is used up.
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
      console.progress(progress_of(simulation, recorder, first_step, last_step, end, seconds_since(start)));
    }
  }
}

void say_checks(const std::vector<CheckResult>& checks, Console& console) {
  if (checks.empty()) return;
  console.say(check_header());
  for (const std::string& line : check_lines(checks)) console.say(line);
  console.say(check_counts(checks));
}

/// Says how a run whose last state is not the end of its scene goes on.
void say_how_to_continue(const RunSummary& summary, Console& console) {
  if (summary.steps >= summary.steps_total) return;
  if (summary.status == "interrupted") console.say("to continue: the same command with --resume");
  if (summary.status == "done")
    console.say("to continue: the same command with --resume and without --until");
}

void say_summary(const Scene& scene, const RunSummary& summary, const RunFolder& folder, Console& console) {
  const std::string of_all =
      summary.steps < summary.steps_total ? fmt::format(" of {:.6g} s", scene.time.end) : "";
  console.say(fmt::format("{}: {} at t = {:.6g} s{}, {} steps in {} on {}, state {}", scene.name,
                          summary.status, summary.time, of_all, summary.steps, duration_words(summary.wall),
                          summary.space, hex(summary.state_hash)));
  say_checks(summary.checks, console);
  const auto [requested, emitted] = std::pair(summary.last.requested, summary.last.emitted);
  if (requested > emitted)
    console.say(fmt::format("emitters: {} of {} bodies found room; the others waited until the end", emitted,
                            requested));
  if (summary.frames > 0) {
    console.say(fmt::format("pictures: {} frames in {}{}", summary.frames, folder.frames().string(),
                            summary.movie.empty() ? "" : ", " + (folder / summary.movie.c_str()).string()));
  }
  if (summary.trajectory_frames > 0)
    console.say(fmt::format("motion:   {} frames in {}", summary.trajectory_frames,
                            (folder / trajectory_name).string()));
  console.say(fmt::format("numbers:  {}", (folder / "metrics.csv").string()));
  console.say(fmt::format("report:   {}", (folder / report_name).string()));
  say_how_to_continue(summary, console);
}

BodyTable state_of(const Simulation& simulation) {
  Snapshot snapshot;
  simulation.snapshot(snapshot);
  return std::move(snapshot.bodies);
}

constexpr const char* out_of_memory =
    "out of memory; `scree plan` says how much the scene needs, and on a machine with as much --resume goes "
    "on from the last checkpoint";

/// Adds the bodies of the step that failed to the summary, and draws them.
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
    console.say(fmt::format("picture:  the bodies named, before the step that failed: {}", file.string()));
  } catch (const RunError& error) {
    console.warn(fmt::format("there is no picture of the bodies that failed: {}; manifest.json names them",
                             error.what()));
  }
}

GuardedRun about_guards(const Scene& scene, const WorstOverlap& worst) {
  GuardedRun run{
      .worst = worst,
      .bodies = words_for({worst.bodies[0]}, scene) + " and " + words_for({worst.bodies[1]}, scene),
      .accurate = scene.response.mode == ResponseMode::accurate};
  for (const ContactLaw& law : scene.laws) run.restitution = std::max(run.restitution, law.restitution);
  return run;
}

/// Says what guards and limits have counted where that changes whether to trust the run; the report has the
/// rest. Warns of a large overlap that none of these lines names.
void say_guards(const RunSummary& summary, const GuardedRun& run, Console& console) {
  for (const GuardCount& guard : summary.guards)
    if (guard.count > 0 && guard.matters) console.say("warning: " + line_of(guard));
  if (const std::string overlap = overlap_warning(summary.guards, run); !overlap.empty())
    console.warn(overlap);
}

/// Whether a run can be continued from the present state: no row or frame of it is missing. Where memory ran
/// out, the step was undone and with it the values that contacts keep from step to step: a run continued from
/// there would give other bits, while the checkpoint before it gives those of an undisturbed run.
bool is_whole(const RunSummary& summary, const Simulation& simulation, const Recorder& recorder) {
  if (summary.error.empty()) return true;
  return summary.error != out_of_memory && recorder.recorded() == simulation.steps();
}

/// Writes the report, which shows what other files hold: that it cannot be written does not fail the run.
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

/// Returns the number of threads that may compress what the run writes: all cores if the steps are taken on a
/// GPU, since the processor then has nothing else to do.
int helpers_of(const Simulation& simulation, const RunArguments& arguments) {
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  return simulation.space_name() == std::string_view("cuda") && arguments.simulation.threads == 0
             ? std::max(cores, 1)
             : 1;
}

/// Refuses --resume if the finished run in the folder is one of another scene.
void expect_same_scene(const Scene& scene, const RunFolder& folder) {
  if (read_manifest(folder / "manifest.json").scene_hash != scene_hash_of(scene))
    throw InputError(fmt::format(
        "--resume: the run in {} is finished, and its scene is another one; use -o DIR, or --overwrite",
        folder.path().string()));
}

/// A run whose folder is open: takes its steps, and writes what is to be written when they end, in whichever
/// way they do.
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
    say_guards(summary_, about_guards(scene_, recorder_.worst_overlap()), console_);
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
  /// Does a part of the run. If the part fails, the run has failed, but the other parts are still done; the
  /// first error is the one that the manifest has.
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

  // The folder is opened only now that the input is known to be good: bad input writes nothing.
  const RunFolder folder(arguments.output.empty() ? "output/" + scene.name : arguments.output.string(),
                         what_becomes_of_an_earlier_run(arguments));
  const std::optional<std::int64_t> done =
      arguments.resume ? steps_done(folder / "manifest.json") : std::nullopt;
  if (done >= last_step) {
    expect_same_scene(scene, folder);
    fmt::print("{}: done, there is nothing to resume\n", folder.path().string());
    return status_done;
  }
  Checkpoints checkpoints(folder, scene.record.checkpoint_every, identity_of(scene, simulation.space_name()),
                          draws.has_value());
  std::vector<std::string> warnings;
  const bool resumes = arguments.resume && checkpoints.find(warnings);
  if (arguments.resume && !resumes) {
    if (done) expect_same_scene(scene, folder);
    folder.clear();
  }
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
    console.say(
        "there is no checkpoint: the run starts from the beginning and replaces the files in the folder");
  }

  return Run(arguments, scene, folder, simulation, checkpoints, console, recorder).to_end(last_step, end);
}

}  // namespace scree::cli
