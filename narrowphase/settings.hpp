// The settings of the narrow phase that a scene may give.
#pragma once

namespace scree {

enum class BoxBoxMethod {
  automatic,  ///< the method that measured best
  sat,        ///< 15 separating axes
  ccd_gjk,    ///< libccd's GJK and EPA
  ccd_mpr,    ///< libccd's Minkowski portal refinement
};

/// Method for capsules, cylinders and polyhedra, with each other and with spheres and boxes.
enum class ConvexMethod {
  automatic,  ///< the method that measured best
  axes,       ///< search along face normals, edge normals and the direction of the nearest points
  ccd_gjk,    ///< libccd's GJK and EPA
  ccd_mpr,    ///< libccd's Minkowski portal refinement
};

struct NarrowPhaseSettings {
  BoxBoxMethod box_box = BoxBoxMethod::automatic;
  ConvexMethod convex = ConvexMethod::automatic;
  double crosscheck = 0;  ///< share of the pairs that libccd could decide that is also compared with libccd
};

}  // namespace scree
