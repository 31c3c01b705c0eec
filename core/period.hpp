// A space that repeats: along some of the axes, everything is there again a period further on.
#pragma once

#include "core/math.hpp"

namespace scree {

/// The periods of a space. Bodies count on when they go through one; only where they are relative to one
/// another is taken to the nearest image.
struct Period {
  Vec3 low = Vec3::Zero();         ///< lower corner of the cell (m)
  Vec3 length = Vec3::Zero();      ///< m; 0 along an axis without a period
  Vec3 per_length = Vec3::Zero();  ///< 1/m; likewise
  /// How far from its surface a body may look for others (m): two that do so meet through one image alone.
  double most_margin = HUGE_VAL;
  bool exists = false;

  SCREE_HD bool is_along(int axis) const { return length[axis] > 0; }

  /// From one place to the nearest image of another, of the way to any of its images (m).
  SCREE_HD Vec3 nearest(const Vec3& offset) const {
    Vec3 near = offset;
    make_nearest(near);
    return near;
  }
  SCREE_HD void make_nearest(Vec3& offset) const {
    if (!exists) return;
    for (int a = 0; a < 3; ++a) offset[a] -= length[a] * rint(offset[a] * per_length[a]);
  }
  /// Moves a place to that of its images that is nearest to another place.
  SCREE_HD void bring_near(const Vec3& other, Vec3& place) const {
    if (!exists) return;
    for (int a = 0; a < 3; ++a) place[a] -= length[a] * rint((place[a] - other[a]) * per_length[a]);
  }
  /// Moves a place to that of its images that is in the cell.
  SCREE_HD void wrap(Vec3& place) const {
    if (!exists) return;
    for (int a = 0; a < 3; ++a) place[a] -= length[a] * floor((place[a] - low[a]) * per_length[a]);
  }
};

/// Along the axes whose length is not 0 (m).
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
