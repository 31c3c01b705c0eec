// The solution of one impact at its own time, in either space.
#pragma once

#include "core/tolerances.hpp"
#include "sim/impacts/flight_stage.hpp"
#include "sim/impacts/struck_walls.hpp"
#include "sim/laws/impulse_energy.hpp"
#include "sim/laws/rolling.hpp"
#include "sim/laws/rotation.hpp"

#include <algorithm>

namespace scree {

/// The impulse of an impact: it acts on body j, and its opposite on i.
struct Impact {
  std::int32_t i, j;
  Vec3 impulse;  ///< impulse on j (N s)
  Vec3 point;    ///< place where it acts (m)
};

/// The state of a body before its first impact of the flight.
struct StruckBody {
  std::int32_t body;
  Vec3 position;
  Quat orientation;
  Vec3 velocity, spin;
  double clock;
};

SCREE_HD inline StruckBody before_impacts(const FlightStage& stage, std::int32_t body) {
  const BodyView& bodies = stage.bodies;
  return {body,
          bodies.position[body],
          bodies.orientation[body],
          bodies.velocity[body],
          bodies.spin[body],
          stage.clock[body]};
}

/// Puts a body back to its saved state.
SCREE_HD inline void restore(const StruckBody& saved, const BodyView& bodies, View<double> clock) {
  bodies.position[saved.body] = saved.position;
  bodies.orientation[saved.body] = saved.orientation;
  bodies.velocity[saved.body] = saved.velocity;
  bodies.spin[saved.body] = saved.spin;
  clock[saved.body] = saved.clock;
}

/// Rolling friction in an impact.
struct RollingCouple {
  double reach = 0;  ///< largest couple for each unit of normal impulse (m); 0: nothing rolls
  Vec3 couple;       ///< couple on j; its opposite acts on i (N m s)
  Vec3 before;       ///< spin of j relative to i before the impact (rad/s)

  /// Returns Moved::square of the couple (J). `i` and `j` are the bodies after the impact.
  SCREE_HD double square(const SolverBody& i, const SolverBody& j) const {
    return 0.5 * couple.dot(j.spin - i.spin - before);
  }
};

namespace detail {

/// Returns the state of a body at the impact. Friction alone can turn a ball; without it the ball gets no
/// inverse inertia, so that rounding cannot turn it.
SCREE_HD inline SolverBody struck_body(const FlightStage& stage, std::int32_t body, const BodyInstant& at,
                                       bool rubs) {
  const bool turns = rubs || stage.bodies.shape[body] != Shape::sphere;
  return {at.velocity, at.spin, stage.bodies.inverse_mass[body],
          turns ? world_inverse_inertia(at.solid.orientation, stage.bodies.inverse_inertia[body])
                : Mat3(Mat3::Zero())};
}

SCREE_HD inline bool is_of_balls(const FlightStage& stage, std::int32_t i, std::int32_t j) {
  const auto is_ball = [&](std::int32_t body) {
    return !stage.is_free(body) || stage.bodies.shape[body] == Shape::sphere;
  };
  return is_ball(i) && is_ball(j);
}

/// Solves the impact of two balls. They touch at one point, where W couples nothing: the solution is direct,
/// and cannot gain energy.
SCREE_HD inline void strike_balls(ContactRow& row, const Vec3& before, const Vec3& normal, double friction,
                                  SolverBody& i, SolverBody& j) {
  row.impulse = natural_map(row, normal, friction, before);
  row.push(row.impulse, i, j);
}

/// The guides of two bodies. They act after each sweep, since the rows treat a guided body as a free one.
struct PairGuides {
  ConstView<Guide> guides;
  std::int32_t i, j;

