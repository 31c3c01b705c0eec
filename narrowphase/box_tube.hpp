// The contacts of a box in a tube: the contact points are corners of the box.
#pragma once

#include "narrowphase/box_plane.hpp"
#include "narrowphase/tube.hpp"

namespace scree {

/// Finds the contacts of a box in a tube. The distance from the axis is a convex function, so no point of the
/// box is nearer to the wall than its corners. Each corner at the wall has its own normal.
SCREE_HD inline int box_tube(const Solid& box, const Solid& tube, double margin, Manifold* out) {
  const Mat3 tube_axes = tube.orientation.toRotationMatrix();
  const Solid body = detail::relative_to(tube, box);
  if (!detail::is_in_tube(tube, tube_axes, body.position, margin)) return 0;
  const Mat3 axes = box.orientation.toRotationMatrix();
  int count = 0;
  for (int c = 0; c < 8; ++c) {
    const BoxCorner corner = box_corner(body, axes, c);
    count += detail::wall_contact(tube, tube_axes, corner.position, 0.0, corner.feature, margin, out[count]);
  }
  for (const TubePart cap : {tube_cap_below, tube_cap_above}) {
    if (!box_plane(body, detail::tube_cap(tube, tube_axes, cap), margin, out[count])) continue;
    out[count++].part = cap;
  }
  return detail::place_at(tube, count, out);
}

}  // namespace scree
