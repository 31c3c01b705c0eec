// The interface of the renderer, which makes a picture of a frame, a camera and a style.
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
  /// sRGB colours by material index; they start over after the last.
  std::vector<Color> palette = default_palette();
  /// Values at the two ends of the colour scale, in SI units, the first smaller. If absent, value_range() of
  /// the frame is used; a sequence needs one range for all its frames.
  std::optional<std::array<double, 2>> range;
  /// Width of the cells drawn on planes (m). If absent, grid_cell() of the camera is used.
  std::optional<double> cell;
  float muted = 0;  ///< share by which bodies lose their colours, 0 to 1, so that lines over them stand out
  /// sRGB colours of the sky. The ground fades into that of the horizon.
  Color zenith = Color(0.66f, 0.73f, 0.81f);
  Color horizon = Color(0.885f, 0.895f, 0.905f);
};

/// Draws pictures of one size. Two threads must not use it at the same time.
class Renderer {
 public:
  virtual ~Renderer() = default;
  /// Draws a frame; the same input gives the same bytes. Spheres, boxes and bodies of general shapes are
  /// drawn in full. Planes are drawn if seen from their free side: nearly level ones as ground, walls as a
  /// faint film that hides nothing. The far side of a tube's wall is drawn with stripes that show how it
  /// turns; its near side and end caps are drawn as faint glass.
  virtual Image draw(const Frame& frame, const Camera& camera, const Style& style) = 0;
  /// Returns the names of interface and device: "EGL, NVIDIA H200/PCIe/SSE2", "OSMesa, llvmpipe (LLVM 15.0.6,
  /// 256 bits)".
  virtual std::string name() const = 0;
};

/// The choice of an OpenGL context. Pictures of two contexts differ by no more than
/// tests/render/context_test.cpp allows; those of one context on one machine do not differ at all.
enum class ContextChoice {
  automatic,  ///< EGL if it offers a GPU that can draw such pictures, else OSMesa
  osmesa,     ///< Mesa on the processor, through OSMesa
  egl         ///< a GPU if there is one, else Mesa on the processor, through EGL
};

/// Makes a renderer. Throws RunError, which lists what was tried, if there is no OpenGL 3.3 context that can
/// draw this size.
std::unique_ptr<Renderer> make_renderer(ContextChoice choice, int width, int height);

/// Makes a renderer of black pictures, for callers that need pictures but not their content.
std::unique_ptr<Renderer> make_null_renderer(int width, int height);

}  // namespace scree::render