  SCREE_HD void hold(SolverBody& body_i, SolverBody& body_j) const {
    hold_to_guide(guides, i, body_i.velocity);
    hold_to_guide(guides, j, body_j.velocity);
  }
};

/// Gives a contact the couple against rolling that its normal impulses allow.
SCREE_HD inline void roll(const ContactRow* rows, int count, const Vec3& normal, RollingCouple& rolling,
                          SolverBody& i, SolverBody& j) {
  double pn = 0;
  for (int k = 0; k < count; ++k) pn += rows[k].impulse.dot(normal);
  const double mass = rolling_mass(i, j, normal);
  const Vec3 couple = rolling_couple(rolling.couple, normal, rolling.reach * pn, mass, j.spin - i.spin);
  turn(couple - rolling.couple, i, j);
  rolling.couple = couple;
}

/// An extrapolation towards the fixed point of a map from the impulses of up to Manifold::max_points points
/// to themselves. Of the last two steps it continues with the combination that would change least (Anderson
/// 1965, with a memory of one). A step that changes more than the last one is taken as it is. No step is
/// continued by more than `farthest` times the last one: far away the bodies' velocities would lose digits
/// that they do not regain.
class ImpulseExtrapolation {
 public:
  /// Sets `change` to what is to be added to `given`. On entry `given` holds the impulses that the map
  /// returned, and `change` their difference from the impulses that the map was given.
  SCREE_HD void extrapolate(const Vec3* given, Vec3* change, int count) {
    constexpr double farthest = 8;
    double along = 0, square = 0, size = 0;
    for (int k = 0; k < count; ++k) {
      const Vec3 bend = change[k] - last_change_[k];
      along += change[k].dot(bend);
      square += bend.squaredNorm();
      size += change[k].squaredNorm();
    }
    const bool goes_on = has_last_ && size < last_size_;
    const double share = goes_on ? fmax(-1.0, fmin(-along / square, farthest)) : 0.0;
    for (int k = 0; k < count; ++k) {
      const Vec3 step = given[k] - last_given_[k];
      last_given_[k] = given[k];
      last_change_[k] = change[k];
      change[k] = share * step;
    }
    last_size_ = size;
    has_last_ = true;
  }

 private:
  bool has_last_ = false;
  double last_size_ = 0;
  Vec3 last_given_[Manifold::max_points] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  Vec3 last_change_[Manifold::max_points] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  static_assert(Manifold::max_points == 4);
};

/// Sweeps over the rows of an impact until only rounding changes the impulses, which does not decrease.
SCREE_HD inline void sweep_impact(ContactRow* rows, const RowCoupling* couplings, int count,
                                  const Vec3& normal, double friction, RollingCouple& rolling,
                                  const PairGuides& guides, SolverBody& i, SolverBody& j) {
  constexpr int most_sweeps = 200;
  double last_change = HUGE_VAL;
  ImpulseExtrapolation extrapolation;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0;
    double size = 0;
    Vec3 changes[Manifold::max_points];
    for (int k = 0; k < count; ++k) changes[k] = rows[k].impulse;
    sweep_rows(rows, couplings, count, normal, friction, i, j);
    if (rolling.reach > 0) roll(rows, count, normal, rolling, i, j);
    guides.hold(i, j);
    Vec3 impulses[Manifold::max_points];
    for (int k = 0; k < count; ++k) {
      impulses[k] = rows[k].impulse;
      changes[k] = impulses[k] - changes[k];
      change += changes[k].norm();
      size += impulses[k].norm();
    }
    if (change <= tolerance::impact_residual * size) break;
    if (change >= last_change && change <= tolerance::impact_rounding * size) break;
    last_change = change;
    // The extrapolation does not know couples and guides.
    if (rolling.reach > 0 || guides.guides.size() > 0) continue;
    extrapolation.extrapolate(impulses, changes, count);
    for (int k = 0; k < count; ++k) {
      rows[k].push(changes[k], i, j);
      rows[k].impulse += changes[k];
    }
  }
}

/// Scales the impulses of an impact down if they gain energy. Newton's law with friction can do so at several
/// points, or at one point whose Delassus matrix couples normal and tangents.
SCREE_HD inline void keep_from_gaining(ContactRow* rows, const Vec3* before, int count,
                                       RollingCouple& rolling, const PairGuides& guides, SolverBody& i,
                                       SolverBody& j) {
  Moved moved;
  for (int k = 0; k < count; ++k) {
    moved.linear += rows[k].impulse.dot(before[k]);
    moved.square += 0.5 * rows[k].impulse.dot(rows[k].relative_velocity(i, j) - before[k]);
  }
  if (rolling.reach > 0) {
    moved.linear += rolling.couple.dot(rolling.before);
    moved.square += rolling.square(i, j);
  }
  if (!moved.gains(tolerance::impact_gain)) return;
  const double scale = moved.scale_without_gain();
  if (rolling.reach > 0) {
    turn((scale - 1) * rolling.couple, i, j);
    rolling.couple *= scale;
  }
  for (int k = 0; k < count; ++k) {
    rows[k].push((scale - 1) * rows[k].impulse, i, j);
    rows[k].impulse *= scale;
  }
  guides.hold(i, j);
}

/// Gives a flight the orientation and the spin that the body has at `s` after an impact, turned back from
/// there to the midpoint.
SCREE_HD inline void turn_on(BodyFlight& next, const Quat& orientation, const Vec3& spin, double s) {
  next.orientation = orientation;
  next.spin = spin;
  rotate_freely(next.orientation, next.spin, next.inverse_inertia, next.midpoint - s);
}

/// Returns how much larger the energy of rotation is in one flight than in another (J).
SCREE_HD inline double energy_gained(const BodyFlight& next, const BodyFlight& flown) {
  return rotational_energy(next.orientation, next.spin, next.inverse_inertia) -
         rotational_energy(flown.orientation, flown.spin, flown.inverse_inertia);
}

}  // namespace detail

