// The sphere-swept volumes around a box: a sphere swept along a segment (a capsule) and over a rectangle
// (Larsen, Gottschalk, Lin and Manocha 1999; Ericson 2005, section 4.5). Two volumes overlap if the distance
// of their segments or rectangles is no more than the sum of their radii. The distance is computed in double,
// since the coordinates of the closest points of nearly parallel edges lose half of their digits.
#pragma once

#include "bench/volumes/rounding.hpp"

#include <algorithm>

namespace scree::bench {

/// A rectangle along the two longer axes of a box, and the radius of the sphere swept over it (m).
struct SweptFit {
  Vec3 along;   ///< half a side, in the box's frame
  Vec3 across;  ///< half the other side, in the box's frame; 0: the sphere is swept along a segment
  double radius;
};

/// Returns the fit of least volume that holds a box with half extents `half` (m). It must hold the corners of
/// the box: if the sides are shorter than those of the box by x and y, the radius is sqrt(x^2 + y^2 + z^2),
/// where z is the shortest half extent. For the segment, y is the whole second half extent.
SweptFit fit_swept_sphere(const Vec3& half, bool over_rectangle);

/// Returns the volume (m^3). `along` and `across` are half sides.
inline double swept_volume(double along, double across, double radius) {
  return 8 * along * across * radius + 2 * pi * radius * radius * (along + across) +
         4.0 / 3.0 * pi * radius * radius * radius;
}

struct Capsule {
  Vec3f centre;
  Vec3f along;   ///< half the segment (m)
  float radius;  ///< radius (m)
};

class CapsuleFit {
 public:
  static constexpr const char* name = "capsule";
  CapsuleFit(const Vec3& half, double margin) : fit_(fit_swept_sphere(half, false)), margin_(margin) {}

  Capsule place(const Vec3& position, const Quat& orientation) const {
    const RoundedVector centre(position), along(orientation * fit_.along);
    return {centre.at, along.at, grown(fit_.radius + margin_, centre.off + along.off)};
  }

 private:
  SweptFit fit_;
  double margin_;
};

/// Returns the squared distance of the segments p + s u and q + t v for s, t in [-1, 1], where between = p -
/// q (m^2). As in Ericson 2005, section 5.1.9, it takes the closest point of the lines, then that of each
/// segment to the other's. If the lines are parallel to rounding, the first point selects the ends that are
/// closest.
inline double squared_distance(const Vec3& between, const Vec3& u, const Vec3& v) {
  constexpr double parallel = 1e-15;  // squared sine that counts as rounding
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double on_u = u.dot(between), on_v = v.dot(between);
  const auto quotient = [](double a, double b) { return b > 0 ? std::clamp(a / b, -1.0, 1.0) : 0.0; };
  const double on_lines = quotient(uv * on_v - vv * on_u, std::max(uu * vv - uv * uv, parallel * uu * vv));
  const double t = quotient(uv * on_lines + on_v, vv);
  const double s = quotient(uv * t - on_u, uu);
  return (between + s * u - t * v).squaredNorm();
}

inline double squared_reach(float radius_a, float radius_b) {
  const double reach = static_cast<double>(radius_a) + static_cast<double>(radius_b);
  return reach * reach;
}

inline bool overlap(const Capsule& a, const Capsule& b) {
  const Vec3 between = (a.centre.cast<double>() - b.centre.cast<double>());
  return squared_distance(between, a.along.cast<double>(), b.along.cast<double>()) <=
         squared_reach(a.radius, b.radius);
}

inline double volume_of(const Capsule& capsule) {
  return swept_volume(static_cast<double>(capsule.along.norm()), 0, capsule.radius);
}

inline Aabb box_of(const Capsule& capsule) {
  return box_around(capsule.centre, capsule.along.cast<double>().cwiseAbs() + Vec3::Constant(capsule.radius));
}

struct SweptRectangle {
  Vec3f centre;
  Vec3f along, across;  ///< half the sides (m)
  float radius;         ///< radius (m)
};

class SweptRectangleFit {
 public:
  static constexpr const char* name = "rectangle-swept";
  SweptRectangleFit(const Vec3& half, double margin) : fit_(fit_swept_sphere(half, true)), margin_(margin) {}

  SweptRectangle place(const Vec3& position, const Quat& orientation) const {
    const Mat3 axes = orientation.toRotationMatrix();
    const RoundedVector centre(position), along(axes * fit_.along), across(axes * fit_.across);
    return {centre.at, along.at, across.at,
            grown(fit_.radius + margin_, centre.off + along.off + across.off)};
  }

 private:
  SweptFit fit_;
  double margin_;
};

bool overlap(const SweptRectangle& a, const SweptRectangle& b);

inline double volume_of(const SweptRectangle& volume) {
  return swept_volume(static_cast<double>(volume.along.norm()), static_cast<double>(volume.across.norm()),
                      volume.radius);
}

inline Aabb box_of(const SweptRectangle& volume) {
  return box_around(volume.centre, volume.along.cast<double>().cwiseAbs() +
                                       volume.across.cast<double>().cwiseAbs() +
                                       Vec3::Constant(volume.radius));
}

}  // namespace scree::bench
