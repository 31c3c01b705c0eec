// The contact of a sphere and a box, exact in the regions of faces, edges and vertices, and if the sphere's
// centre is inside the box.
#pragma once

#include "narrowphase/solid.hpp"

namespace scree {

namespace detail {

/// Finds the shortest way out of a box for a point inside it: through the nearest face, or along the first
/// axis if several faces are equally near. It sets the direction (box frame) and returns the signed distance
/// to the face (negative, m).
SCREE_HD inline double exit_of(const Vec3& inside, const Vec3& half, Vec3& direction) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (half[k] - fabs(inside[k]) < half[axis] - fabs(inside[axis])) axis = k;
  }
  direction.setZero();
  direction[axis] = sign_of(inside[axis]);
  return fabs(inside[axis]) - half[axis];
}

}  // namespace detail

SCREE_HD inline bool sphere_box(const Solid& sphere, const Solid& box, double margin, Manifold& out) {
  const double radius = sphere.size.x();
  const Mat3 axes = box.orientation.toRotationMatrix();
  const Vec3 centre = axes.transpose() * (sphere.position - box.position);
  const Vec3 nearest = centre.cwiseMax(-box.size).cwiseMin(box.size);
  Vec3 outward = centre - nearest;
  double distance = outward.norm();
  if (distance - radius > margin) return false;
  if (distance > 0.0) {
    outward /= distance;
  } else {
    distance = detail::exit_of(centre, box.size, outward);
  }
  const double gap = distance - radius;
  const Vec3 normal = -(axes * outward);
  set_single(out, normal, {sphere.position + 0.5 * (radius + distance) * normal, gap, only_feature});
  out.at_edge = (centre.array() != nearest.array()).count() > 1;
  return true;
}

}  // namespace scree