/// An impact that is solved at one configuration, but not yet applied to its bodies.
struct SolvedImpact {
  std::int32_t i, j;
  double time;
  BodyFlight flight_i, flight_j;
  BodyInstant at_i, at_j;
  SolverBody after_i, after_j;
  Vec3 normal;
  Vec3 at[Manifold::max_points];            ///< points that close (m)
  ContactRow rows[Manifold::max_points];    ///< rows of these points
  Vec3 before[Manifold::max_points];        ///< relative velocities at these points before the impact (m/s)
  std::int32_t wall[Manifold::max_points];  ///< StruckPoints::wall of these points
  int count;
  RollingCouple rolling;
  double restitution;

  /// Returns the impulse on j; its opposite acts on i.
  SCREE_HD Vec3 impulse() const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < count; ++k) sum += rows[k].impulse;
    return sum;
  }
  /// Returns the part of the impact between the bodies of the pair itself.
  SCREE_HD Impact of_pair() const { return of_points(StruckPoints::own, i, j); }
  /// Returns whether a point is the first of those on another wall than that of the pair.
  SCREE_HD bool is_first_of_wall(int point) const {
    bool first = wall[point] != StruckPoints::own;
    for (int k = 0; k < point; ++k) first = first && wall[k] != wall[point];
    return first;
  }
  /// Returns the part of the impact between the free body of the pair and another wall.
  SCREE_HD Impact of_wall(std::int32_t other) const {
    const bool free_i = after_i.is_free();
    const std::int32_t body = free_i ? i : j;
    Impact impact = of_points(other, std::min(body, other), std::max(body, other));
    if (free_i != (body < other)) impact.impulse = -impact.impulse;
    return impact;
  }
  SCREE_HD Ledger moved() const {
    Ledger ledger;
    for (int k = 0; k < count; ++k) ledger = ledger + account(rows[k], normal, before[k], after_i, after_j);
    if (rolling.reach > 0) ledger = ledger + account_couple(rolling.couple, rolling.before, after_i, after_j);
    return ledger;
  }

 private:
  SCREE_HD Impact of_points(std::int32_t whose, std::int32_t first, std::int32_t second) const {
    Vec3 impulse = Vec3::Zero();
    Vec3 middle = Vec3::Zero();
    int points = 0;
    for (int k = 0; k < count; ++k) {
      if (wall[k] != whose) continue;
      impulse += rows[k].impulse;
      middle += at[k];
      ++points;
    }
    return {.i = first, .j = second, .impulse = impulse, .point = points > 0 ? Vec3(middle / points) : at[0]};
  }
};

