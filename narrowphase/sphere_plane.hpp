// The contact of a sphere and the half space below a plane.
#pragma once

#include "narrowphase/solid.hpp"

namespace scree {

SCREE_HD inline bool sphere_plane(const Solid& sphere, const Solid& plane, double margin, Manifold& out) {
  const double radius = sphere.size.x();
  const Vec3 up = plane.orientation * Vec3::UnitZ();
  const double height = up.dot(sphere.position - plane.position);
  const double gap = height - radius;
  if (gap > margin) return false;
  set_single(out, -up, {sphere.position - 0.5 * (radius + height) * up, gap, only_feature});
  return true;
}

}  // namespace scree
