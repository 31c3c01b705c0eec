// Everything that a run writes as it goes: metrics, timing and frames at their cadences, and the checks.
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

/// The present state of a simulation, as checks and metrics ask for it.
Probe probe_of(Simulation& simulation);

class Recorder {
 public:
  /// Starts the files in the folder, or goes on with those that are there, once archive() has said up to
  /// where. `draws`: what makes frames; none without. `threads` may help.
  Recorder(const Scene& scene, const RunFolder& folder, Console& console,
           std::optional<render::ContextChoice> draws, int threads, AtomicFile::Opening opening);

  /// What is due at the present state. To be called at t = 0 and after every step.
  void record(Simulation& simulation);
  /// The last step of which all that was due is recorded.
  std::int64_t recorded() const { return recorded_; }
  /// A row for the present state, unless it has one; the newest observation is of it.
  void record_last(Simulation& simulation);
  /// All that was recorded until the state was saved is on the disk; what came after is gone on loading.
  void archive(Archive& archive);
  /// Every file gets its final name, and the frames become a movie.
  void finish();
  /// Nobody will go on with the run.
  void drop();

  /// The newest observation made: at most one row of the metrics old.
  const Observation& newest() const { return newest_; }
  double worst_penetration() const { return worst_penetration_; }  ///< of all rows so far (m)
  const WorstOverlap& worst_overlap() const { return worst_overlap_; }
  std::vector<CheckResult> check_results() const { return checks_.results(newest_.energy_scale); }
  const std::vector<StateMark>& states() const { return states_; }  ///< some, all over the run
  double wall() const { return timing_.wall(); }  ///< of the whole run, whatever stopped it (s)
  /// Of the trajectory, once it is finished.
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
  std::int64_t last_row_ = -1;  ///< its step
  double worst_penetration_ = 0;
  WorstOverlap worst_overlap_;
  std::vector<StateMark> states_;
};

}  // namespace scree::cli
