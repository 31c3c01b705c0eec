// Discrete oriented polytopes: slabs in directions that all bodies share (Klosowski et al. 1998, section 3;
// Ericson 2005, section 4.6). The box is projected anew in each orientation, so that turning does not loosen
// the volume.
#pragma once

#include "bench/volumes/polytope.hpp"
#include "bench/volumes/rounding.hpp"

#include <vector>

namespace scree::bench {

/// The directions of the 14-DOP: the axes, then the diagonals of the cube. The 8-DOP has the diagonals alone.
inline constexpr int dop_directions[7][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                             {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

/// A polytope of slabs lo <= direction * x <= hi, whose directions have the lengths of those above.
template <int faces>
struct Dop {
  static constexpr int slabs = faces / 2;
  static constexpr int first = 7 - slabs;  ///< index of the first direction
  static Vec3 direction(int k) {
    const int* d = dop_directions[first + k];
    return Vec3(d[0], d[1], d[2]);
  }
  /// Returns direction(k) * x, without the products by 0.
  static double along(int k, const Vec3& x) {
    const int* d = dop_directions[first + k];
    return first + k < 3 ? x[first + k] : d[0] * x[0] + d[1] * x[1] + d[2] * x[2];
  }

  float lo[slabs];
  float hi[slabs];
};

template <int faces>
class DopFit {
 public:
  static constexpr const char* name = faces == 8 ? "8-DOP" : "14-DOP";
  DopFit(const Vec3& half, double margin) : half_(half), margin_(margin) {}

  Dop<faces> place(const Vec3& position, const Quat& orientation) const {
    constexpr double rounding = 0x1p-47;  // as in bounds_of(), but for up to three times as many terms
    const Mat3 axes = orientation.toRotationMatrix();
    Dop<faces> dop;
    for (int k = 0; k < Dop<faces>::slabs; ++k) {
      const double centre = Dop<faces>::along(k, position);
      const double length = Dop<faces>::first + k < 3 ? 1 : std::sqrt(3.0);
      double outward = length * margin_ + rounding * (position.lpNorm<1>() + half_.sum() + margin_);
      for (int m = 0; m < 3; ++m) outward += half_[m] * std::fabs(Dop<faces>::along(k, axes.col(m)));
      dop.lo[k] = round_down(centre - outward);
      dop.hi[k] = round_up(centre + outward);
    }
    return dop;
  }

 private:
  Vec3 half_;
  double margin_;
};

template <int faces>
bool overlap(const Dop<faces>& a, const Dop<faces>& b) {
  bool all = true;
  for (int k = 0; k < Dop<faces>::slabs; ++k) all &= (a.lo[k] <= b.hi[k]) & (b.lo[k] <= a.hi[k]);
  return all;
}

template <int faces>
double volume_of(const Dop<faces>& dop) {
  std::vector<Slab> slabs;
  for (int k = 0; k < Dop<faces>::slabs; ++k)
    slabs.push_back({Dop<faces>::direction(k), dop.lo[k], dop.hi[k]});
  return volume_of(slabs);
}

inline Aabb box_of(const Dop<14>& dop) {
  return {{dop.lo[0], dop.lo[1], dop.lo[2]}, {dop.hi[0], dop.hi[1], dop.hi[2]}};
}

/// Returns the box of an 8-DOP. A coordinate is half the sum of two slabs' coordinates, and half the
/// difference of the other two's.
inline Aabb box_of(const Dop<8>& dop) {
  Aabb box;
  for (int a = 0; a < 3; ++a) {
    const int minus = 3 - a, i = 1 + minus % 3, j = 1 + (minus + 1) % 3;
    const double lo[4] = {dop.lo[0], dop.lo[1], dop.lo[2], dop.lo[3]};
    const double hi[4] = {dop.hi[0], dop.hi[1], dop.hi[2], dop.hi[3]};
    box.lo[a] = round_down(0.5 * std::fmax(lo[i] + lo[j], lo[0] - hi[minus]));
    box.hi[a] = round_up(0.5 * std::fmin(hi[i] + hi[j], hi[0] - lo[minus]));
  }
  return box;
}

}  // namespace scree::bench
