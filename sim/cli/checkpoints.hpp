// The checkpoints of a run: when they are taken, and how a run is continued from one.
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

/// The checkpoints of a run. The thread that drives the run copies a state, and another thread writes it.
class Checkpoints {
 public:
  /// `every`: wall time between two checkpoints (s). `draws`: whether the run makes pictures.
  Checkpoints(const RunFolder& folder, double every, RunIdentity identity, bool draws);

  /// Looks for the newest checkpoint that is whole; returns false if there is none at all. Throws InputError
  /// if it belongs to another run, or if there are some and none can be read. Adds to `warnings` what is
  /// wrong with newer ones, and what may differ from here on.
  bool find(std::vector<std::string>& warnings);
  /// Continues from the checkpoint that find() has found.
  void resume(Simulation& simulation, Recorder& recorder);
  /// Returns the steps at which the run was resumed.
  const std::vector<std::int64_t>& resumed_at() const { return resumed_at_; }

  /// Takes a checkpoint if one is due. If an earlier one could not be written, throws that error (as a rule a
  /// RunError) once.
  void take_if_due(Simulation& simulation, Recorder& recorder);
  /// Takes a checkpoint of the present state, unless there is one, and waits until it is written. Throws if
  /// it cannot be written; that an earlier one could not be written no longer matters then.
  void take_last(Simulation& simulation, Recorder& recorder);
  /// Removes all checkpoints, as the run will not be continued. Errors of checkpoints that could not be
  /// written are forgotten.
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
  // The error of a checkpoint that could not be written, until the driving thread has seen it. The success of
  // the next checkpoint, which may wait already, must not hide it.
  std::exception_ptr failure_;
  Worker<Saved> writer_;
};

}  // namespace scree::cli
