#include "sim/cli/film.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "render/movie.hpp"
#include "render/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree::cli {

namespace {

render::ColorBy color_by(ColorBy color) {
  switch (color) {
    case ColorBy::material:
      break;
    case ColorBy::speed:
      return render::ColorBy::speed;
    case ColorBy::size:
      return render::ColorBy::size;
  }
  return render::ColorBy::material;
}

render::Camera camera_for(const Scene& scene, const Snapshot& start) {
  const RenderSettings& render = scene.render;
  if (!render.camera) {
    return render::frame_all(start, scene.gravity, static_cast<double>(render.width) / render.height);
  }
  return {.from = render.camera->from,
          .to = render.camera->to,
          .up = render::up_of(scene.gravity),
          .fov = render.camera->fov};
}

/// One colour scale for all frames, known before the first is drawn. Speeds: those at the start, and that of
/// a fall through the height of the scene.
std::array<double, 2> range_for(const Scene& scene, const Snapshot& start, render::ColorBy color) {
  std::array<double, 2> range = render::value_range(start, color);
  if (color != render::ColorBy::speed) return range;
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const Vec3& x : start.bodies.position) {
    lowest = std::min(lowest, -scene.gravity.dot(x));
    highest = std::max(highest, -scene.gravity.dot(x));
  }
  if (highest > lowest) range[1] = std::max(range[1], std::sqrt(2 * (highest - lowest)));
  return range;
}

}  // namespace

Film::Film(const Scene& scene, const RunFolder& folder, Console& console)
    : folder_(folder),
      console_(console),
      fps_(scene.render.fps),
      frames_due_(TimeGrid(scene.time), 1 / scene.render.fps) {
  snapshot_.bodies = scene.bodies;
  camera_ = camera_for(scene, snapshot_);
  style_.color_by = color_by(scene.render.color);
  style_.range = range_for(scene, snapshot_, style_.color_by);
  try {
    renderer_ = render::make_osmesa_renderer(scene.render.width, scene.render.height);
  } catch (const RunError& error) {
    console_.warn(fmt::format("no pictures: {}", error.what()));
  }
}

void Film::record(Simulation& simulation) {
  const std::int64_t due = renderer_ ? frames_due_.due(simulation.steps()) : 0;
  if (due == 0) return;
  render::Image image;
  simulation.snapshot(snapshot_);
  try {
    const timing::Region region("render.draw");
    image = renderer_->draw(snapshot_, camera_, style_);
  } catch (const RunError& error) {
    console_.warn(fmt::format("no pictures after t = {} s: {}", simulation.time(), error.what()));
    renderer_.reset();
    return;
  }
  // Where frames come faster than steps one picture stands for several, so that the movie keeps its pace.
  for (std::int64_t k = 0; k < due; ++k) write_frame(image);
}

void Film::write_frame(const render::Image& image) {
  const timing::Region region("render.write");
  const std::filesystem::path file = folder_.frames() / fmt::format("{:05}.png", frames_);
  render::write_png(file, image);
  ++frames_;
}

void Film::finish() {
  if (frames_ == 0) return;
  const std::filesystem::path frames = folder_.frames();
  const std::filesystem::path file = folder_ / "movie.mp4";
  try {
    const timing::Region region("render.movie");
    render::make_movie(frames, fps_, file);
  } catch (const RunError& error) {
    console_.warn(fmt::format("no movie, but the frames are in {}: {}", frames.string(), error.what()));
    return;
  }
  movie_ = file.filename();
}

}  // namespace scree::cli
