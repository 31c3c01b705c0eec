// The judge of make_hull(): it decides whether a result is the hull of the points.
#pragma once

#include "bench/hulls/families.hpp"
#include "core/geometry.hpp"

#include <string>

namespace scree::oracle {

/// The errors of a hull relative to its points. Lengths are in units of the distance that counts as zero:
/// tolerance::coplanar times the longest extent, or times coplanar_thicknesses times the least. For a
/// support, the extent along its direction is in place of the least.
struct HullError {
  double support = 0;  ///< most by which the hull falls short of the points, over the directions tried
  double plane = 0;    ///< most by which a point is outside of a face, or a corner of the face inside of it
  double polygon = 0;  ///< most by which a corner of a face is outside of an edge of it, within its plane
  double volume = 0;   ///< relative difference from the exact volume, as a length by the least extent
  bool refused = false;
  std::string fault;  ///< empty: none. A hull is at fault if it is not closed, not convex, or beyond one of
                      ///< the bounds
};

/// The bound of the errors. A million sets reach two fifths of it (decision 0040).
inline constexpr double most_error = 50;

/// Returns what is wrong with a hull by itself: faces, edges and vertices that do not form a closed surface,
/// or invalid numbers. The string is empty if nothing is wrong.
std::string fault_of(const Hull& hull);

/// Makes the hull and compares it with the points (supports, in long double) and with their exact hull
/// (volume). A refusal is a fault unless the points are flat, or the exact hull has too many corners.
HullError judge_hull(const HullPoints& set);

}  // namespace scree::oracle
