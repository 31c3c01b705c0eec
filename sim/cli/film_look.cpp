#include "sim/cli/film_look.hpp"

#include "sim/cli/periodic_cell.hpp"
#include "sim/record/contact_writer.hpp"
#include "sim/scene/motion_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
    case ColorBy::kinetic_energy:
      return render::ColorBy::kinetic_energy;
    case ColorBy::force:
      return render::ColorBy::force;
    case ColorBy::level:
      return render::ColorBy::level;
    case ColorBy::id:
      return render::ColorBy::id;
  }
  return render::ColorBy::material;
}

bool has(const RenderSettings& render, Overlay overlay) {
  return std::find(render.overlay.begin(), render.overlay.end(), overlay) != render.overlay.end();
}

render::Camera still_camera(const Scene& scene) {
  const CameraSettings camera = scene.render.camera.value_or(CameraSettings{});
  if (camera.from) return {*camera.from, *camera.to, render::up_of(scene.gravity), camera.fov};
  Snapshot start;
  start.bodies = scene.bodies;
  move_into_cell(start.bodies);
  return render::frame_all(start, scene.gravity,
                           static_cast<double>(scene.render.width) / scene.render.height, camera.fov);
}

std::function<render::Camera(double)> camera_of(const Scene& scene) {
  const CameraSettings camera = scene.render.camera.value_or(CameraSettings{});
  if (!camera.keyframes.empty()) {
    std::vector<render::CameraKey> keys;
    for (const CameraKeySettings& key : camera.keyframes) {
      keys.push_back({key.at, {key.from, key.to, render::up_of(scene.gravity), key.fov}});
    }
    return [path = render::CameraPath(std::move(keys))](double time) { return path.at(time); };
  }
  double turn = 0;  // rad/s
  if (camera.orbit) {
    turn = pi / 180 *
           camera.orbit->degrees_per_second.value_or(camera.orbit->degrees.value_or(0) / scene.time.end);
  }
  return [start = still_camera(scene), turn](double time) { return render::orbited(start, turn * time); };
}

// Returns the largest speed to expect of all but a few bodies (m/s).
double expected_speed(const Scene& scene, const render::Frame& start) {
  double speed = render::value_range(start, render::ColorBy::speed)[1];
  const BodyTable& bodies = scene.bodies;
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.shape[k] == Shape::plane) continue;
    const double height = -scene.gravity.dot(bodies.position[k]);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  if (highest > lowest) speed = std::max(speed, std::sqrt(2 * (highest - lowest)));
  for (const Motion& motion : scene.motions) {
    const auto k = static_cast<std::size_t>(motion.body);
    // The far end of a turning body is its fastest point.
    const MotionBounds bounds = bounds_of(motion);
    speed = std::max(speed, bounds.speed + bounds.spin * bounding_radius(bodies.shape[k], bodies.size[k]));
  }
  return speed;
}

double mean_mass(const BodyTable& bodies) {
  double sum = 0, count = 0;
  for (const double inverse : bodies.inverse_mass) {
    if (inverse == 0) continue;
    sum += 1 / inverse;
    count += 1;
  }
  return count > 0 ? sum / count : 1;
}

// Returns the weight of as many bodies of mean mass as lie along an edge of a cube of all bodies; without
// gravity, the force that stops one of them from `speed` in a step (N).
double expected_force(const Scene& scene, double speed) {
  const double mass = mean_mass(scene.bodies);
  if (scene.gravity.norm() == 0) return mass * speed / scene.time.step;
  return mass * scene.gravity.norm() * std::cbrt(static_cast<double>(scene.bodies.count()));
}

std::array<double, 2> range_of(const Scene& scene, const render::Frame& start, render::ColorBy color) {
  if (scene.render.range) return *scene.render.range;
  // A scene at rest without gravity has no speed to scale by.
  const double speed = std::max(expected_speed(scene, start), 1e-6);
  switch (color) {
    case render::ColorBy::speed:
      return {0, render::rounded_up(speed)};
    case render::ColorBy::kinetic_energy:
      return {0, render::rounded_up(0.5 * mean_mass(scene.bodies) * speed * speed)};
    case render::ColorBy::force:
      return {0, render::rounded_up(2 * expected_force(scene, speed))};
    default:
      return render::value_range(start, color);
  }
}

void append_forces(double widest, std::vector<ContactForce> contacts, render::Frame& frame) {
  const auto strength = [](const ContactForce& c) { return c.force.norm(); };
  std::ranges::stable_sort(contacts, {}, strength);
  const BodyTable& bodies = frame.snapshot.bodies;
  for (ContactForce& c : contacts) {
    bodies.period.wrap(c.point);
    const auto width = static_cast<float>(std::min(10 * strength(c) / widest, 10.0));
    if (width < 0.1f) continue;  // such a line cannot be seen
    frame.lines.push_back({.from = contact_end(bodies, c.i, c.point),
                           .to = contact_end(bodies, c.j, c.point),
                           .width = width,
                           .color = render::Color(0.62f, 0.08f, 0.12f),
                           .where_hidden = 0.85f});
  }
}

