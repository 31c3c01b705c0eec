#include "sim/dynamics/meeting.hpp"

#include "core/tolerances.hpp"
#include "narrowphase/narrow_phase.hpp"
#include "narrowphase/tube.hpp"
#include "sim/dynamics/flight.hpp"
#include "sim/dynamics/rotation.hpp"

#include <algorithm>
#include <utility>

namespace scree {

namespace {

Vec3 axis_of(const BodyFlight& body) { return body.orientation * Vec3::UnitZ(); }

/// Part of a boundary's spin that moves its surfaces (rad/s): not that about its own axis.
Vec3 tilting_spin(const BodyFlight& boundary) {
  const Vec3 axis = axis_of(boundary);
  return boundary.spin - axis.dot(boundary.spin) * axis;
}

bool is_ball(const BodyFlight& body) { return body.shape == Shape::sphere; }

/// Bound on how fast turning moves a body's surface where it is nearest to a partner whose every point is
/// within `far` of the body's centre (m/s).
double fastest_turn(const BodyFlight& body, double far) {
  if (is_ball(body)) return 0;
  if (is_boundary(body.shape)) return tilting_spin(body).norm() * far;
  return fastest_spin(body.orientation, body.spin, body.inverse_inertia) *
         bounding_radius(body.shape, body.size);
}

/// Position, velocity and acceleration of j relative to i.
Flight relative_flight(const BodyFlight& i, const BodyFlight& j) {
  return {j.position - i.position, j.acceleration - i.acceleration};
}

Meeting next_of_balls(const PairFlight& pair, double earliest) {
  const double step = 2 * pair.i.midpoint;
  const BallImpact next = next_ball_impact({.flight = relative_flight(pair.i, pair.j),
                                            .velocity = pair.j.velocity - pair.i.velocity,
                                            .touching = pair.i.size.x() + pair.j.size.x()},
                                           step, earliest);
  if (!(next.time <= pair.until) || !pair.counts(0, -next.speed, next.time)) return {};
  return {.time = next.time, .part = 0};
}

/// A ball and a plane that moves along but keeps its normal.
Meeting next_of_ball_and_plane(const PairFlight& pair, int part, const BodyFlight& ball, const Vec3& point,
                               const Vec3& normal, const BodyFlight& plane, double earliest) {
  const Flight flight = relative_flight(plane, ball);
  const Vec3 velocity = ball.velocity - plane.velocity;
  const double a = normal.dot(flight.acceleration);
  const double u = normal.dot(velocity) + a * earliest;
  const Vec3 offset = ball.position - point + (earliest - ball.midpoint) * velocity +
                      (0.5 * earliest * earliest) * flight.acceleration;
  const double gap = normal.dot(offset) - ball.size.x();
  // A ball that leaves is at the surface at the latest now, whatever rounding says: it may come back.
  const double s = earliest + time_of_impact(u > 0 ? std::max(gap, DBL_MIN) : gap, u, a);
  if (!(s <= pair.until) || !pair.counts(part, -(u + a * (s - earliest)), s)) return {};
  return {.time = s, .part = part};
}

Meeting next_of_ball_in_tube(const PairFlight& pair, const BodyFlight& ball, const BodyFlight& tube,
                             double earliest) {
  const Vec3 axis = axis_of(tube);
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
  if (wall.time <= pair.until && pair.counts(tube_wall, wall.speed, wall.time))
    first = {.time = wall.time, .part = tube_wall};
  for (const TubePart cap : {tube_cap_below, tube_cap_above}) {
    const double side = cap == tube_cap_below ? -1.0 : 1.0;
    const Meeting meeting = next_of_ball_and_plane(
        pair, cap, ball, tube.position + side * tube.size.z() * axis, -side * axis, tube, earliest);
    if (meeting.time < first.time) first = meeting;
  }
  return first;
}

/// A pair at one instant of the search.
struct Look {
  bool near = false;                   // within reach
  double gap = HUGE_VAL;               // smallest of the points whose part may count (m)
  double closing = 0;                  // approach there (m/s)
  bool hit = false;                    // at some point that touches the approach counts
  int part = 0;                        // of that point
  bool rests[PairFlight::parts] = {};  // parts where a point touches whose approach does not count
};

class Search {
 public:
  Search(const PairFlight& pair, double fastest)
      : pair_(pair),
        fastest_(fastest),
        size_(std::min(smallest_size(pair.i.shape, pair.i.size), smallest_size(pair.j.shape, pair.j.size))) {}

  Meeting run(double earliest) {
    double s = earliest;
    Look now = look(s);
    for (int iteration = 0; now.near && iteration < most_iterations; ++iteration) {
      if (now.hit) return {.time = s, .part = now.part};
      settle(now);
      if (s >= pair_.until) return {};
      const double next = std::min(s + step_from(now), pair_.until);
      const Look then = look(next);
      const double level = std::min(now.gap, 0.0);
      if (then.hit) {
        if (then.gap >= level - touching()) return {.time = next, .part = then.part};
        // Where it reaches that gap, unless it is not fast enough there yet.
        const auto [touch, at] = bisect(s, now, next, then, level);
        return at.hit ? Meeting{.time = touch, .part = at.part} : Meeting{.time = next, .part = then.part};
      }
      s = next;
      now = then;
    }
    return {};
  }

 private:
  static constexpr int most_iterations = 1000;
  static constexpr int most_bisections = 60;

  double touching() const { return tolerance::touching_gap * size_; }

  /// A part that has touched slowly bears load from then on, and does not bounce.
  void settle(const Look& now) {
    for (int part = 0; part < PairFlight::parts; ++part) {
      if (now.rests[part]) pair_.slowest[part] = HUGE_VAL;
    }
  }

