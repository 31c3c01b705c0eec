#include "sim/cli/failure_picture.hpp"

#include "render/png.hpp"
#include "sim/cli/film_look.hpp"

#include <algorithm>

namespace scree::cli {

namespace {

constexpr double sizes_around = 16;  // height of the picture, in sizes of the body

/// Returns the radius of the smallest ball around the body's centre that holds the body (m).
double radius_of(const BodyTable& bodies, std::size_t k) {
  return bounding_radius(bodies.shape[k], bodies.size[k]);
}

/// Returns a camera that looks at the place from the direction of the scene's camera.
render::Camera camera_at(const Vec3& place, double radius, const render::Camera& usual) {
  const double distance = sizes_around * radius / (2 * std::tan(usual.fov * pi / 360));
  render::Camera camera = usual;
  camera.to = place;
  camera.from = place + distance * (usual.from - usual.to).normalized();
  return camera;
}

/// Marks a body with the edges of a cube around it.
void mark(const BodyTable& bodies, std::size_t k, render::Frame& frame) {
  const double half = 1.1 * radius_of(bodies, k);
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      Vec3 from = Vec3::Constant(-half);
      if ((corner & 1) != 0) from[(axis + 1) % 3] = half;
      if ((corner & 2) != 0) from[(axis + 2) % 3] = half;
      frame.lines.push_back({.from = bodies.position[k] + from,
                             .to = bodies.position[k] + from + 2 * half * Vec3::Unit(axis),
                             .width = 2,
                             .color = render::Color(0.78f, 0.09f, 0.09f),
                             .where_hidden = 0.6f});
    }
  }
}

}  // namespace

void draw_failure(const Scene& scene, Simulation& simulation, const std::vector<std::int32_t>& bodies,
                  render::ContextChoice context, const std::filesystem::path& file) {
  FilmLook look = look_of(scene);
  look.style.muted = 0.5f;
  look.style.cell.reset();
  render::Frame frame = frame_of(scene, look, simulation);
  const BodyTable& state = frame.snapshot.bodies;
  for (const std::int32_t body : bodies) mark(state, static_cast<std::size_t>(body), frame);
  const auto first = static_cast<std::size_t>(bodies.front());
  const render::Camera camera =
      camera_at(state.position[first], radius_of(state, first), look.camera(simulation.time()));
  const auto renderer = render::make_renderer(context, scene.render.width, scene.render.height);
  render::write_png(file, renderer->draw(frame, camera, look.style));
}

}  // namespace scree::cli