void append_pairs(const std::vector<BodyPair>& pairs, render::Frame& frame) {
  const BodyTable& bodies = frame.snapshot.bodies;
  for (const auto& [i, j] : pairs) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    // The centre of a plane has no meaning.
    if (bodies.shape[a] == Shape::plane || bodies.shape[b] == Shape::plane) continue;
    Vec3 to = bodies.position[b];
    bodies.period.bring_near(bodies.position[a], to);
    frame.lines.push_back({.from = bodies.position[a],
                           .to = to,
                           .width = 1.2f,
                           .color = render::Color(0.10f, 0.12f, 0.16f),
                           .where_hidden = 0.5f});
  }
}

void append_cells(const GridOccupancy& grid, render::Frame& frame) {
  const std::vector<render::Color>& palette = render::category_palette();
  for (const OccupiedCell& cell : grid.cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 4; ++corner) {
        Vec3 from = Vec3::Zero();
        from[(axis + 1) % 3] = corner & 1;
        from[(axis + 2) % 3] = corner >> 1;
        const Vec3 start = cell.low + cell.width * from;
        frame.lines.push_back({.from = start,
                               .to = start + cell.width * Vec3::Unit(axis),
                               .width = 1,
                               .color = 0.8f * palette[static_cast<std::size_t>(cell.level) % palette.size()],
                               .where_hidden = 0.12f});
      }
    }
  }
}

/// Returns the frame without the images of bodies that reach through the ends of a periodic cell, which are
/// added last.
render::Frame begun_frame(const Scene& scene, const FilmLook& look, Snapshot snapshot,
                          const std::vector<ContactForce>& contacts) {
  render::Frame frame;
  frame.snapshot = std::move(snapshot);
  frame.geometry = scene.geometry;
  move_into_cell(frame.snapshot.bodies);
  if (scene.render.color == ColorBy::material) {
    for (const Material& material : scene.materials) frame.kinds.push_back(material.name);
  }
  if (!shows_contacts(scene.render)) return frame;
  frame.force.resize(frame.snapshot.bodies.shape.size());
  for (const ContactForce& c : contacts) {
    for (const std::int32_t body : {c.i, c.j}) frame.force[static_cast<std::size_t>(body)] += c.force.norm();
  }
  if (has(scene.render, Overlay::forces)) append_forces(look.widest_force, contacts, frame);
  return frame;
}

/// Adds the pairs and the grid of the broad phase in the present state.
void append_broad_phase(const RenderSettings& render, Simulation& simulation, render::Frame& frame) {
  if (has(render, Overlay::pairs)) append_pairs(simulation.pairs(), frame);
  if (render.color != ColorBy::level && !has(render, Overlay::grid)) return;
  GridOccupancy grid = simulation.grid_occupancy();
  if (has(render, Overlay::grid)) append_cells(grid, frame);
  if (render.color == ColorBy::level) {
    for (const double width : grid.width) {
      frame.kinds.push_back(fmt::format("{}: cells of {}", frame.kinds.size(), render::length_words(width)));
    }
    frame.level = std::move(grid.level);
  }
}

}  // namespace

FilmLook look_of(const Scene& scene) {
  const RenderSettings& render = scene.render;
  const bool room = render.height >= render::least_annotated_height;
  FilmLook look;
  look.camera = camera_of(scene);
  render::Frame start;
  start.snapshot.bodies = scene.bodies;
  look.style.color_by = color_by(render.color);
  look.style.range = range_of(scene, start, look.style.color_by);
  look.style.cell = render::grid_cell(look.camera(0));
  if (has(render, Overlay::forces) || has(render, Overlay::pairs)) look.style.muted = 0.7f;
  look.annotation = {.legend = render.legend.value_or(room), .time_stamp = render.time_stamp.value_or(room)};
  look.widest_force = expected_force(scene, expected_speed(scene, start));
  return look;
}

bool shows_contacts(const RenderSettings& render) {
  return render.color == ColorBy::force || has(render, Overlay::forces);
}

bool shows_broad_phase(const RenderSettings& render) {
  return render.color == ColorBy::level || has(render, Overlay::grid) || has(render, Overlay::pairs);
}

render::Frame frame_of(const Scene& scene, const FilmLook& look, Snapshot snapshot,
                       const std::vector<ContactForce>& contacts) {
  render::Frame frame = begun_frame(scene, look, std::move(snapshot), contacts);
  append_images(frame);
  return frame;
}

render::Frame frame_of(const Scene& scene, const FilmLook& look, Simulation& simulation) {
  const RenderSettings& render = scene.render;
  Snapshot snapshot;
  simulation.snapshot(snapshot);
  render::Frame frame =
      begun_frame(scene, look, std::move(snapshot),
                  shows_contacts(render) ? simulation.contact_forces() : std::vector<ContactForce>());
  append_broad_phase(render, simulation, frame);
  append_images(frame);
  return frame;
}

}  // namespace scree::cli
