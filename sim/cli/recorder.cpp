#include "sim/cli/recorder.hpp"

#include <algorithm>

namespace scree::cli {

namespace {
/// Number of recorded states: few enough to cost nothing even if the state has to be copied from a GPU.
constexpr int states_of_a_run = 16;
}  // namespace

Probe probe_of(Simulation& simulation) {
  return {
      .observe = [&simulation](bool overlaps) -> const Observation& { return simulation.observe(overlaps); },
      .body = [&simulation](std::int32_t id) { return simulation.body(id); }};
}

Recorder::Recorder(const Scene& scene, const RunFolder& folder, Console& console,
                   std::optional<render::ContextChoice> draws, int threads, AtomicFile::Opening opening)
    : checks_(scene, TimeGrid(scene.time)),
      rows_due_(TimeGrid(scene.time), scene.record.metrics_every),
      states_due_(TimeGrid(scene.time), scene.time.end / states_of_a_run),
      metrics_(scene, folder / "metrics.csv", opening),
      timing_(folder / "timing.csv", opening) {
  if (draws)
    film_.emplace(scene, folder, *draws, [&console](std::string_view trouble) { console.warn(trouble); });
  if (scene.record.trajectory) motion_.emplace(scene, folder, opening, threads);
}

void Recorder::write_rows(Simulation& simulation) {
  const Probe probe = probe_of(simulation);
  metrics_.write_row(probe);
  timing_.write_rows(simulation.time());
  newest_ = probe.observe(true);
  last_row_ = newest_.step;
  worst_penetration_ = std::max(worst_penetration_, newest_.penetration.max);
  worst_overlap_.include(newest_);
}

void Recorder::record(Simulation& simulation) {
  checks_.record(simulation.steps(), probe_of(simulation));
  if (rows_due_.due(simulation.steps()) > 0) write_rows(simulation);
  if (states_due_.due(simulation.steps()) > 0)
    states_.push_back({simulation.steps(), simulation.state_hash()});
  if (film_) film_->record(simulation);
  if (motion_) motion_->record(simulation);
  recorded_ = simulation.steps();
}

void Recorder::record_last(Simulation& simulation) {
  if (last_row_ != simulation.steps()) return write_rows(simulation);
  // The row may have been written before the run was resumed.
  newest_ = simulation.observe(true);
}

void Recorder::archive(Archive& archive) {
  archive.part("checks", checks_);
  archive.part("rows_due", rows_due_);
  archive.part("states_due", states_due_);
  archive("states", states_);
  archive("last_row", last_row_);
  archive("worst_penetration", worst_penetration_);
  archive("worst_overlap", worst_overlap_.relative);
  archive("worst_overlap_time", worst_overlap_.time);
  archive("worst_overlap_first", worst_overlap_.bodies[0]);
  archive("worst_overlap_second", worst_overlap_.bodies[1]);
  archive.part("metrics", metrics_);
  archive.part("timing", timing_);
  if (film_) archive.part("film", *film_);
  if (motion_) archive.part("trajectory", *motion_);
}

void Recorder::finish() {
  metrics_.commit();
  timing_.commit();
  if (film_) {
    film_->finish_frames();
    film_->make_movie();
  }
  if (motion_) motion_->finish();
}

void Recorder::drop() {
  if (motion_) motion_->drop();
}

}  // namespace scree::cli
