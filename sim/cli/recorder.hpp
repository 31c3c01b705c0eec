// The recorder of a run: it writes metrics, timing and frames when they are due, and evaluates the checks.
#pragma once

#include "sim/cli/console.hpp"
#include "sim/cli/film.hpp"
#include "sim/cli/motion_recorder.hpp"
#include "sim/record/checks.hpp"
#include "sim/record/manifest.hpp"
#include "sim/record/metrics.hpp"
#include "sim/record/run_folder.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/step/simulation.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace scree::cli {

/// Returns access to the present state of a simulation, for checks and metrics.
Probe probe_of(Simulation& simulation);

class Recorder {
 public:
  /// Starts the files in the folder, or continues those that are there, once archive() has said up to where.
  /// `draws`: the way to OpenGL for pictures; without it there are none. `threads`: number of threads that
  /// may compress.
  Recorder(const Scene& scene, const RunFolder& folder, Console& console,
           std::optional<render::ContextChoice> draws, int threads, AtomicFile::Opening opening);

  /// Records what is due at the present state. Must be called at t = 0 and after every step.
  void record(Simulation& simulation);
  /// Returns the last step of which everything that was due is recorded.
  std::int64_t recorded() const { return recorded_; }
  /// Writes a row for the present state, unless there is one. The newest observation is then that of this
  /// state.
  void record_last(Simulation& simulation);
  /// Saves how far everything is written, after bringing that to the disk; on loading, removes what was
  /// written after the state was saved.
  void archive(Archive& archive);
  /// Gives every file its final name, and makes the movie.
  void finish();
  /// Removes what is only needed to continue the run.
  void drop();

  /// Returns the newest observation, which is at most one row of the metrics old.
  const Observation& newest() const { return newest_; }
  double worst_penetration() const { return worst_penetration_; }  ///< deepest overlap of all rows so far (m)
  const WorstOverlap& worst_overlap() const { return worst_overlap_; }
  std::vector<CheckResult> check_results() const { return checks_.results(newest_.energy_scale); }
  const std::vector<StateMark>& states() const { return states_; }  ///< some states, spread over the run
  /// Returns the wall time of the whole run, without the time in which it was stopped (s).
  double wall() const { return timing_.wall(); }
  /// Returns the number of frames of the trajectory, once it is finished.
  std::int64_t trajectory_frames() const { return motion_ ? motion_->frames() : 0; }
  const Film* film() const { return film_ ? &*film_ : nullptr; }

 private:
  void write_rows(Simulation& simulation);

  Checks checks_;
  Cadence rows_due_, states_due_;
  MetricsFile metrics_;
  TimingFile timing_;
  std::optional<Film> film_;
  std::optional<MotionRecorder> motion_;
  Observation newest_;
  std::int64_t recorded_ = -1;
  std::int64_t last_row_ = -1;  ///< step of the last row
  double worst_penetration_ = 0;
  WorstOverlap worst_overlap_;
  std::vector<StateMark> states_;
};

}  // namespace scree::cli
