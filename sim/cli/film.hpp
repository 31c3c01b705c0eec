// The pictures of a run and the movie made from them. Two threads draw and write them while the run goes on.
// A problem with pictures never stops the run: it is reported, noted in the manifest, and the run goes on
// without pictures. Only a picture that cannot be written ends the run, as any other file would.
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
  /// `warn` is called with each problem, by the thread that calls the functions of the film.
  using Warn = std::function<void(std::string_view)>;
  Film(const Scene& scene, const RunFolder& folder, render::ContextChoice context, Warn warn);

  /// Takes the frames that are due at the present state: frame k at the step nearest to k / fps. Waits while
  /// two others have not been begun, so that none is left out. Throws RunError if an earlier one could not be
  /// written.
  void record(Simulation& simulation);
  /// Takes the frames that are due at a step, of a state that need not be present: frame_at() makes the frame
  /// if one is due.
  void record(std::int64_t step, const std::function<render::Frame()>& frame_at);
  /// Counts the frames that are due at the step as made by others. Must not be called after a frame was
  /// recorded.
  void pass_over(std::int64_t step) { frames_ += frames_due_.due(step); }
  const FilmLook& look() const { return look_; }
  /// Waits until all pictures are drawn and written. Throws RunError like record(), unless record() has
  /// thrown it.
  void finish_frames();
  /// Makes the movie from the pictures, all of which must be there.
  void make_movie();

  /// Saves how many pictures there are, after drawing and writing those that were due; on loading, removes
  /// the pictures that were drawn later.
  void archive(Archive& archive);

  std::int64_t frames() const { return frames_; }
  /// Returns the name of the renderer (see render::Renderer::name()), once the pictures are finished.
  const std::string& renderer() const { return renderer_; }
  /// Returns the file name of the movie; empty if there is none.
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
  bool stopped_ = false;  ///< whether drawing has failed and this was reported: no more frames are taken
  bool failed_ = false;   ///< whether record() has thrown since a picture could not be written: none follow
  std::atomic<std::int64_t> frames_ = 0;
  std::string movie_;
  // Data of the threads. Each time is changed by one of them, and read when both have ended.
  double draw_seconds_ = 0, write_seconds_ = 0;
  std::string renderer_;
  std::mutex trouble_mutex_;
  std::string trouble_;
  // The drawing thread hands its pictures to the writing thread, so it is made later and ends first.
  Worker<Picture> writer_;
  Worker<Shot> drawer_;
};

}  // namespace scree::cli
