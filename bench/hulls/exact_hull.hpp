// The hull of points in whole numbers: an oracle for make_hull().
#pragma once

#include "core/math.hpp"

#include <array>
#include <span>
#include <vector>

namespace scree::oracle {

/// The convex hull as triangles; those in one plane stay apart. Points that are no corners of it may be
/// corners of triangles, in their planes.
struct ExactHull {
  std::vector<std::array<int, 3>> triangles;  ///< counterclockwise from outside; none if all is in a plane
  long double volume = 0;                     ///< m^3; its rounding is that of the last operation

  /// How many points are corners of triangles: no fewer than the hull's vertices.
  int corners() const;
};

/// By insertion of one point after another (Seidel 1990; de Berg et al. 2008, chapter 11), with orientations
/// in 256 bits where 64 do not tell. The points must be whole multiples of `unit`, a power of two, and less
/// than 2^60 units from the first. Throws std::logic_error if they are not.
ExactHull exact_hull(std::span<const Vec3> points, double unit);

}  // namespace scree::oracle
