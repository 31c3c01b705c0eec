#include "sim/cli/film.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "render/movie.hpp"
#include "render/png.hpp"
#include "sim/cli/stopwatch.hpp"

#include <fmt/format.h>

#include <utility>

namespace scree::cli {

namespace {

constexpr std::size_t most_waiting = 2;

}  // namespace

/// The renderer. OpenGL requires that the same thread makes, uses and deletes it.
class Film::Studio {
 public:
  Studio(const RenderSettings& render, const FilmLook& look, render::ContextChoice context)
      : look_(look),
        renderer_(render::make_renderer(context, render.width, render.height)),
        annotator_(look.annotation, render.height, 1 / render.fps) {}

  render::Image draw(const render::Frame& frame) {
    render::Image image = renderer_->draw(frame, look_.camera(frame.snapshot.time), look_.style);
    annotator_.annotate(image, frame, look_.style);
    return image;
  }
  std::string renderer() const { return renderer_->name(); }

 private:
  const FilmLook& look_;
  std::unique_ptr<render::Renderer> renderer_;
  render::Annotator annotator_;
};

Film::Film(const Scene& scene, const RunFolder& folder, render::ContextChoice context, Warn warn)
    : scene_(scene),
      folder_(folder),
      context_(context),
      warn_(std::move(warn)),
      look_(look_of(scene)),
      frames_due_(TimeGrid(scene.time), 1 / scene.render.fps),
      writer_(most_waiting, [this](Picture& picture) { write(picture); }),
      drawer_(most_waiting,
              [this, studio = std::shared_ptr<Studio>()](Shot& shot) mutable { draw(studio, shot); }) {}

void Film::record(Simulation& simulation) {
  record(simulation.steps(), [&] { return frame_of(scene_, look_, simulation); });
}

void Film::record(std::int64_t step, const std::function<render::Frame()>& frame_at) {
  const std::int64_t due = frames_due_.due(step);
  if (due > 0) say_trouble();
  if (due == 0 || stopped_ || failed_) return;
  // If frames are due faster than steps, one picture stands for several, so that the movie keeps its pace.
  Shot shot{frame_at(), due};
  const timing::Region region("render.wait");
  try {
    drawer_.push(std::move(shot));
  } catch (const RunError&) {
    failed_ = true;
    throw;
  }
}

void Film::draw(std::shared_ptr<Studio>& studio, const Shot& shot) {
  // No lock is needed: only this thread writes it.
  if (!trouble_.empty()) return;
  render::Image image;
  try {
    const Stopwatch watch(draw_seconds_);
    if (!studio) {
      studio = std::make_shared<Studio>(scene_.render, look_, context_);
      renderer_ = studio->renderer();
    }
    image = studio->draw(shot.frame);
  } catch (const RunError& error) {
    const std::lock_guard lock(trouble_mutex_);
    trouble_ = fmt::format("no pictures from t = {} s on: {}; the results are not affected",
                           shot.frame.snapshot.time, error.what());
    return;
  }
  writer_.push({std::move(image), shot.copies});
}

void Film::write(const Picture& picture) {
  const Stopwatch watch(write_seconds_);
  for (std::int64_t k = 0; k < picture.copies; ++k) {
    render::write_png(folder_.frame(frames_), picture.image);
    ++frames_;
  }
}

void Film::say_trouble() {
  const std::lock_guard lock(trouble_mutex_);
  if (stopped_ || trouble_.empty()) return;
  warn_(trouble_);
  stopped_ = true;
}

void Film::archive(Archive& archive) {
  if (!archive.is_loading()) {
    const timing::Region region("render.wait");
    drawer_.drain();
    writer_.drain();
    say_trouble();
  }
  std::int64_t frames = frames_;
  archive("frames", frames);
  archive("stopped", stopped_);
  archive.part("due", frames_due_);
  if (!archive.is_loading()) return;
  frames_ = frames;
  folder_.remove_frames_from(frames);
}

void Film::finish_frames() {
  if (!failed_) {
    const timing::Region region("render.wait");
    drawer_.finish();
    writer_.finish();
  }
  timing::add("render.draw", draw_seconds_);
  timing::add("render.write", write_seconds_);
  say_trouble();
}

void Film::make_movie() {
  if (frames_ == 0) return;
  const std::filesystem::path frames = folder_.frames();
  const std::filesystem::path file = folder_ / "movie.mp4";
  try {
    const timing::Region region("render.movie");
    render::make_movie(frames, scene_.render.fps, file);
  } catch (const RunError& error) {
    warn_(fmt::format("no movie, but the frames are in {}: {}", frames.string(), error.what()));
    return;
  }
  movie_ = file.filename();
}

}  // namespace scree::cli
