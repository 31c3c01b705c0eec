// Cuts polygons into triangles.
#pragma once

#include "core/math.hpp"

#include <array>
#include <span>
#include <vector>

namespace scree {

/// Appends to `out` the triangles of a polygon, as numbers of its corners and with the orientation of the
/// polygon: at most n - 2 of them, and none without area. The polygon need not be convex or quite plane: it
/// is projected along its normal (Newell's). If every corner is visible from the first one, the triangles are
/// a fan about that corner; otherwise ears are cut off (Meisters 1975). Returns false if the polygon crosses
/// itself, so that triangles cannot fill it: then they are a fan.
bool cut_polygon(std::span<const Vec3> corners, std::vector<std::array<int, 3>>& out);

}  // namespace scree
