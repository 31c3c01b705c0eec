// The texts of shaders/*.glsl. The build generates the definitions (render/CMakeLists.txt).
#pragma once

#include <string_view>

namespace scree::render::gl::shaders {

extern const std::string_view common, sphere, plane, tube, surface;
extern const std::string_view sphere_vert, box_vert, facet_vert, plane_vert, picture_vert, line_vert;
extern const std::string_view sphere_frag, flat_frag, plane_frag, tube_frag, line_frag;
extern const std::string_view geometry_frag, occlusion_frag, smooth_frag, shade_frag;

}  // namespace scree::render::gl::shaders
