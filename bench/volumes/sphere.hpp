// The sphere around a box.
#pragma once

#include "bench/volumes/rounding.hpp"

namespace scree::bench {

struct Sphere {
  Vec3f centre;
  float radius;  ///< m
};

class SphereFit {
 public:
  static constexpr const char* name = "sphere";
  /// Of boxes with these half extents, and of all that is within `margin` of them (m).
  SphereFit(const Vec3& half, double margin) : radius_(half.norm() + margin) {}

  Sphere place(const Vec3& position, const Quat&) const {
    const RoundedVector centre(position);
    return {centre.at, grown(radius_, centre.off)};
  }

 private:
  double radius_;
};

inline bool overlap(const Sphere& a, const Sphere& b) {
  const float reach = a.radius + b.radius;
  return (b.centre - a.centre).squaredNorm() <= reach * reach;
}

inline double volume_of(const Sphere& sphere) { return 4.0 / 3.0 * pi * std::pow(sphere.radius, 3); }

inline Aabb box_of(const Sphere& sphere) { return box_around(sphere.centre, Vec3::Constant(sphere.radius)); }

}  // namespace scree::bench