namespace detail {

/// Adds the points on other walls that the free body of the pair strikes in the same plane. A ball has only
/// one point, and needs no others.
template <class OtherWalls>
SCREE_HD void add_other_walls(const FlightStage& stage, const SolvedImpact& of, const Vec3& normal,
                              const OtherWalls& other_walls, StruckPoints& points) {
  const bool free_i = stage.is_free(of.i);
  if (free_i == stage.is_free(of.j)) return;
  const std::int32_t body = free_i ? of.i : of.j;
  if (stage.bodies.shape[body] == Shape::sphere) return;
  const WallStrike strike{.body = body,
                          .wall = free_i ? of.j : of.i,
                          .normal = free_i ? Vec3(-normal) : normal,
                          .time = of.time,
                          .flight = free_i ? of.flight_i : of.flight_j,
                          .at_body = free_i ? of.at_i : of.at_j,
                          .at_wall = free_i ? of.at_j : of.at_i};
  other_walls([&](std::int32_t wall, int part) { add_wall(stage, strike, wall, part, points); });
  points.keep_widest(normal);
}

/// Makes the rows of the points that close, sets the velocities before the impact, and returns the largest
/// closing speed (m/s).
SCREE_HD inline double make_rows(const Vec3& normal, const StruckPoints& points, bool of_balls,
                                 SolvedImpact& out, RowCoupling (&couplings)[Manifold::max_points]) {
  double fastest = 0;
  for (int k = 0; k < points.count; ++k) {
    const Vec3& point = points.at[k];
    const Vec3 arm_i = point - out.at_i.solid.position;
    const Vec3 arm_j = point - out.at_j.solid.position;
    out.rows[k] = of_balls ? make_ball_row(arm_i, arm_j, 0.0, out.after_i, out.after_j)
                           : make_row(normal, arm_i, arm_j, 0.0, out.after_i, out.after_j, couplings[k]);
    out.before[k] = out.rows[k].relative_velocity(out.after_i, out.after_j);
    out.at[k] = point;
    out.wall[k] = points.wall[k];
    fastest = std::max(fastest, closing_speed(normal, point, out.at_i, out.at_j));
  }
  return fastest;
}

}  // namespace detail

/// Solves an impact by Newton's law u+ = -e u- at all points that touch and close, with Coulomb friction.
/// `loads`: the loads of the pair, as LoadedParts. `other_walls(then)` calls then(wall, part) for each other
/// body that is not free and that the free body of the pair meets. Returns false if no point closes.
template <class Loads, class OtherWalls>
SCREE_HD bool solve_impact(const FlightStage& stage, std::int32_t i, std::int32_t j, const Meeting& meeting,
                           const Loads& loads, const OtherWalls& other_walls, SolvedImpact& out) {
  const double s = meeting.time;
  out.i = i;
  out.j = j;
  out.time = s;
  out.flight_i = stage.flight(i);
  out.flight_j = stage.flight(j);
  stage.bodies.period.bring_near(out.flight_i.position, out.flight_j.position);
  out.at_i = instant_of(out.flight_i, s);
  out.at_j = instant_of(out.flight_j, s);
  const double touching =
      tolerance::closed_gap * std::min(smallest_size(out.flight_i.shape, out.flight_i.size),
                                       smallest_size(out.flight_j.shape, out.flight_j.size));
  Manifold m;
  if (!contact_at(out.at_i, out.flight_i.shape, out.at_j, out.flight_j.shape, stage.shapes_of(i, j),
                  meeting.part, touching, m))
    return false;
  const PairLaw& law = stage.terms.laws.between(i, j);
  const double friction = stage.parameters.friction ? law.friction : 0.0;
  out.normal = m.normal;
  SolverBody& a = out.after_i;
  SolverBody& b = out.after_j;
  out.rolling.reach = stage.parameters.rolling_friction ? stage.terms.laws.rolling_reach(i, j) : 0.0;
  const bool rolls = out.rolling.reach > 0;
  a = detail::struck_body(stage, i, out.at_i, friction > 0 || rolls);
  b = detail::struck_body(stage, j, out.at_j, friction > 0 || rolls);
  out.rolling.couple.setZero();
  out.rolling.before = b.spin - a.spin;
  // With a rolling couple, the point of two balls couples, too.
  const bool of_balls = !rolls && detail::is_of_balls(stage, i, j);
  StruckPoints points;
  for (int k = 0; k < m.count; ++k) {
    if (closing_speed(m.normal, m.points[k].position, out.at_i, out.at_j) > 0)
      points.add(m.normal, m.points[k].position, StruckPoints::own);
  }
  if (points.count == 0) return false;
  detail::add_other_walls(stage, out, m.normal, other_walls, points);
  RowCoupling couplings[Manifold::max_points];
  const double fastest = detail::make_rows(m.normal, points, of_balls, out, couplings);
  const int count = out.count = points.count;
  const double slowest =
      stage.slowest_bounce(i, j) + fabs(m.normal.dot(sinking_velocity(out.flight_i, out.flight_j)));
  const bool bounces = fastest > slowest && !loads.is_loaded(meeting.part) &&
                       std::max(stage.budget_used[i], stage.budget_used[j]) < bounces_end;
  out.restitution = bounces ? law.restitution : 0.0;
  for (int k = 0; k < count; ++k) out.rows[k].target = -out.restitution * out.before[k].dot(m.normal);
  if (of_balls) {
    detail::strike_balls(out.rows[0], out.before[0], m.normal, friction, a, b);
  } else {
    const detail::PairGuides guides{stage.parameters.guides, i, j};
    detail::sweep_impact(out.rows, couplings, count, m.normal, friction, out.rolling, guides, a, b);
    detail::keep_from_gaining(out.rows, out.before, count, out.rolling, guides, a, b);
  }
  return true;
}

