#include "sim/cli/checkpoints.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace scree::cli {

namespace {

[[noreturn]] void refuse(std::string_view why) {
  throw InputError(fmt::format("--resume: {}; --overwrite starts from the beginning", why));
}

[[noreturn]] void refuse_pictures(bool saved_draws) {
  throw InputError(fmt::format(
      "--resume: the checkpoint is of a run {} --no-render; {} --no-render to continue it, or give "
      "--overwrite instead of --resume to start from the beginning",
      saved_draws ? "without" : "with", saved_draws ? "leave out" : "add"));
}

}  // namespace

Checkpoints::Checkpoints(const RunFolder& folder, double every, RunIdentity identity, bool draws)
    : folder_(folder / "checkpoint"),
      every_(every),
      identity_(std::move(identity)),
      draws_(draws),
      writer_(1, [this](Saved& saved) { write(saved); }) {
  prepare_checkpoints();
}

bool Checkpoints::find(std::vector<std::string>& warnings) {
  found_ = folder_.newest(warnings);
  if (!found_ && !warnings.empty())
    refuse(fmt::format("no checkpoint can be read: {}", fmt::join(warnings, "; ")));
  for (std::string& damaged : warnings) damaged += "; the run goes on from the one before it";
  if (!found_) return false;
  RunIdentity saved;
  bool saved_draws = false;
  Archive archive = Archive::loading(*found_);
  archive.part("run", saved);
  archive("draws", saved_draws);
  if (const std::string difference = difference_of(saved, identity_); !difference.empty()) refuse(difference);
  if (saved_draws != draws_) refuse_pictures(saved_draws);
  if (saved.commit != identity_.commit)
    warnings.push_back(fmt::format(
        "the checkpoint is of commit {}, and this program of {}: from here on the results may differ by "
        "rounding from those of the other",
        saved.commit, identity_.commit));
  return true;
}

void Checkpoints::resume(Simulation& simulation, Recorder& recorder) {
  Archive archive = Archive::loading(*found_);
  this->archive(archive, simulation, recorder);
  found_.reset();
  resumed_at_.push_back(simulation.steps());
  last_step_ = simulation.steps();
}

void Checkpoints::archive(Archive& archive, Simulation& simulation, Recorder& recorder) {
  archive("resumed_at", resumed_at_);
  archive.part("simulation", simulation);
  archive.part("recorder", recorder);
}

void Checkpoints::take(Simulation& simulation, Recorder& recorder) {
  const timing::Region region("checkpoint");
  Saved saved{simulation.steps(), {}};
  Archive archive = Archive::saving(saved.state);
  archive.part("run", identity_);
  archive("draws", draws_);
  this->archive(archive, simulation, recorder);
  writer_.push(std::move(saved));
  last_step_ = simulation.steps();
  last_time_ = Clock::now();
}

void Checkpoints::write(const Saved& saved) {
  try {
    folder_.add(saved.step, saved.state);
  } catch (...) {
    const std::lock_guard lock(failure_mutex_);
    failure_ = std::current_exception();
  }
}

std::exception_ptr Checkpoints::take_failure() {
  const std::lock_guard lock(failure_mutex_);
  return std::exchange(failure_, nullptr);
}

void Checkpoints::throw_failure() {
  if (const std::exception_ptr failure = take_failure()) std::rethrow_exception(failure);
}

void Checkpoints::take_if_due(Simulation& simulation, Recorder& recorder) {
  throw_failure();
  if (Clock::now() - last_time_ >= every_) take(simulation, recorder);
}

void Checkpoints::take_last(Simulation& simulation, Recorder& recorder) {
  writer_.drain();
  const bool has_failed = take_failure() != nullptr;
  if (has_failed || last_step_ != simulation.steps()) take(simulation, recorder);
  writer_.drain();
  throw_failure();
}

void Checkpoints::drop() {
  writer_.drain();
  folder_.clear();
}

}  // namespace scree::cli
