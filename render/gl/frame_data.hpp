// A snapshot as the shaders want it: floats relative to the eye. All work in double is done here.
#pragma once

#include "render/renderer.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace scree::render::gl {

using Vec4f = std::array<float, 4>;

/// The uniform block `Frame` of shaders/common.glsl, which says what each member means.
struct FrameUniforms {
  Vec4f right, up, forward;
  std::array<Vec4f, 3> shadow;
  Vec4f to_light, world_up, focus, zenith, horizon;
  std::array<std::int32_t, 4> begin, extent;
};

/// Texels of the bodies, four each, and what goes with them.
struct FrameData {
  FrameUniforms uniforms;
  std::vector<Vec4f> texels;

  int spheres() const { return uniforms.begin[0]; }
  int boxes() const { return uniforms.begin[1] - uniforms.begin[0]; }
  int grounds() const { return uniforms.begin[2] - uniforms.begin[1]; }
};

/// `shadow_size`: texels along an edge of the shadow map.
FrameData frame_data(const Snapshot& snapshot, const Camera& camera, const Style& style, int width,
                     int height, int shadow_size);

}  // namespace scree::render::gl
