#include "sim/cli/motion_recorder.hpp"

#include "core/timing.hpp"
#include "sim/cli/periodic_cell.hpp"
#include "sim/cli/stopwatch.hpp"
#include "sim/record/trajectory_reader.hpp"

#include <utility>

namespace scree::cli {

namespace {
constexpr std::size_t most_moments = 2;
}  // namespace

MotionRecorder::MotionRecorder(const Scene& scene, const RunFolder& folder, AtomicFile::Opening opening,
                               int threads)
    : due_(TimeGrid(scene.time), trajectory_period(scene)),
      writer_(scene, folder / trajectory_name, opening, threads),
      worker_(most_moments, [this](Moment& moment) {
        const Stopwatch watch(seconds_);
        writer_.append(moment.snapshot);
        if (contacts_) contacts_->append(moment.snapshot, moment.contacts);
      }) {
  if (scene.record.trajectory->contacts.value_or(false))
    contacts_.emplace(scene, folder / contacts_name, opening, threads);
}

void MotionRecorder::record(const Simulation& simulation) {
  if (due_.due(simulation.steps()) == 0) return;
  Moment moment;
  simulation.snapshot(moment.snapshot);
  move_into_cell(moment.snapshot.bodies);
  if (contacts_) moment.contacts = simulation.contact_forces();
  for (ContactForce& contact : moment.contacts) moment.snapshot.bodies.period.wrap(contact.point);
  const timing::Region region("trajectory.wait");
  worker_.push(std::move(moment));
}

void MotionRecorder::archive(Archive& archive) {
  if (!archive.is_loading()) {
    const timing::Region region("trajectory.wait");
    worker_.drain();
  }
  archive.part("due", due_);
  archive.part("writer", writer_);
  if (contacts_) archive.part("contacts", *contacts_);
}

void MotionRecorder::finish() {
  const timing::Region region("trajectory.finish");
  worker_.finish();
  timing::add("trajectory.write", seconds_);
  writer_.finish();
  if (contacts_) contacts_->finish();
}

void MotionRecorder::drop() {
  writer_.drop();
  if (contacts_) contacts_->drop();
}

}  // namespace scree::cli
