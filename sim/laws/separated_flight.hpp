// Bodies in flight that a plane separates, whatever the normal of their contact points.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/separating_face.hpp"
#include "sim/laws/body_flight.hpp"

#include <cmath>

namespace scree {

/// Finds the plane along a face of one of two bodies that separates them at `begin` (s), to within the gap
/// that counts as closed, and that their flights approach slowly, or not at all, until `end`. Two such bodies
/// do not collide, whatever normal their nearest features have: a body that passes over the seam of two level
/// boxes does not run into the side of the second one. Accelerations are left out, since nothing holds a
/// resting body in flight; slow is the speed that they add in two substeps, as for bounces. Boundaries have
/// no such plane, since they are not convex and no plane separates them from the bodies inside. Neither has a
/// body that turns far, since nothing is known of its flight in between. `seen_i`, `seen_j`: the bodies at an
/// instant from `begin` to `end`.
[[gnu::noinline]] SCREE_HD inline SeparatingFace separating_face(PairFlight pair, double begin, double end,
                                                                 const Solid& seen_i, const Solid& seen_j) {
  if (!have_edges(pair.i.shape, pair.j.shape)) return {};
  const auto turns_far = [&](const BodyFlight& body) {
    return !body.is_ball() && body.spin.norm() * (end - begin) > tolerance::far_turn;
  };
  if (turns_far(pair.i) || turns_far(pair.j)) return {};
  const double slack = tolerance::closed_gap * pair.smaller_size();
  const bool faster = pair.i.acceleration.squaredNorm() > pair.j.acceleration.squaredNorm();
  const Vec3 slow = tolerance::restitution_threshold * 2 * pair.i.midpoint *
                    (faster ? pair.i.acceleration : pair.j.acceleration);
  const auto motion = [begin, end](BodyFlight& flight, const Solid& seen) {
    flight.acceleration.setZero();
    return Instants<ShapedSolid>{{flight.shape, instant_of(flight, begin).solid},
                                 {flight.shape, seen},
                                 {flight.shape, instant_of(flight, end).solid}};
  };
  return find_separating_face(motion(pair.i, seen_i), motion(pair.j, seen_j), pair.shapes, slack,
                              (end - begin) * slow);
}

/// Returns whether a plane separates the bodies during their whole flight, so that their meeting at the given
/// time (s) does not count.
SCREE_HD inline bool pass_by(const PairFlight& pair, double begin, double meeting) {
  if (!have_edges(pair.i.shape, pair.j.shape)) return false;
  return separating_face(pair, begin, pair.until, instant_of(pair.i, meeting).solid,
                         instant_of(pair.j, meeting).solid)
      .exists();
}

}  // namespace scree
