// A frame in the form that the shaders need: floats relative to the eye. All work in double is done here.
#pragma once

#include "render/gl/view.hpp"
#include "render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace scree::render::gl {

/// The uniform block `Frame` of shaders/common.glsl, which says what each member means.
struct FrameUniforms {
  Vec4f right, up, forward;
  std::array<Vec4f, 3> shadow;
  Vec4f to_light, world_up, focus, zenith, horizon, penumbra;
  std::array<std::int32_t, 4> begin, after, extent;
};

struct FrameData {
  FrameUniforms uniforms;
  std::vector<Vec4f>
      texels;  ///< four for each visible body, for each body that casts shadows, and for each facet
  std::vector<Vec4f> lines;  ///< three texels for each line

  int spheres() const { return uniforms.begin[0]; }
  int boxes() const { return uniforms.begin[1] - uniforms.begin[0]; }
  int tubes() const { return uniforms.begin[2] - uniforms.begin[1]; }
  int grounds() const { return uniforms.begin[3] - uniforms.begin[2]; }
  int casting_spheres() const { return uniforms.after[2] - uniforms.after[1]; }
  int casting_boxes() const { return uniforms.after[3] - uniforms.after[2]; }
  int facets() const { return static_cast<int>(texels.size() / 4) - uniforms.after[3]; }
};

/// Returns the number of texels along an edge of the shadow map: as many as the longer side of the picture
/// has pixels, and some more, since shadows are also seen from nearby.
inline int shadow_size_for(int width, int height) {
  return std::clamp(6 * std::max(width, height) / 5, 512, 4096);
}

/// The treatment of bodies that are hidden behind others. To find and leave them out is better where the
/// processor draws; to draw them is better where a GPU does. The picture is the same.
enum class Hidden { left_out, drawn };

/// Sets `data`, whose memory it uses again. `shadow_size` is the number of texels along an edge of the shadow
/// map. The work runs on all threads that TBB has.
void set_frame_data(const Frame& frame, const Camera& camera, const Style& style, int width, int height,
                    int shadow_size, Hidden hidden, FrameData& data);

}  // namespace scree::render::gl
