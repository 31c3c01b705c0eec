// One impact, at its own time, in either space.
#pragma once

#include "core/tolerances.hpp"
#include "sim/dynamics/flight_stage.hpp"
#include "sim/dynamics/rotation.hpp"

#include <algorithm>

namespace scree {

/// What an impact gave to body j, and reversed to i.
struct Impact {
  std::int32_t i, j;
  Vec3 impulse;  ///< N s
  Vec3 point;    ///< m
};

/// A body before its first impact of the flight.
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

/// Puts a body back to where it was.
SCREE_HD inline void restore(const StruckBody& saved, const BodyView& bodies, View<double> clock) {
  bodies.position[saved.body] = saved.position;
  bodies.orientation[saved.body] = saved.orientation;
  bodies.velocity[saved.body] = saved.velocity;
  bodies.spin[saved.body] = saved.spin;
  clock[saved.body] = saved.clock;
}

namespace detail {

/// Without friction nothing turns a ball, and no rounding may.
SCREE_HD inline SolverBody struck_body(const FlightStage& stage, std::int32_t body, const BodyInstant& at,
                                       double friction) {
  const bool turns = friction > 0 || stage.bodies.shape[body] != Shape::sphere;
  return {at.velocity, at.spin, stage.bodies.inverse_mass[body],
          turns ? world_inverse_inertia(at.solid.orientation, stage.bodies.inverse_inertia[body])
                : Mat3(Mat3::Zero())};
}

SCREE_HD inline void solve_impact(ContactRow* rows, const RowCoupling* couplings, int count,
                                  const Vec3& normal, double friction, SolverBody& i, SolverBody& j) {
  constexpr int most_sweeps = 200;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0;
    double size = 0;
    Vec3 last[Manifold::max_points];
    for (int k = 0; k < count; ++k) last[k] = rows[k].impulse;
    sweep_rows(rows, couplings, count, normal, friction, i, j);
    for (int k = 0; k < count; ++k) {
      change += (rows[k].impulse - last[k]).norm();
      size += rows[k].impulse.norm();
    }
    if (change <= tolerance::impact_residual * size) break;
  }
}

/// Newton's law with friction at several points, or at one whose Delassus matrix couples normal and
/// tangents, can gain energy.
SCREE_HD inline void keep_from_gaining(ContactRow* rows, const Vec3* before, int count, SolverBody& i,
                                       SolverBody& j) {
  Moved moved;
  for (int k = 0; k < count; ++k) {
    moved.linear += rows[k].impulse.dot(before[k]);
    moved.square += 0.5 * rows[k].impulse.dot(rows[k].relative_velocity(i, j) - before[k]);
  }
  if (!moved.gains(tolerance::impact_gain)) return;
  const double scale = moved.scale_without_gain();
  for (int k = 0; k < count; ++k) {
    rows[k].push((scale - 1) * rows[k].impulse, i, j);
    rows[k].impulse *= scale;
  }
}

/// Gives a body the flight that leads from the impact on. Returns the drift of its energy on the way there
/// and back (J).
SCREE_HD inline double fly_on(const FlightStage& stage, std::int32_t body, const BodyFlight& flown,
                              const BodyInstant& at, const SolverBody& after, double s) {
  if (!after.is_free()) return 0;
  const Vec3 velocity = after.velocity - s * flown.acceleration;
  stage.bodies.position[body] -= (s - flown.midpoint) * (velocity - flown.velocity);
  stage.bodies.velocity[body] = velocity + stage.kick_of(body);
  stage.clock[body] = s;
  ++stage.hits[body];
  double drift = 0;
  if (stage.parameters.rotation) {
    const auto energy = [&](const Quat& orientation, const Vec3& spin) {
      return rotational_energy(orientation, spin, flown.inverse_inertia);
    };
    drift = energy(at.solid.orientation, at.spin) - energy(flown.orientation, flown.spin) -
            energy(at.solid.orientation, after.spin);
    stage.bodies.orientation[body] = at.solid.orientation;
    stage.bodies.spin[body] = after.spin;
    rotate_freely(stage.bodies.orientation[body], stage.bodies.spin[body], flown.inverse_inertia,
                  flown.midpoint - s);
    drift += energy(stage.bodies.orientation[body], stage.bodies.spin[body]);
  }
  stage.bound(body);
  return drift;
}

}  // namespace detail

/// Newton's law u+ = -e u- at all points that touch and close, at one configuration, with Coulomb friction;
/// then gives both bodies the flights that lead on from it. `loads` are those of the pair, as LoadedParts.
/// Adds to `ledger` what it moved. False, and nothing has changed, if no point closes.
template <class Loads>
SCREE_HD bool resolve_impact(const FlightStage& stage, std::int32_t i, std::int32_t j, const Meeting& meeting,
                             const Loads& loads, Impact& impact, Ledger& ledger) {
  const double s = meeting.time;
  const BodyFlight flight_i = stage.flight(i);
  const BodyFlight flight_j = stage.flight(j);
  const BodyInstant at_i = instant_of(flight_i, s);
  const BodyInstant at_j = instant_of(flight_j, s);
  const double touching = tolerance::closed_gap * std::min(smallest_size(flight_i.shape, flight_i.size),
                                                           smallest_size(flight_j.shape, flight_j.size));
  Manifold m;
  if (!contact_at(at_i, flight_i.shape, at_j, flight_j.shape, meeting.part, touching, m)) return false;
  const PairLaw& law = stage.terms.laws.between(i, j);
  const double friction = stage.parameters.friction ? law.friction : 0.0;
  SolverBody a = detail::struck_body(stage, i, at_i, friction);
  SolverBody b = detail::struck_body(stage, j, at_j, friction);
  ContactRow rows[Manifold::max_points];
  RowCoupling couplings[Manifold::max_points];
  Vec3 before[Manifold::max_points];
  Vec3 middle = Vec3::Zero();
  double fastest = 0;
  int count = 0;
  for (int k = 0; k < m.count; ++k) {
    const double closing = closing_speed(m.normal, m.points[k].position, at_i, at_j);
    if (!(closing > 0)) continue;
    const Vec3& point = m.points[k].position;
    rows[count] = make_row(m.normal, point - at_i.solid.position, point - at_j.solid.position, 0.0, a, b,
                           couplings[count]);
    before[count] = rows[count].relative_velocity(a, b);
    fastest = std::max(fastest, closing);
    middle += point;
    ++count;
  }
  if (count == 0) return false;
  const bool bounces = fastest > stage.slowest_bounce(i, j) && !loads.is_loaded(meeting.part) &&
                       std::max(stage.hits[i], stage.hits[j]) < most_bounces;
  const double restitution = bounces ? law.restitution : 0.0;
  for (int k = 0; k < count; ++k) rows[k].target = -restitution * before[k].dot(m.normal);
  detail::solve_impact(rows, couplings, count, m.normal, friction, a, b);
  detail::keep_from_gaining(rows, before, count, a, b);
  impact = {.i = i, .j = j, .impulse = Vec3::Zero(), .point = middle / count};
  for (int k = 0; k < count; ++k) {
    ledger = ledger + account(rows[k], m.normal, before[k], a, b);
    impact.impulse += rows[k].impulse;
  }
  ledger.integration +=
      detail::fly_on(stage, i, flight_i, at_i, a, s) + detail::fly_on(stage, j, flight_j, at_j, b, s);
  return true;
}

}  // namespace scree
