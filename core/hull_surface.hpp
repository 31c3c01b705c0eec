// The surface of a convex hull: faces that are polygons of some of the points.
#pragma once

#include "core/math.hpp"

#include <span>
#include <vector>

namespace scree {

/// Returns the faces of the hull of points. A face lists the points that are its corners, counterclockwise
/// from outside, beginning with the one that was given first; the faces are in the order of their corners.
/// All edges have two faces and all corners three or more.
///
/// Points count as one if they are nearer to each other than tolerance::coplanar, which is relative to the
/// longest extent, or for thin hulls to a few times the thickness. Facets that bend by less than this length
/// count as one face, except across thin hulls on which Qhull fails at first. Therefore a point may be
/// outside of the surface, and a corner out of its face's plane, by a few times this length, but by no more
/// than tolerance::most_off_face allows.
///
/// Throws InputError, without a line and column, if there are fewer than four points, if one is not finite,
/// or if they lie in a plane.
std::vector<std::vector<int>> hull_surface(std::span<const Vec3> points);

/// Returns the unit normal of a polygon with these corners, by the right-hand rule: that of the sum of the
/// areas of its triangles from the first corner on. It is computed in long double, since the sides of thin
/// hulls are nearly parallel.
Vec3 polygon_normal(std::span<const int> corners, std::span<const Vec3> points);

}  // namespace scree