/// Gives a body the flight that leads on from the impact. Returns the drift of its energy by turning to the
/// impact and back (J).
SCREE_HD inline double fly_on(const FlightStage& stage, std::int32_t body, const BodyFlight& flown,
                              const BodyInstant& at, const SolverBody& after, double s) {
  if (!after.is_free()) return 0;
  const Vec3 kick = stage.kick_of(body);
  const Vec3 velocity = after.velocity - s * flown.acceleration;
  BodyFlight next = flown;
  next.velocity = velocity + kick;
  stage.bodies.position[body] -= (s - flown.midpoint) * (velocity - flown.velocity);
  stage.bodies.velocity[body] = next.velocity;
  stage.clock[body] = s;
  double drift = 0;
  if (stage.parameters.rotation) {
    detail::turn_on(next, at.solid.orientation, after.spin, s);
    // With equal moments the energy stays as it is in flight, and nothing drifts.
    if (!has_equal_moments(flown.inverse_inertia)) {
      const double given = rotational_energy(at.solid.orientation, after.spin, flown.inverse_inertia) -
                           rotational_energy(at.solid.orientation, at.spin, flown.inverse_inertia);
      drift = detail::energy_gained(next, flown) - given;
    }
    stage.bodies.orientation[body] = next.orientation;
    stage.bodies.spin[body] = next.spin;
  }
  next.velocity -= kick;  // so that adding the kick later rounds in the same way
  stage.bound(body, next);
  return drift;
}

/// Adds the cost of an impact to both bodies' budgets. An impact with a much lighter body costs nothing.
SCREE_HD inline void count_impact_cost(const FlightStage& stage, const SolvedImpact& solved) {
  const auto charge = [&](std::int32_t body, std::int32_t other) {
    if (!stage.is_free(body) || stage.is_heavy_to(body, other)) return;
    stage.budget_used[body] += impact_cost(solved.restitution);
  };
  charge(solved.i, solved.j);
  charge(solved.j, solved.i);
}

/// Gives both bodies the flights that lead on from an impact. Returns the ledger of what the impact moved.
SCREE_HD inline Ledger fly_on(const FlightStage& stage, const SolvedImpact& solved, Impact& impact) {
  impact = solved.of_pair();
  count_impact_cost(stage, solved);
  Ledger moved = solved.moved();
  moved.integration += fly_on(stage, solved.i, solved.flight_i, solved.at_i, solved.after_i, solved.time) +
                       fly_on(stage, solved.j, solved.flight_j, solved.at_j, solved.after_j, solved.time);
  return moved;
}

}  // namespace scree
