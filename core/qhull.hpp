// Qhull (Barber, Dobkin, Huhdanpaa 1996, "The Quickhull algorithm for convex hulls").
#pragma once

#include "core/math.hpp"

#include <vector>

namespace scree {

/// The faces of the hull of points, as the points at their corners, one after another, either way around.
/// Facets that bend by less than `width` (m) are one face, whose corners may be out of its plane by some of
/// it; points in it are no corners. The same points give the same faces. The points should reach equally far
/// along every axis. Empty if Qhull finds no hull, or a face that is no polygon.
std::vector<std::vector<int>> faces_by_qhull(const std::vector<Vec3>& points, double width);

}  // namespace scree
