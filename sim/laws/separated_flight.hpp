// Bodies in flight that a plane keeps apart, whichever way the normal of their contact points.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/separating_face.hpp"
#include "sim/laws/body_flight.hpp"

#include <cmath>

namespace scree {

/// The plane along a face of one of two bodies that separates them at `begin` (s), to within what counts as
/// closed, and that their flights approach slowly, if at all, until `end`. Such two do not collide, whatever
/// normal their nearest features have: what comes over the seam of two boxes that lie level does not run into
/// the side of the second one. Accelerations are left out, since nothing holds in flight what rests; slow is
/// what they add in twice a substep, as for bounces. Boundaries are not convex, and no plane separates them
/// from what they hold; and of what turns far nothing is known in between. `seen_i`, `seen_j`: where the
/// bodies are at an instant from `begin` to `end`.
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

/// Whether a plane separates them all the while that they are in flight, and so their meeting at the time
/// given (s) is none.
SCREE_HD inline bool pass_by(const PairFlight& pair, double begin, double meeting) {
  return separating_face(pair, begin, pair.until, instant_of(pair.i, meeting).solid,
                         instant_of(pair.j, meeting).solid)
      .exists();
}

}  // namespace scree
