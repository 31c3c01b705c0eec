// The selection of visible bodies: in a heap of a million, all but a few percent are hidden behind others.
#pragma once

#include <cstdint>
#include <vector>

namespace scree::render::gl {

/// The bounds of a body's picture on the picture plane, in pixels.
struct Disc {
  float x = 0, y = 0;
  float outer = 0;  ///< radius of a disc that encloses the body's picture
  float inner = 0;  ///< radius of a disc that the body covers for certain
  float near = 0;   ///< depth of the body's nearest point, or less
  float far = 0;    ///< depth of the body's surface within `inner`, or more
  std::int32_t body = 0;
};

/// Returns the bodies, ascending, that may show in a picture of this size. A body is left out only if it lies
/// outside the picture or behind nearer bodies that cover it, so that the picture does not change. The method
/// follows the occlusion buffers of Coorg and Teller 1997, "Real-time occlusion culling for models with large
/// occluders", with every body as an occluder: from front to back, each disc is looked up in a grid of the
/// depths covered so far, then covers its own share of the grid.
std::vector<std::int32_t> visible_discs(const std::vector<Disc>& discs, int width, int height);

}  // namespace scree::render::gl
