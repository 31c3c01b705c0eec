// When a run saves what it can be continued from, and how it is continued.
#pragma once

#include "sim/cli/recorder.hpp"
#include "sim/cli/worker.hpp"
#include "sim/record/checkpoint.hpp"
#include "sim/record/run_identity.hpp"
#include "sim/step/simulation.hpp"

#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace scree::cli {

/// States are copied by the thread that drives the run, and written by one of their own.
class Checkpoints {
 public:
  /// `every`: wall time between them (s). `draws`: whether the run makes pictures.
  Checkpoints(const RunFolder& folder, double every, RunIdentity identity, bool draws);

  /// Looks for the newest that is whole; false if there is none. Throws InputError if it is of another run.
  /// `warnings`: what is wrong with newer ones, and what may differ from here on.
  bool find(std::vector<std::string>& warnings);
  /// Goes on from what find() has found.
  void resume(Simulation& simulation, Recorder& recorder);
  /// The steps at which the run was resumed.
  const std::vector<std::int64_t>& resumed_at() const { return resumed_at_; }

  /// Takes one if it is time. Throws once, RunError as a rule, if an earlier one could not be written.
  void take_if_due(Simulation& simulation, Recorder& recorder);
  /// Takes one of the present state, unless it is saved already; complete on return. An earlier one that
  /// could not be written no longer matters then. Throws if this one cannot be written.
  void take_last(Simulation& simulation, Recorder& recorder);
  /// Nobody will go on from here: removes all, and forgets what could not be written.
  void drop();

 private:
  struct Saved {
    std::int64_t step;
    SavedState state;
  };
  using Clock = std::chrono::steady_clock;
  void archive(Archive& archive, Simulation& simulation, Recorder& recorder);
  void take(Simulation& simulation, Recorder& recorder);
  void write(const Saved& saved);
  std::exception_ptr take_failure();
  void throw_failure();

  CheckpointFolder folder_;
  std::chrono::duration<double> every_;
  RunIdentity identity_;
  bool draws_;
  std::optional<SavedState> found_;
  std::vector<std::int64_t> resumed_at_;
  Clock::time_point last_time_ = Clock::now();
  std::int64_t last_step_ = -1;
  std::mutex failure_mutex_;
  // Why a checkpoint could not be written, until the driving thread has seen it: the success of the next one,
  // which may wait already, must not hide it.
  std::exception_ptr failure_;
  Worker<Saved> writer_;
};

}  // namespace scree::cli
