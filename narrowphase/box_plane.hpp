// The contact of a box with the half space below a plane: the contact points are corners of the box.
#pragma once

#include "narrowphase/solid.hpp"

namespace scree {

/// Finds the contact of a box with a plane. If at most 4 corners are within the margin, all of them are
/// contact points. Otherwise only those are that belong to the face that looks down most: this face holds the
/// deepest corner, and no face that holds it has a rectangle with a larger support area.
SCREE_HD inline bool box_plane(const Solid& box, const Solid& plane, double margin, Manifold& out) {
  const Vec3 up = plane.orientation * Vec3::UnitZ();
  const Mat3 axes = box.orientation.toRotationMatrix();
  const double height = up.dot(box.position - plane.position);
  const Vec3 slope = axes.transpose() * up;
  const Vec3 arm = slope.cwiseProduct(box.size);  // height that each half edge spans
  if (height - arm.cwiseAbs().sum() > margin) return false;

  double gap[8];
  int within = 0;
  for (int c = 0; c < 8; ++c) {
    gap[c] = height;
    for (int k = 0; k < 3; ++k) gap[c] += c >> k & 1 ? arm[k] : -arm[k];
    within += gap[c] <= margin;
  }
  int down = 0;  // the axis of the face that looks down
  for (int k = 1; k < 3; ++k) {
    if (fabs(slope[k]) > fabs(slope[down])) down = k;
  }
  const int side = slope[down] > 0.0 ? 0 : 1;

  out.at_edge = false;
  out.normal = -up;
  out.count = 0;
  for (int c = 0; c < 8; ++c) {
    const bool wanted = within <= Manifold::max_points || (c >> down & 1) == side;
    if (gap[c] > margin || !wanted) continue;
    const BoxCorner corner = box_corner(box, axes, c);
    out.points[out.count++] = {corner.position - 0.5 * gap[c] * up, gap[c], corner.feature};
  }
  return out.count > 0;
}

}  // namespace scree
