// The boxes around a box: along the world's axes (AABB), as in the broad phase, and along the box's own axes
// (OBB).
#pragma once

#include "bench/volumes/rounding.hpp"

namespace scree::bench {

class AabbFit {
 public:
  static constexpr const char* name = "AABB";
  AabbFit(const Vec3& half, double margin) : half_(half), margin_(margin) {}

  Aabb place(const Vec3& position, const Quat& orientation) const {
    return bounds_of({Shape::box, position, orientation, half_}, margin_, Vec3::Zero());
  }

 private:
  Vec3 half_;
  double margin_;
};

inline double volume_of(const Aabb& box) {
  double volume = 1;
  for (int a = 0; a < 3; ++a) volume *= static_cast<double>(box.hi[a]) - static_cast<double>(box.lo[a]);
  return volume;
}

inline Aabb box_of(const Aabb& box) { return box; }

struct Obb {
  Vec3f centre;
  Eigen::Matrix3f axes;  ///< axes of the box in the world, as columns
  Vec3f half;            ///< half extents (m)
};

class ObbFit {
 public:
  static constexpr const char* name = "OBB";
  ObbFit(const Vec3& half, double margin)
      : half_(half.array() + margin), rounding_(float_rounding * half_.norm()) {}

  Obb place(const Vec3& position, const Quat& orientation) const {
    const RoundedVector centre(position);
    Obb box{centre.at, orientation.toRotationMatrix().cast<float>(), {}};
    for (int k = 0; k < 3; ++k) box.half[k] = round_up(half_[k] + centre.off + rounding_);
    return box;
  }

 private:
  Vec3 half_;
  double rounding_;  ///< rounding of the axes and of the tests (m)
};

/// Tests the 15 axes (Gottschalk, Lin and Manocha 1996, section 5; Ericson 2005, section 4.4.1). The axes of
/// pairs of edges are not normalised. The half extents cover the rounding that is proportional to the length
/// of these axes. The other rounding is added to the cosines here; this also prevents parallel edges from
/// separating boxes by rounding alone.
inline bool overlap(const Obb& a, const Obb& b) {
  Eigen::Matrix3f turn, size;  // the axes of b in the frame of a; their absolute values
  Vec3f offset;                // along a's axes
  const Vec3f between = b.centre - a.centre;
  for (int i = 0; i < 3; ++i) {
    turn.row(i) = a.axes.col(i).transpose() * b.axes;
    size.row(i) = turn.row(i).cwiseAbs().array() + static_cast<float>(float_rounding);
    offset[i] = a.axes.col(i).dot(between);
    if (std::fabs(offset[i]) > a.half[i] + size.row(i).dot(b.half)) return false;
  }
  for (int j = 0; j < 3; ++j) {
    if (std::fabs(turn.col(j).dot(offset)) > size.col(j).dot(a.half) + b.half[j]) return false;
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const float reach = a.half[i1] * size(i2, j) + a.half[i2] * size(i1, j) + b.half[j1] * size(i, j2) +
                          b.half[j2] * size(i, j1);
      if (std::fabs(offset[i2] * turn(i1, j) - offset[i1] * turn(i2, j)) > reach) return false;
    }
  }
  return true;
}

inline double volume_of(const Obb& box) { return 8 * box.half.cast<double>().prod(); }

inline Aabb box_of(const Obb& box) {
  return box_around(box.centre, box.axes.cast<double>().cwiseAbs() * box.half.cast<double>());
}

}  // namespace scree::bench
