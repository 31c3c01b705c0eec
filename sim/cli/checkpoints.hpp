// When a run saves what it can be continued from, and how it is continued.
#pragma once

#include "sim/cli/recorder.hpp"
#include "sim/cli/worker.hpp"
#include "sim/record/checkpoint.hpp"
#include "sim/simulation.hpp"

#include <chrono>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace scree::cli {

/// What must be the same for a run to go on.
struct RunIdentity {
  std::string version, commit, space;
  std::string scene;         ///< resolved
  std::uint64_t bodies = 0;  ///< checksum of the bodies that it starts with, which may come from files
  bool draws = false;

  void archive(Archive& archive);
};

/// Throws InputError where a checkpoint is of another run than `present`, and says in what.
void expect_same_run(const RunIdentity& saved, const RunIdentity& present);

/// States are copied by the thread that drives the run, and written by one of their own.
class Checkpoints {
 public:
  /// `every`: wall time between them (s).
  Checkpoints(const RunFolder& folder, double every, RunIdentity identity);

  /// Looks for the newest that is whole; false if there is none. Throws InputError if it is of another run.
  /// `warnings`: what is wrong with newer ones, and what may differ from here on.
  bool find(std::vector<std::string>& warnings);
  /// Goes on from what find() has found.
  void resume(Simulation& simulation, Recorder& recorder);
  /// The steps at which the run was resumed.
  const std::vector<std::int64_t>& resumed_at() const { return resumed_at_; }

  /// Takes one if it is time. Throws once, RunError as a rule, if an earlier one could not be written.
  void take_if_due(Simulation& simulation, Recorder& recorder);
  /// Takes one of the present state, unless it has been; complete on return. Throws if it cannot be written.
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
  void throw_failure();

  CheckpointFolder folder_;
  std::chrono::duration<double> every_;
  RunIdentity identity_;
  std::optional<SavedState> found_;
  std::vector<std::int64_t> resumed_at_;
  Clock::time_point last_time_ = Clock::now();
  std::int64_t last_step_ = -1;
  std::mutex failure_mutex_;
  std::exception_ptr failure_;  // of the last one written; another may fare better
  Worker<Saved> writer_;
};

}  // namespace scree::cli
