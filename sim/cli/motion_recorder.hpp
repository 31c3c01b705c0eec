// The recorder of a run's trajectory, and of its contacts if the scene wants them. They are compressed and
// written by another thread while the run goes on.
#pragma once

#include "core/archive.hpp"
#include "sim/cli/worker.hpp"
#include "sim/record/contact_writer.hpp"
#include "sim/record/run_folder.hpp"
#include "sim/record/trajectory_writer.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/step/simulation.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace scree::cli {

class MotionRecorder {
 public:
  /// The scene must have a trajectory. `threads`: number of threads that compress.
  MotionRecorder(const Scene& scene, const RunFolder& folder, AtomicFile::Opening opening, int threads);

  /// Takes the frame that is due at the present state, if one is: frame k at the step nearest to k periods,
  /// and never two frames at one step. Waits while two others have not been begun, so that none is left out.
  /// Throws RunError if an earlier one could not be written.
  void record(const Simulation& simulation);
  /// Saves how far the files are written, after bringing that to the disk; on loading, removes what was added
  /// after the state was saved.
  void archive(Archive& archive);
  /// Writes trajectory.vtkhdf, and contacts.vtkhdf.
  void finish();
  /// Removes the journals, as the run will not be continued.
  void drop();

  std::int64_t frames() const { return writer_.frames(); }  ///< number of frames, once finish() was called

 private:
  struct Moment {
    Snapshot snapshot;
    std::vector<ContactForce> contacts;
  };

  Cadence due_;
  TrajectoryWriter writer_;
  std::optional<ContactWriter> contacts_;
  double seconds_ = 0;  ///< time that the thread has spent (s)
  Worker<Moment> worker_;
};

}  // namespace scree::cli
