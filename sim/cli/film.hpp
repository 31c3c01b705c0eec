// The frames of a run and the movie made of them. Trouble with pictures never costs the numbers: it is said,
// noted in the manifest, and the run goes on without them.
#pragma once

#include "core/snapshot.hpp"
#include "render/renderer.hpp"
#include "sim/cli/console.hpp"
#include "sim/record/run_folder.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/simulation.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace scree::cli {

class Film {
 public:
  Film(const Scene& scene, const RunFolder& folder, Console& console);

  /// Draws the frames that are due at the present state: frame k at the step nearest to k / fps. Throws
  /// RunError if one cannot be written.
  void record(Simulation& simulation);
  /// Makes the movie of the frames drawn.
  void finish();

  std::int64_t frames() const { return frames_; }
  /// File name; empty if there is none.
  const std::string& movie() const { return movie_; }

 private:
  void write_frame(const render::Image& image);

  const RunFolder& folder_;
  Console& console_;
  double fps_;
  Cadence frames_due_;
  std::unique_ptr<render::Renderer> renderer_;  ///< null once drawing has failed
  render::Camera camera_;
  render::Style style_;
  Snapshot snapshot_;
  std::int64_t frames_ = 0;
  std::string movie_;
};

}  // namespace scree::cli
