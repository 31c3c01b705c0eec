// The surface of a convex hull: faces that are polygons of some of the points.
#pragma once

#include "core/math.hpp"

#include <span>
#include <vector>

namespace scree {

/// The points that are corners of each face, counterclockwise from outside and from the one that was given
/// first; faces in the order of their corners. All edges have two faces and all corners three or more.
///
/// A linear map of a hull is the hull of the mapped points, so lengths here are relative to the points' width
/// along the same direction, however thin they are. Points nearer to each other than tolerance::coplanar are
/// one, as are facets that bend by less than it: a point may be outside of the surface, and a corner out of
/// its face's plane, by a few times that. None is off by more than tolerance::most_off_face says.
///
/// Throws InputError, without a place, if there are fewer than four points, if one is not finite, or if they
/// lie in a plane.
std::vector<std::vector<int>> hull_surface(std::span<const Vec3> points);

/// The unit normal of a polygon with these corners, by the right hand; of the sum of its triangles from the
/// first corner on. In long double, since the sides of thin hulls are nearly parallel.
Vec3 polygon_normal(std::span<const int> corners, std::span<const Vec3> points);

}  // namespace scree
