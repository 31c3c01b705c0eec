// Frame, camera and style to picture.
#pragma once

#include "render/camera.hpp"
#include "render/coloring.hpp"
#include "render/image.hpp"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree::render {

struct Style {
  ColorBy color_by = ColorBy::material;
  /// sRGB, by material index; starts over after the last.
  std::vector<Color> palette = default_palette();
  /// Values at the two ends of the colour scale, in SI units, the first smaller. Absent: value_range() of the
  /// frame; a sequence wants one range for all its frames.
  std::optional<std::array<double, 2>> range;
  /// Width of the cells drawn on planes (m). Absent: grid_cell() of the camera.
  std::optional<double> cell;
  float muted = 0;  ///< of the bodies' colours, 0 to 1, so that lines over them stand out
  /// sRGB. The ground fades into the horizon.
  Color zenith = Color(0.66f, 0.73f, 0.81f);
  Color horizon = Color(0.885f, 0.895f, 0.905f);
};

/// Draws pictures of one size. Not for two threads at once.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// The same input gives the same bytes. Spheres, boxes and the planes seen from their free side: nearly
  /// level ones as ground, walls as a faint film that hides nothing. Of tubes the far side of the wall, with
  /// stripes that show how it turns; the near side and the end caps as faint glass.
  virtual Image draw(const Frame& frame, const Camera& camera, const Style& style) = 0;
  /// What draws: "EGL, NVIDIA H200/PCIe/SSE2", "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits)".
  virtual std::string name() const = 0;
};

/// The ways to OpenGL. Pictures of two differ by what tests/render/context_test.cpp allows; of one, on one
/// machine, not at all.
enum class ContextChoice {
  automatic,  ///< EGL if that has a GPU that draws such pictures, else OSMesa
  osmesa,     ///< on the processor
  egl         ///< a GPU if there is one, else Mesa on the processor
};

/// Throws RunError, saying what was tried, if no OpenGL 3.3 context of this size is to be had.
std::unique_ptr<Renderer> make_renderer(ContextChoice choice, int width, int height);

/// Draws black pictures, for what needs pictures but not their content.
std::unique_ptr<Renderer> make_null_renderer(int width, int height);

}  // namespace scree::render
