// The look of the pictures of a scene: everything about them that is known before the run.
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
  /// Contact force (N) that is drawn as a line 10 pixels wide; larger forces have lines of the same width.
  double widest_force = 1;
};

/// Returns the look of a scene. Ranges of colours that the scene does not give are guessed from the state at
/// the start: speeds from a fall through the height of the scene and from moving bodies, energies from these
/// speeds, forces from the weight of a column of bodies.
FilmLook look_of(const Scene& scene);

/// Whether pictures show the contacts, or the pairs or the grid of the broad phase, which are not part of a
/// state.
bool shows_contacts(const RenderSettings& render);
bool shows_broad_phase(const RenderSettings& render);

/// Returns a state as the scene wants it drawn, without the broad phase; of a periodic space it shows the
/// cell. `contacts` are those of the step before the state, if pictures show them.
render::Frame frame_of(const Scene& scene, const FilmLook& look, Snapshot snapshot,
                       const std::vector<ContactForce>& contacts);
/// Returns the present state as the scene wants it drawn.
render::Frame frame_of(const Scene& scene, const FilmLook& look, Simulation& simulation);

}  // namespace scree::cli