  Look look(double s) const {
    const BodyInstant i = instant_of(pair_.i, s);
    const BodyInstant j = instant_of(pair_.j, s);
    Manifold manifolds[max_pair_manifolds];
    const double reach = fastest_ * (pair_.until - s) + 2 * touching();
    const int count = find_pair_contacts(pair_.i.shape, i.solid, pair_.j.shape, j.solid, reach, manifolds);
    Look look;
    for (int m = 0; m < count; ++m) {
      const int part = manifolds[m].part;
      if (pair_.slowest[part] == HUGE_VAL && pair_.farthest == HUGE_VAL) continue;
      for (int k = 0; k < manifolds[m].count; ++k) {
        const ContactPoint& point = manifolds[m].points[k];
        const double gap = point.gap;
        const double closing = closing_speed(manifolds[m].normal, point.position, i, j);
        look.near = true;
        if (gap < look.gap) {
          look.gap = gap;
          look.closing = closing;
        }
        if (gap > touching()) continue;
        if (!look.hit && pair_.counts(part, closing, s)) {
          look.hit = true;
          look.part = part;
        }
        look.rests[part] = look.rests[part] || (closing > 0 && !pair_.counts(part, closing, s));
      }
    }
    return look;
  }

  /// As far as the gap lasts at the fastest approach; more where that is next to nothing.
  double step_from(const Look& now) const {
    const double safe = std::max(now.gap, 0.0) / fastest_;
    const double least = tolerance::search_advance * size_ / fastest_;
    if (now.closing > 0 && now.gap > touching())
      return std::max(safe, std::min(now.gap / now.closing, least));
    return std::max(safe, least);
  }

  /// Where the gap falls through the level between two instants, from above.
  std::pair<double, Look> bisect(double from, const Look& before, double to, Look after, double level) const {
    double excess = before.gap - level;
    for (int k = 0; k < most_bisections && after.gap < level - touching(); ++k) {
      // Every other one is a secant's, kept off the ends.
      const double share = k % 2 == 0 ? std::clamp(excess / (excess + level - after.gap), 0.05, 0.95) : 0.5;
      const double middle = from + share * (to - from);
      if (!(middle > from && middle < to)) break;
      const Look at = look(middle);
      if (at.gap > level) {
        from = middle;
        excess = at.gap - level;
      } else {
        to = middle;
        after = at;
      }
    }
    return {to, after};
  }

  PairFlight pair_;
  double fastest_;
  double size_;
};

}  // namespace

BodyInstant instant_of(const BodyFlight& flight, double s) {
  BodyInstant now{
      {flight.position_at(s), flight.orientation, flight.size}, flight.velocity_at(s), flight.spin};
  if (!flight.spin.isZero(0)) {
    rotate_freely(now.solid.orientation, now.spin, flight.inverse_inertia, s - flight.midpoint);
  }
  return now;
}

double closing_speed(const Vec3& normal, const Vec3& point, const BodyInstant& i, const BodyInstant& j) {
  return normal.dot(i.velocity_at(point) - j.velocity_at(point));
}

double fastest_turn(const BodyFlight& flight) {
  if (is_boundary(flight.shape) && !tilting_spin(flight).isZero(0)) return HUGE_VAL;
  return fastest_turn(flight, 0.0);
}

double fastest_approach(const PairFlight& pair) {
  // To a plane that keeps its normal, only what is along it.
  Vec3 normal = Vec3::Zero();
  for (const BodyFlight* body : {&pair.i, &pair.j}) {
    if (body->shape == Shape::plane && tilting_spin(*body).isZero(0)) normal = axis_of(*body);
  }
  const auto speed = [&normal](const Vec3& v) { return normal.isZero(0) ? v.norm() : fabs(normal.dot(v)); };
  const double linear = speed(pair.j.velocity - pair.i.velocity) +
                        speed(pair.j.acceleration - pair.i.acceleration) * pair.until;
  // Of a boundary that tilts: how far from its centre the partner may be. Others do not ask.
  const auto far = [&](const BodyFlight& partner) {
    return is_boundary(partner.shape) ? 0.0
                                      : (pair.j.position - pair.i.position).norm() + linear * pair.until +
                                            bounding_radius(partner.shape, partner.size);
  };
  return linear + fastest_turn(pair.i, far(pair.j)) + fastest_turn(pair.j, far(pair.i));
}

Meeting next_meeting(const PairFlight& pair, double earliest) {
  if (is_ball(pair.i) && is_ball(pair.j)) return next_of_balls(pair, earliest);
  const bool ball_first = is_ball(pair.i);
  const BodyFlight& ball = ball_first ? pair.i : pair.j;
  const BodyFlight& other = ball_first ? pair.j : pair.i;
  if (is_ball(ball) && is_boundary(other.shape) && tilting_spin(other).isZero(0)) {
    if (other.shape == Shape::tube) return next_of_ball_in_tube(pair, ball, other, earliest);
    return next_of_ball_and_plane(pair, 0, ball, other.position, axis_of(other), other, earliest);
  }
  const double fastest = fastest_approach(pair);
  if (!(fastest * (pair.until - earliest) > 0)) return {};
  return Search(pair, fastest).run(earliest);
}

bool contact_at(const BodyInstant& i, Shape shape_i, const BodyInstant& j, Shape shape_j, int part,
                double reach, Manifold& out) {
  Manifold manifolds[max_pair_manifolds];
  const int count = find_pair_contacts(shape_i, i.solid, shape_j, j.solid, reach, manifolds);
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
