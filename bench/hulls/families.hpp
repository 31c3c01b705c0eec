// Sets of points that are hard to make hulls of.
#pragma once

#include "core/math.hpp"

#include <cstdint>
#include <vector>

namespace scree::oracle {

enum class HullFamily {
  ball,        ///< in a ball
  sphere,      ///< on a sphere
  digits_6,    ///< of a cube's lattice, turned, rounded to 6 digits
  digits_8,    ///< likewise to 8
  single,      ///< likewise to single precision
  whole,       ///< of a lattice of whole numbers, many in one plane or line
  near_equal,  ///< few points, each several times, moved by 1e-16 to 1e-7
  near_flat,   ///< in a plane but for 1e-16 to 1e-4
  flat_faces,  ///< on the faces and edges of a turned box, but for 1e-16 to 1e-7
  prism,       ///< rings of a regular prism, with points amid its ends and sides
  disc,        ///< rings of a disc of 1e-6 to 1e-2 of its width
  aspect,      ///< in a turned box of aspects to 1e6
  clusters,    ///< a few clusters of 1e-12 to 1e-1
  far,         ///< a ball, a prism or a lattice 1 to 1e6 sizes from the origin
  magnitudes,  ///< coordinates of all magnitudes from 1e-12 on
  planes,      ///< in three planes and on three lines
  tolerance,   ///< a turned lattice, moved by 1e-7 to 1e-4: about what counts as coplanar
  count
};

const char* name_of(HullFamily family);

struct HullPoints {
  std::vector<Vec3> points;
  double unit;  ///< m; a power of two of which all coordinates are whole multiples
};

/// The n-th set of a family: 4 to 30 points, of every fortieth set up to 200. Sizes are 2^-20 to 2^20 m. The
/// unit is 2^-56 of the size.
HullPoints make_points(HullFamily family, std::uint64_t n);

}  // namespace scree::oracle
