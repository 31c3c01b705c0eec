// Which bodies can be seen at all: in a heap of a million, all but a few percent are behind others.
#pragma once

#include <cstdint>
#include <vector>

namespace scree::render::gl {

/// A body on the picture plane, in pixels.
struct Disc {
  float x = 0, y = 0;
  float outer = 0;  ///< radius that holds its picture
  float inner = 0;  ///< radius that it covers for certain
  float near = 0;   ///< depth of its nearest point, or less
  float far = 0;    ///< depth, or more, of its surface within `inner`
  std::int32_t body = 0;
};

/// The bodies, ascending, that may show in a picture of this size. One is left out only if it lies outside
/// the picture or behind what nearer ones cover, so that no picture changes. After the occlusion buffers of
/// Coorg and Teller 1997, "Real-time occlusion culling for models with large occluders", with every body as
/// an occluder: from front to back, each disc is looked up in a grid of the depths covered so far, then
/// covers its own share.
std::vector<std::int32_t> visible_discs(const std::vector<Disc>& discs, int width, int height);

}  // namespace scree::render::gl
