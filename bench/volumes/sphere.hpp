// The sphere around a box.
#pragma once

#include "bench/volumes/rounding.hpp"

namespace scree::bench {

struct Sphere {
  Vec3f centre;
  float radius;  ///< radius (m)
};

class SphereFit {
 public:
  static constexpr const char* name = "sphere";
  /// Fits the sphere around a box with these half extents and all that is within `margin` of it (m).
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
