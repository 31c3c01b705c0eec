// The contact of two spheres.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/solid.hpp"

namespace scree {

SCREE_HD inline bool sphere_sphere(const Solid& a, const Solid& b, double margin, Manifold& out) {
  const double reach = a.size.x() + b.size.x();
  const Vec3 offset = b.position - a.position;
  const double distance = offset.norm();
  const double gap = distance - reach;
  if (gap > margin) return false;
  // Coincident centres give no direction; any fixed one will do.
  const Vec3 normal =
      distance > tolerance::coincident * reach ? Vec3(offset / distance) : Vec3(Vec3::UnitZ());
  // This form gives the same point whichever of the two spheres comes first.
  const Vec3 on_a = a.position + a.size.x() * normal;
  const Vec3 on_b = b.position - b.size.x() * normal;
  set_single(out, normal, {0.5 * (on_a + on_b), gap, only_feature});
  return true;
}

}  // namespace scree
