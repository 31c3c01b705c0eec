// Convex hulls by Qhull (Barber, Dobkin, Huhdanpaa 1996, "The Quickhull algorithm for convex hulls").
#pragma once

#include "core/math.hpp"

#include <vector>

namespace scree {

/// Returns the faces of the hull of points. Each face lists the points at its corners one after another, in
/// either sense of rotation. Facets that bend by less than `width` (m) are merged into one face, whose
/// corners may be off its plane by a few times `width`; points within a face are not corners. The same points
/// give the same faces. The result is empty if Qhull finds no hull, or a face that is not a polygon.
std::vector<std::vector<int>> faces_by_qhull(const std::vector<Vec3>& points, double width);

}  // namespace scree
