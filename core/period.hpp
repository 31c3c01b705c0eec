// A periodic space: along some of the axes, everything repeats after a period.
#pragma once

#include "core/math.hpp"

namespace scree {

/// The periods of a space. The coordinates of bodies are not wrapped when they pass through a period; only
/// relative positions are taken to the nearest image.
struct Period {
  Vec3 low = Vec3::Zero();         ///< lower corner of the cell (m)
  Vec3 length = Vec3::Zero();      ///< period (m); 0 along an axis without one
  Vec3 per_length = Vec3::Zero();  ///< inverse of the period (1/m); 0 along an axis without one
  /// How far from its surface a body may search for others (m), so that any two bodies meet through one image
  /// only.
  double most_margin = HUGE_VAL;
  bool exists = false;

  SCREE_HD bool is_along(int axis) const { return length[axis] > 0; }

  /// Returns the shortest of the vectors from one place to the images of another, given one of these vectors
  /// (m).
  SCREE_HD Vec3 nearest(const Vec3& offset) const {
    Vec3 near = offset;
    make_nearest(near);
    return near;
  }
  SCREE_HD void make_nearest(Vec3& offset) const {
    if (!exists) return;
    for (int a = 0; a < 3; ++a) offset[a] -= length[a] * rint(offset[a] * per_length[a]);
  }
  /// Moves a place to its image that is nearest to another place.
  SCREE_HD void bring_near(const Vec3& other, Vec3& place) const {
    if (!exists) return;
    for (int a = 0; a < 3; ++a) place[a] -= length[a] * rint((place[a] - other[a]) * per_length[a]);
  }
  /// Moves a place to its image in the cell.
  SCREE_HD void wrap(Vec3& place) const {
    if (!exists) return;
    for (int a = 0; a < 3; ++a) place[a] -= length[a] * floor((place[a] - low[a]) * per_length[a]);
  }
};

/// Returns the period of a space that repeats along the axes whose length (m) is not 0.
inline Period period_of(const Vec3& low, const Vec3& length) {
  Period period{.low = low, .length = length, .per_length = Vec3::Zero(), .most_margin = HUGE_VAL};
  for (int a = 0; a < 3; ++a) {
    if (!(length[a] > 0)) continue;
    period.per_length[a] = 1 / length[a];
    period.exists = true;
  }
  return period;
}

}  // namespace scree
