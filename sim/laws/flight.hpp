// Flight inside a substep, and the times at which two balls meet and at which a ball meets the wall of a
// tube.
#pragma once

#include "core/math.hpp"
#include "core/tolerances.hpp"

#include <cfloat>

namespace scree {

/// Returns the first s >= 0 at which gap + u s + a s^2 / 2 = 0, for gap > 0; 0 for gap <= 0; infinite if
/// there is none. gap in m, u in m/s, a in m/s^2, s in s.
SCREE_HD inline double time_of_impact(double gap, double u, double a) {
  if (gap <= 0) return 0;
  const double discriminant = u * u - 2 * a * gap;
  if (discriminant < 0) return HUGE_VAL;
  // The root has two forms; each case uses the one without cancellation.
  const double root = sqrt(discriminant);
  if (u > 0) return a < 0 ? (u + root) / -a : HUGE_VAL;
  return root > u ? 2 * gap / (root - u) : HUGE_VAL;
}

/// The path of a body; at() returns its position at the time s into a substep (s).
struct Flight {
  Vec3 position;      ///< position at the midpoint, without the displacement by the acceleration (m)
  Vec3 acceleration;  ///< acceleration by gravity and applied forces; 0 for bodies that are not free (m/s^2)

  SCREE_HD Vec3 at(const Vec3& velocity, double step, double s) const {
    return position + (s - 0.5 * step) * velocity + (0.5 * s * s) * acceleration;
  }
};

/// The flight of the second of two balls relative to the first.
struct FlightOfBalls {
  Flight flight;
  Vec3 velocity;
  double touching;  ///< sum of the radii (m)
};

struct BallImpact {
  double time = HUGE_VAL;  ///< time into the substep (s)
  Vec3 normal;             ///< unit vector from the first centre to the second at that time
  double speed;            ///< relative velocity along the normal, negative (m/s)
};

/// Finds when two balls meet, at `earliest` or later. The time is infinite if they do not meet, or if they
/// separate at first. The distance of balls in straight flight is convex in time, so Newton's method
/// approaches the first meeting from before, until only rounding is left. If both balls have the same
/// acceleration, the squared distance is quadratic in time, and its root replaces the first step. Time,
/// normal and speed belong to one instant: an impulse along the midpoint's normal would turn the balls.
SCREE_HD inline BallImpact next_ball_impact(const FlightOfBalls& balls, double step, double earliest) {
  constexpr int most_iterations = 32;
  const bool is_straight = balls.flight.acceleration.isZero(0);
  BallImpact impact;
  double s = earliest;
  double last_change = HUGE_VAL;
  for (int iteration = 0; iteration <= most_iterations; ++iteration) {
    const Vec3 d = balls.flight.at(balls.velocity, step, s);
    const double distance = d.norm();
    impact.normal = distance > 0 ? Vec3(d / distance) : Vec3(Vec3::UnitZ());
    impact.speed = impact.normal.dot(balls.velocity + s * balls.flight.acceleration);
    if (!(impact.speed < 0)) return {};
    double change = (balls.touching - distance) / impact.speed;
    const bool overlap_at_first = iteration == 0 && change <= 0;
    const bool is_rounding = fabs(change) >= last_change &&
                             fabs(distance - balls.touching) <= tolerance::impact_distance * distance;
    if (overlap_at_first || fabs(change) <= tolerance::impact_time * step || is_rounding ||
        iteration == most_iterations)
      break;
    if (iteration == 0 && is_straight) {
      const double gap = 0.5 * (distance - balls.touching) * (distance + balls.touching);
      change = time_of_impact(gap, d.dot(balls.velocity), balls.velocity.squaredNorm());
      if (change == HUGE_VAL) return {};
    }
    last_change = fabs(change);
    s = fmax(earliest, s + change);
  }
  impact.time = s;
  return impact;
}

/// The flight of a ball in a tube, projected along the axis: its centre relative to the axis.
struct FlightInTube {
  Flight flight;
  Vec3 velocity;
  double reach;  ///< distance of the centre from the axis where the ball touches the wall (m)
};

struct WallImpact {
  double time = HUGE_VAL;  ///< time into the substep (s)
  Vec3 outward;            ///< unit vector from the axis to where the ball touches
  double speed = 0;        ///< speed at which the ball meets the wall (m/s)
};

/// Finds when the centre leaves the circle of radius `reach`, at `earliest` or later; the time is infinite if
/// it does not. The normal there is not the one at the midpoint, and the gap along the latter is of no use: a
/// ball that slides past the wall at the midpoint strikes it farther on. Seen from the centre's place at
/// `earliest`, the squared distance is quadratic in time except for higher orders of gravity; these are left
/// to Newton's method.
SCREE_HD inline WallImpact next_wall_impact(const FlightInTube& ball, double step, double earliest) {
  WallImpact impact;
  if (ball.reach <= 0) return impact;
  double s = earliest;
  Vec3 e = ball.flight.at(ball.velocity, step, s);
  Vec3 w = ball.velocity + s * ball.flight.acceleration;
  const double outward = e.dot(w);
  const double inside = 0.5 * (ball.reach * ball.reach - e.squaredNorm());
  // A ball that has just bounced is at the wall and leaves it: its next impact is at the end of its chord.
  const double gap = outward < 0 ? fmax(inside, DBL_MIN) : inside;
  s += time_of_impact(gap, -outward, -(w.squaredNorm() + e.dot(ball.flight.acceleration)));
  if (s == HUGE_VAL) return impact;
  for (int iteration = 0; iteration < 8; ++iteration) {
    e = ball.flight.at(ball.velocity, step, s);
    w = ball.velocity + s * ball.flight.acceleration;
    if (!(e.dot(w) > 0)) return impact;
    const double change = 0.5 * (ball.reach * ball.reach - e.squaredNorm()) / e.dot(w);
    if (s + change <= earliest) break;
    s += change;
    if (fabs(change) <= tolerance::impact_time * step) break;
  }
  e = ball.flight.at(ball.velocity, step, s);
  w = ball.velocity + s * ball.flight.acceleration;
  impact.time = s;
  impact.outward = e.normalized();
  impact.speed = impact.outward.dot(w);
  return impact;
}

}  // namespace scree
