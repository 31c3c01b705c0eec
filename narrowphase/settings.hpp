// What a scene may say about the narrow phase.
#pragma once

namespace scree {

enum class BoxBoxMethod {
  automatic,  ///< the measured best
  sat,        ///< 15 separating axes
  ccd_gjk,    ///< libccd's GJK and EPA
  ccd_mpr,    ///< libccd's Minkowski portal refinement
};

struct NarrowPhaseSettings {
  BoxBoxMethod box_box = BoxBoxMethod::automatic;
  double crosscheck = 0;  ///< share of the pairs of boxes that libccd is asked about too
};

}  // namespace scree
