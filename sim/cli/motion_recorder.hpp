// The trajectory of a run, and its contacts if they are asked for, compressed and written by a thread of its
// own while the run goes on.
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
  /// The scene has a trajectory. `threads` compress.
  MotionRecorder(const Scene& scene, const RunFolder& folder, AtomicFile::Opening opening, int threads);

  /// Takes the frame that is due at the present state, if one is: frame k at the step nearest to k periods,
  /// and never two of one step. Waits while two others have not been begun: none is left out. Throws RunError
  /// if an earlier one could not be written.
  void record(const Simulation& simulation);
  /// What was due until the state was saved is on the disk; what was added since is gone on loading.
  void archive(Archive& archive);
  /// Writes trajectory.vtkhdf, and contacts.vtkhdf.
  void finish();
  /// Nobody will go on with the run.
  void drop();

  std::int64_t frames() const { return writer_.frames(); }  ///< once it is finished

 private:
  struct Moment {
    Snapshot snapshot;
    std::vector<ContactForce> contacts;
  };

  Cadence due_;
  TrajectoryWriter writer_;
  std::optional<ContactWriter> contacts_;
  double seconds_ = 0;  ///< of the thread
  Worker<Moment> worker_;
};

}  // namespace scree::cli
