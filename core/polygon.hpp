// Polygons cut into triangles.
#pragma once

#include "core/math.hpp"

#include <array>
#include <span>
#include <vector>

namespace scree {

/// Appends to `out` the triangles of a polygon, by the numbers of its corners and turning as it does: n - 2
/// of them at most, none without area. A polygon that need not be convex, nor quite plane: it is seen along
/// its normal (Newell's). Where every corner is seen from the first one it is a fan about that, and else ears
/// are cut off (Meisters 1975). False if it crosses itself, so that no triangles are it: then it is a fan.
bool cut_polygon(std::span<const Vec3> corners, std::vector<std::array<int, 3>>& out);

}  // namespace scree
