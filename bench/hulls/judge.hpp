// Whether what make_hull() makes of points is their hull.
#pragma once

#include "bench/hulls/families.hpp"
#include "core/geometry.hpp"

#include <string>

namespace scree::oracle {

/// How far a hull is from that of its points. Lengths are in units of the distance that counts as none:
/// tolerance::coplanar of the longest extent, or of coplanar_thicknesses of the least.
struct HullError {
  double support = 0;  ///< most that it falls short of the points, of the directions tried
  double plane = 0;    ///< most that a point is outside of a face, or a corner off it
  double polygon = 0;  ///< most that a corner of a face is outside of an edge of it, within its plane
  double volume = 0;   ///< difference from the exact one, relative, as a length of the least extent
  bool refused = false;
  std::string fault;  ///< empty: none. A hull that is not closed, not convex, or beyond one of the bounds
};

/// Bound of its numbers: clusters of points that are only just not equal come to half of it, all else to a
/// fifth.
inline constexpr double most_error = 100;

/// What is wrong with a hull by itself: faces, edges and vertices that are no closed surface, or numbers that
/// are none. Empty: nothing.
std::string fault_of(const Hull& hull);

/// Makes the hull and holds it against the points (supports, in long double) and their exact hull (volume).
/// A refusal is a fault unless the points are flat, or the exact hull has too many corners.
HullError judge_hull(const HullPoints& set);

}  // namespace scree::oracle
