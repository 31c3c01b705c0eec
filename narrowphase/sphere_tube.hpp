// The contacts of a sphere in a tube: it may touch the wall and both caps.
#pragma once

#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/tube.hpp"

namespace scree {

SCREE_HD inline int sphere_tube(const Solid& sphere, const Solid& tube, double margin, Manifold* out) {
  const Mat3 axes = tube.orientation.toRotationMatrix();
  const Solid ball = detail::relative_to(tube, sphere);
  if (!detail::is_in_tube(tube, axes, ball.position, margin)) return 0;
  int count = 0;
  count += detail::wall_contact(tube, axes, ball.position, ball.size.x(), only_feature, margin, out[0]);
  for (const TubePart cap : {tube_cap_below, tube_cap_above}) {
    if (!sphere_plane(ball, detail::tube_cap(tube, axes, cap), margin, out[count])) continue;
    out[count++].part = cap;
  }
  return detail::place_at(tube, count, out);
}

}  // namespace scree
