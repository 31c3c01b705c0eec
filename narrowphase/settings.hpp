// What a scene may say about the narrow phase.
#pragma once

namespace scree {

enum class BoxBoxMethod {
  automatic,  ///< the measured best
  sat,        ///< 15 separating axes
  ccd_gjk,    ///< libccd's GJK and EPA
  ccd_mpr,    ///< libccd's Minkowski portal refinement
};

/// For capsules, cylinders and polyhedra, with each other and with spheres and boxes.
enum class ConvexMethod {
  automatic,  ///< the measured best
  axes,       ///< faces, edges and nearest points
  ccd_gjk,    ///< libccd's GJK and EPA
  ccd_mpr,    ///< libccd's Minkowski portal refinement
};

struct NarrowPhaseSettings {
  BoxBoxMethod box_box = BoxBoxMethod::automatic;
  ConvexMethod convex = ConvexMethod::automatic;
  double crosscheck = 0;  ///< share of the pairs that libccd could decide which it is asked about too
};

}  // namespace scree
