// The exact hull of points in integers: an oracle for make_hull().
#pragma once

#include "core/math.hpp"

#include <array>
#include <span>
#include <vector>

namespace scree::oracle {

/// The convex hull as triangles. Triangles in one plane are not merged. Points that are not corners of the
/// hull may be corners of triangles in whose planes they lie.
struct ExactHull {
  std::vector<std::array<int, 3>>
      triangles;           ///< counterclockwise from outside; none if all points are in one plane
  long double volume = 0;  ///< volume (m^3), rounded only by the last operation

  /// Returns how many points are corners of triangles. They are no fewer than the hull's vertices.
  int corners() const;
};

/// Computes the hull by insertion of one point after another (Seidel 1990; de Berg et al. 2008, chapter 11).
/// Orientations are computed in 256 bits if 64 bits cannot decide them. The points must be whole multiples of
/// `unit`, a power of two, and less than 2^60 units from the first point. Throws std::logic_error if they are
/// not.
ExactHull exact_hull(std::span<const Vec3> points, double unit);

}  // namespace scree::oracle
