#include "sim/dynamics/impact.hpp"

#include "core/tolerances.hpp"
#include "sim/dynamics/rotation.hpp"

#include <algorithm>

namespace scree {

namespace {

/// Without friction nothing turns a ball, and no rounding may.
SolverBody solver_body(const FlightStage& stage, std::int32_t body, const BodyInstant& at, double friction) {
  const bool turns = friction > 0 || stage.bodies.shape[body] != Shape::sphere;
  return {at.velocity, at.spin, stage.bodies.inverse_mass[body],
          turns ? world_inverse_inertia(at.solid.orientation, stage.bodies.inverse_inertia[body])
                : Mat3(Mat3::Zero())};
}

void solve(ContactRow* rows, const RowCoupling* couplings, int count, const Vec3& normal, double friction,
           SolverBody& i, SolverBody& j) {
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
void keep_from_gaining(ContactRow* rows, const Vec3* before, int count, SolverBody& i, SolverBody& j) {
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
double fly_on(const FlightStage& stage, std::int32_t body, const BodyFlight& flown, const BodyInstant& at,
              const SolverBody& after, double s) {
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

}  // namespace

bool resolve_impact(const FlightStage& stage, std::int32_t i, std::int32_t j, const Meeting& meeting,
                    Impact& impact, Ledger& ledger) {
  const double s = meeting.time;
  const BodyFlight flight_i = stage.flight(i);
  const BodyFlight flight_j = stage.flight(j);
  const BodyInstant at_i = instant_of(flight_i, s);
  const BodyInstant at_j = instant_of(flight_j, s);
  const double touching = tolerance::closed_gap * std::min(smallest_size(flight_i.shape, flight_i.size),
                                                           smallest_size(flight_j.shape, flight_j.size));
  Manifold m;
  if (!contact_at(at_i, flight_i.shape, at_j, flight_j.shape, meeting.part, touching, m)) return false;
  const PairLaw& law = stage.problem.laws.between(i, j);
  const double friction = stage.parameters.friction ? law.friction : 0.0;
  SolverBody a = solver_body(stage, i, at_i, friction);
  SolverBody b = solver_body(stage, j, at_j, friction);
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
  const bool bounces = fastest > stage.slowest_bounce(i, j) &&
                       !stage.problem.memory.is_loaded(i, j, meeting.part) &&
                       std::max(stage.hits[i], stage.hits[j]) < most_bounces;
  const double restitution = bounces ? law.restitution : 0.0;
  for (int k = 0; k < count; ++k) rows[k].target = -restitution * before[k].dot(m.normal);
  solve(rows, couplings, count, m.normal, friction, a, b);
  keep_from_gaining(rows, before, count, a, b);
  impact = {.i = i, .j = j, .impulse = Vec3::Zero(), .point = middle / count};
  for (int k = 0; k < count; ++k) {
    ledger = ledger + account(rows[k], m.normal, before[k], a, b);
    impact.impulse += rows[k].impulse;
  }
  ledger.integration += fly_on(stage, i, flight_i, at_i, a, s) + fly_on(stage, j, flight_j, at_j, b, s);
  return true;
}

}  // namespace scree
