// The bodies that are drawn by triangles.
#pragma once

#include "render/color.hpp"
#include "render/frame.hpp"
#include "render/gl/view.hpp"

#include <cstddef>
#include <vector>

namespace scree::render::gl {

/// Appends the triangles of a body of a general shape, four texels for each, in the layout of
/// shaders/common.glsl and relative to the eye. Capsules and cylinders have enough triangles to look round.
void facets_of(const Frame& frame, std::size_t body, const Vec3& eye, const Color& color,
               std::vector<Vec4f>& texels);

}  // namespace scree::render::gl
