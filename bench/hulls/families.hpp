// Families of sets of points whose hulls are hard to compute.
#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <vector>

namespace scree::oracle {

enum class HullFamily {
  ball,        ///< points in a ball
  sphere,      ///< points on a sphere
  digits_6,    ///< points of a cube's lattice, turned, rounded to 6 digits
  digits_8,    ///< points of a cube's lattice, turned, rounded to 8 digits
  single,      ///< points of a cube's lattice, turned, rounded to single precision
  whole,       ///< points of an integer lattice, many in one plane or line
  near_equal,  ///< a few points, each several times, moved by 1e-16 to 1e-7
  near_flat,   ///< points within 1e-16 to 1e-4 of a plane
  flat_faces,  ///< points within 1e-16 to 1e-7 of the faces and edges of a turned box
  prism,       ///< rings of a regular prism, with points inside its ends and sides
  disc,        ///< rings of a disc whose height is 1e-6 to 1e-2 of its width
  aspect,      ///< points in a turned box of aspect ratios up to 1e6
  clusters,    ///< a few clusters of sizes 1e-12 to 1e-1
  far,         ///< a ball, a prism or a lattice at 1 to 1e6 sizes from the origin
  magnitudes,  ///< points with coordinates of all magnitudes from 1e-12 on
  planes,      ///< points in three planes and on three lines
  tolerance,   ///< a turned lattice, moved by 1e-7 to 1e-4: about the distance that counts as coplanar
  bevels,      ///< corners of a thin plate, each of several points of a lattice as fine as the plate is thick
  count
};

const char* name_of(HullFamily family);

struct HullPoints {
  std::vector<Vec3> points;
  double unit;  ///< a power of two of which all coordinates are whole multiples (m)
};

/// Makes the n-th set of a family: 4 to 30 points, but up to 200 in every fortieth set. Sizes are 2^-20 to
/// 2^20 m. The unit is 2^-56 of the size.
HullPoints make_points(HullFamily family, std::uint64_t n);

}  // namespace scree::oracle
