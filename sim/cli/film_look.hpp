// How the pictures of a scene look: everything about them that is known before the run.
#pragma once

#include "render/annotation.hpp"
#include "render/camera_path.hpp"
#include "render/renderer.hpp"
#include "sim/observe/inspection.hpp"
#include "sim/scene/scene.hpp"
#include "sim/step/simulation.hpp"

#include <functional>
#include <vector>

namespace scree::cli {

struct FilmLook {
  std::function<render::Camera(double time)> camera;
  render::Style style;
  render::Annotation annotation;
  /// Contact force (N) that is drawn as a line 10 pixels wide; wider it does not get.
  double widest_force = 1;
};

/// Ranges of colours left to scree are guessed from the state at the start: speeds from a fall through the
/// height of the scene and from moving bodies, energies from these speeds, forces from the weight of a column
/// of bodies.
FilmLook look_of(const Scene& scene);

/// Whether pictures show the contacts, or the pairs or the grid of the broad phase: what a state alone does
/// not tell.
bool shows_contacts(const RenderSettings& render);
bool shows_broad_phase(const RenderSettings& render);

/// A state as the scene wants it drawn, of a periodic space the cell, but for the broad phase; `contacts` are
/// those before it, if pictures show them.
render::Frame frame_of(const Scene& scene, const FilmLook& look, Snapshot snapshot,
                       const std::vector<ContactForce>& contacts);
/// The present state as the scene wants it drawn.
render::Frame frame_of(const Scene& scene, const FilmLook& look, Simulation& simulation);

}  // namespace scree::cli
