// The frames of a run and the movie made of them. They are drawn and written by two threads while the run
// goes on. Trouble with pictures never costs the numbers: it is said, noted in the manifest, and the run goes
// on without them; only a frame that cannot be written ends it, as any other file would.
#pragma once

#include "sim/cli/film_look.hpp"
#include "sim/cli/worker.hpp"
#include "sim/record/run_folder.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/step/simulation.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace scree::cli {

class Film {
 public:
  /// `warn` is told of trouble, by the thread that calls.
  using Warn = std::function<void(std::string_view)>;
  Film(const Scene& scene, const RunFolder& folder, render::ContextChoice context, Warn warn);

  /// Takes the frames that are due at the present state: frame k at the step nearest to k / fps. Waits while
  /// two others have not been begun: none is left out. Throws RunError if an earlier one could not be
  /// written.
  void record(Simulation& simulation);
  /// The same, of a state that need not be present: frame_at() makes it, if one is due at the step.
  void record(std::int64_t step, const std::function<render::Frame()>& frame_at);
  /// Leaves what is due at the step to others. Not once a frame is recorded.
  void pass_over(std::int64_t step) { frames_ += frames_due_.due(step); }
  const FilmLook& look() const { return look_; }
  /// Waits until all is drawn and written. Throws like record(), unless that has.
  void finish_frames();
  /// Makes the movie of the frames; all are there.
  void make_movie();

  /// What was due until the state was saved is drawn and written; what was drawn since is removed on loading.
  void archive(Archive& archive);

  std::int64_t frames() const { return frames_; }
  /// What has drawn them, as render::Renderer::name() has it, once they are finished.
  const std::string& renderer() const { return renderer_; }
  /// File name; empty if there is none.
  const std::string& movie() const { return movie_; }

 private:
  struct Shot {
    render::Frame frame;
    std::int64_t copies;
  };
  struct Picture {
    render::Image image;
    std::int64_t copies;
  };
  class Studio;
  void draw(std::shared_ptr<Studio>& studio, const Shot& shot);
  void write(const Picture& picture);
  void say_trouble();

  const Scene& scene_;
  const RunFolder& folder_;
  render::ContextChoice context_;
  Warn warn_;
  FilmLook look_;
  Cadence frames_due_;
  bool stopped_ = false;  ///< no more frames: drawing has failed, and it has been said
  bool failed_ = false;   ///< nor here: one could not be written, and record() has thrown
  std::atomic<std::int64_t> frames_ = 0;
  std::string movie_;
  // Of the threads. Each time is touched by one of them, and read when both have ended.
  double draw_seconds_ = 0, write_seconds_ = 0;
  std::string renderer_;
  std::mutex trouble_mutex_;
  std::string trouble_;
  // The first hands its pictures to the second, so it is made later and ends before.
  Worker<Picture> writer_;
  Worker<Shot> drawer_;
};

}  // namespace scree::cli
