// The renderer proper, on any OpenGL 3.3 core context. Six passes over a picture:
//   shadow map  depth of spheres and boxes from the light
//   tags        which body each of four samples per pixel sees
//   geometry    normal and depth per pixel
//   occlusion   ambient occlusion per pixel, then smoothed
//   shade       light, background and encoding
//   lines       over all that
// Spheres are exact in every pass: rays against equations, no meshes.
#pragma once

#include "render/gl/context.hpp"
#include "render/renderer.hpp"

#include <memory>

namespace scree::render::gl {

/// Throws RunError if the context cannot draw pictures of this size.
std::unique_ptr<Renderer> make_gl_renderer(std::unique_ptr<Context> context, int width, int height);

}  // namespace scree::render::gl
