// The OpenGL renderer, on any OpenGL 3.3 core context. It makes a picture in six passes:
//   shadow map  depth of spheres, boxes and facets from the light
//   tags        the body that each of four samples per pixel shows
//   geometry    normal and depth per pixel
//   occlusion   ambient occlusion per pixel, then smoothed
//   shade       light, background and encoding
//   lines       the lines of the frame, over all else
// Spheres are exact in every pass: rays are intersected with their equations, without meshes.
#pragma once

#include "render/gl/context.hpp"
#include "render/renderer.hpp"

#include <memory>

namespace scree::render::gl {

/// Makes the renderer. Throws RunError if the context cannot draw pictures of this size.
std::unique_ptr<Renderer> make_gl_renderer(std::unique_ptr<Context> context, int width, int height);

}  // namespace scree::render::gl
