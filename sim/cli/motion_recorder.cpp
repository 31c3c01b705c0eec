#include "sim/cli/motion_recorder.hpp"

#include "core/timing.hpp"
#include "sim/cli/stopwatch.hpp"
#include "sim/record/trajectory_reader.hpp"

#include <utility>

namespace scree::cli {

namespace {
constexpr std::size_t most_waiting = 2;
}  // namespace

MotionRecorder::MotionRecorder(const Scene& scene, const RunFolder& folder, AtomicFile::Opening opening,
                               int threads)
    : due_(TimeGrid(scene.time), trajectory_period(scene)),
      writer_(scene, folder / trajectory_name, opening, threads),
      worker_(most_waiting, [this](Snapshot& snapshot) {
        const Stopwatch watch(seconds_);
        writer_.append(snapshot);
      }) {}

void MotionRecorder::record(const Simulation& simulation) {
  if (due_.due(simulation.steps()) == 0) return;
  Snapshot snapshot;
  simulation.snapshot(snapshot);
  const timing::Region region("trajectory.wait");
  worker_.push(std::move(snapshot));
}

void MotionRecorder::archive(Archive& archive) {
  if (!archive.is_loading()) {
    const timing::Region region("trajectory.wait");
    worker_.drain();
  }
  archive.part("due", due_);
  archive.part("writer", writer_);
}

void MotionRecorder::finish() {
  const timing::Region region("trajectory.finish");
  worker_.finish();
  timing::add("trajectory.write", seconds_);
  writer_.finish();
}

}  // namespace scree::cli
