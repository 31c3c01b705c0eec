// A box and the half space below a plane: the contacts are corners of the box.
#pragma once

#include "narrowphase/solid.hpp"

namespace scree {

/// All corners within the margin if they are at most 4; else those of them on the face that looks down most:
/// it holds the deepest corner, and its rectangle has the largest support area of any face that does.
SCREE_HD inline bool box_plane(const Solid& box, const Solid& plane, double margin, Manifold& out) {
  const Vec3 up = plane.orientation * Vec3::UnitZ();
  const Mat3 axes = box.orientation.toRotationMatrix();
  const double height = up.dot(box.position - plane.position);
  const Vec3 slope = axes.transpose() * up;
  const Vec3 arm = slope.cwiseProduct(box.size);  // height of each half edge
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
