// The time and place at which two bodies in flight meet, at any linear and angular speed.
#pragma once

#include "narrowphase/tube.hpp"
#include "sim/impacts/meeting_search.hpp"
#include "sim/laws/flight.hpp"

namespace scree {

namespace detail {

/// Returns the position and the acceleration of j relative to i.
SCREE_HD inline Flight relative_flight(const BodyFlight& i, const BodyFlight& j) {
  return {j.position - i.position, j.acceleration - i.acceleration};
}

SCREE_HD inline Meeting next_of_balls(const PairFlight& pair, double earliest) {
  const double step = 2 * pair.i.midpoint;
  const BallImpact next = next_ball_impact({.flight = relative_flight(pair.i, pair.j),
                                            .velocity = pair.j.velocity - pair.i.velocity,
                                            .touching = pair.i.size.x() + pair.j.size.x()},
                                           step, earliest);
  if (!(next.time <= pair.until) || !pair.counts(0, next.normal, -next.speed, next.time)) return {};
  return {.time = next.time, .part = 0};
}

/// Returns the next meeting of a ball with a plane that moves but keeps its normal.
SCREE_HD inline Meeting next_of_ball_and_plane(const PairFlight& pair, int part, const BodyFlight& ball,
                                               const Vec3& point, const Vec3& normal, const BodyFlight& plane,
                                               double earliest) {
  const Flight flight = relative_flight(plane, ball);
  const Vec3 velocity = ball.velocity - plane.velocity;
  const double a = normal.dot(flight.acceleration);
  const double u = normal.dot(velocity) + a * earliest;
  const Vec3 offset = ball.position - point + (earliest - ball.midpoint) * velocity +
                      (0.5 * earliest * earliest) * flight.acceleration;
  const double gap = normal.dot(offset) - ball.size.x();
  // A ball that touches at rest bears load from then on, and does not bounce.
  const bool rests = u == 0 && gap <= tolerance::touching_gap * ball.size.x();
  if (rests && pair.slowest[part] > 0 && pair.farthest == HUGE_VAL) return {};
  // A ball that leaves is at or above the surface, even if rounding says otherwise: it may come back.
  const double s = earliest + time_of_impact(u > 0 ? std::max(gap, DBL_MIN) : gap, u, a);
  if (!(s <= pair.until) || !pair.counts(part, normal, -(u + a * (s - earliest)), s)) return {};
  return {.time = s, .part = part};
}

SCREE_HD inline Meeting next_of_ball_in_tube(const PairFlight& pair, const BodyFlight& ball,
                                             const BodyFlight& tube, double earliest) {
  const Vec3 axis = tube.axis();
  const auto across = [&axis](const Vec3& v) { return Vec3(v - axis.dot(v) * axis); };
  const Flight flight = relative_flight(tube, ball);
  const Vec3 velocity = ball.velocity - tube.velocity;
  const double step = 2 * ball.midpoint;
  const Vec3 start = flight.at(velocity, step, earliest);
  const double slack = tolerance::contact_slack * ball.size.x();
  if (across(start).norm() > tube.size.x() + slack || fabs(axis.dot(start)) > tube.size.z() + slack)
    return {};
  Meeting first;
  const WallImpact wall = next_wall_impact({.flight = {across(flight.position), across(flight.acceleration)},
                                            .velocity = across(velocity),
                                            .reach = tube.size.x() - ball.size.x()},
                                           step, earliest);
  if (wall.time <= pair.until && pair.counts(tube_wall, wall.outward, wall.speed, wall.time))
    first = {.time = wall.time, .part = tube_wall};
  for (const TubePart cap : {tube_cap_below, tube_cap_above}) {
    const double side = cap == tube_cap_below ? -1.0 : 1.0;
    const Meeting meeting = next_of_ball_and_plane(
        pair, cap, ball, tube.position + side * tube.size.z() * axis, -side * axis, tube, earliest);
    if (meeting.time < first.time) first = meeting;
  }
  return first;
}

}  // namespace detail

/// Returns whether two bodies may touch at `earliest` (s) or later. One look at the middle of the remaining
/// time decides this; it takes the orientations of the midpoint, so that no body has to be turned. Returns
/// true for surfaces: they have one side, and such a look would miss a body that has passed through them by
/// then.
SCREE_HD inline bool may_touch(const PairFlight& pair, double earliest) {
  if (is_surface(pair.i.shape) || is_surface(pair.j.shape)) return true;
  const ApproachBound approach = bound_approach(pair);
  const double middle = 0.5 * (earliest + pair.until);
  const double reach = approach.speed() * (pair.until - middle) +
                       approach.turning() * fabs(middle - pair.i.midpoint) +
                       2 * tolerance::touching_gap * pair.smaller_size();
  const auto solid = [middle](const BodyFlight& body) {
    return Solid{body.position_at(middle), body.orientation, body.size};
  };
  Manifold manifolds[max_pair_manifolds];
  return find_any_contacts({pair.i.shape, solid(pair.i)}, {pair.j.shape, solid(pair.j)}, pair.shapes,
                           {.margin = reach, .hidden = true}, manifolds) > 0;
}

/// Returns the first meeting that counts, at `earliest` (s) or later. Two balls, and a ball with a plane or a
/// tube that does not tilt, have closed forms; all other pairs need a search. `divide`: see
/// MeetingSearch::run.
SCREE_HD inline Meeting next_meeting(const PairFlight& pair, double earliest, double divide = NAN) {
  if (pair.i.is_ball() && pair.j.is_ball()) return detail::next_of_balls(pair, earliest);
  const bool ball_first = pair.i.is_ball();
  const BodyFlight& ball = ball_first ? pair.i : pair.j;
  const BodyFlight& other = ball_first ? pair.j : pair.i;
  if (ball.is_ball() && is_boundary(other.shape) && other.tilting_spin().isZero(0)) {
    if (other.shape == Shape::tube) return detail::next_of_ball_in_tube(pair, ball, other, earliest);
    return detail::next_of_ball_and_plane(pair, 0, ball, other.position, other.axis(), other, earliest);
  }
  const double fastest = fastest_approach(pair);
  if (!(fastest * (pair.until - earliest) > 0)) return {};
  return MeetingSearch(pair, fastest).run(earliest, divide);
}

/// Finds the contact of two bodies at an instant, on the given part. Of the manifolds on that part it takes
/// the one with the smallest gap at a point that closes, or at any point if none closes. Returns false if
/// there is none within `reach` (m).
SCREE_HD inline bool contact_at(const BodyInstant& i, Shape shape_i, const BodyInstant& j, Shape shape_j,
                                const PairShapes& shapes, int part, double reach, Manifold& out) {
  Manifold manifolds[max_pair_manifolds];
  const int count =
      find_any_contacts({shape_i, i.solid}, {shape_j, j.solid}, shapes, {.margin = reach}, manifolds);
  bool found = false;
  bool found_closing = false;
  double least = HUGE_VAL;
  for (int m = 0; m < count; ++m) {
    if (manifolds[m].part != part) continue;
    for (int k = 0; k < manifolds[m].count; ++k) {
      const bool closes = closing_speed(manifolds[m].normal, manifolds[m].points[k].position, i, j) > 0;
      const double gap = manifolds[m].points[k].gap;
      if (closes < found_closing || (closes == found_closing && gap >= least)) continue;
      out = manifolds[m];
      found = true;
      found_closing = closes;
      least = gap;
    }
  }
  return found;
}

}  // namespace scree
