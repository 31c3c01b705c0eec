// Snapshot, camera and style to picture.
#pragma once

#include "core/snapshot.hpp"
#include "render/camera.hpp"
#include "render/color.hpp"
#include "render/image.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace scree::render {

enum class ColorBy { material, speed, size };

struct Style {
  ColorBy color_by = ColorBy::material;
  /// sRGB, by material index; starts over after the last.
  std::vector<Color> palette = default_palette();
  /// Speed (m/s) or size (m) at the two ends of the colour scale, the first smaller. Absent: value_range() of
  /// the snapshot; a sequence wants one range for all its frames.
  std::optional<std::array<double, 2>> range;
  /// sRGB. The ground fades into the horizon.
  Color zenith = Color(0.66f, 0.73f, 0.81f);
  Color horizon = Color(0.885f, 0.895f, 0.905f);
};

/// The range that shows a snapshot well: of the moving bodies, speed from 0 to its 98th percentile, or size
/// from its 2nd to its 98th. Never empty. {0, 1} for ColorBy::material.
std::array<double, 2> value_range(const Snapshot& snapshot, ColorBy color_by);

/// Draws pictures of one size. Not for two threads at once.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// The same input gives the same bytes. Spheres, boxes and the planes seen from their free side: nearly
  /// level ones as ground, walls as a faint film that hides nothing.
  virtual Image draw(const Snapshot& snapshot, const Camera& camera, const Style& style) = 0;
};

/// Draws on the processor through OSMesa. Throws RunError if no OpenGL 3.3 context of this size is to be had.
std::unique_ptr<Renderer> make_osmesa_renderer(int width, int height);

/// Draws black pictures, for what needs pictures but not their content.
std::unique_ptr<Renderer> make_null_renderer(int width, int height);

}  // namespace scree::render
