// The bodies of one flight and their state, as the search for impacts uses them, in either space.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/space_prefetch.hpp"
#include "core/space_unroll.hpp"
#include "core/tolerances.hpp"
#include "sim/impacts/meeting.hpp"
#include "sim/laws/contact_laws.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/laws/separated_flight.hpp"

#include <algorithm>
#include <cstdint>

namespace scree {

/// The impact budget of a body in a flight. A body that is caught between others would bounce ever faster
/// (Zeno), so each impact has a cost. A body whose impacts have cost `bounces_end` does not bounce any more
/// (e^k has fallen to 1/1000 then, after 4 to 64 impacts). A body whose impacts have cost `impacts_end` has
/// no more impacts: the contacts of the substep hold it.
inline constexpr double bounces_end = 8;
inline constexpr double impacts_end = 16;
SCREE_HD inline double impact_cost(double restitution) {
  return fmax(0.125, fmin(-bounces_end / 3 * log10(fmax(restitution, 0.01)), 2.0));
}

/// The terms of one flight. A flight ends with the substep.
struct FlightTerms {
  ContactLaws laws;
  double step;  ///< length of the substep (s)
  /// Start of the flight, into the substep (s). It is 0 for the first flight. In a second flight the response
  /// has kicked the bodies already, and a body that was struck after `from` starts at its last impact.
  double from;
  bool bounces;  ///< whether approaches faster than the threshold count; if not, only deep approaches do
};

/// The parts of a pair that carried an impulse in the last substep: these do not bounce.
struct LoadedParts {
  std::uint8_t bits = 0;  ///< one bit for each part

  SCREE_HD bool is_loaded(int part) const { return (bits >> part & 1) != 0; }
};

/// The values that a flight keeps for each body.
template <class Space>
struct FlightLog {
  Array<double, Space> clock;        ///< time of its last impact (s); the start of the flight if it had none
  Array<double, Space> budget_used;  ///< cost of its impacts so far, by impact_cost()
  Array<double, Space> turn_speed;   ///< bound on the speed that rotation gives its surface (m/s)
  Array<double, Space> top_speed;    ///< bound on its surface's speed, without what gravity adds (m/s)
  Array<double, Space> radius;       ///< bounding_radius(); infinite for a boundary (m)
  /// The value is 1 for a body that bore load together with another free body in the last substep. The array
  /// is empty if there is no such body, or if the flight ignores them.
  Array<std::uint32_t, Space> bore_load;

  void resize(std::int64_t bodies) {
    clock.resize(bodies);
    budget_used.resize(bodies);
    turn_speed.resize(bodies);
    top_speed.resize(bodies);
    radius.resize(bodies);
  }
};

/// The limits that decide which approaches of two bodies count as impacts.
struct ImpactLimits {
  double earliest;  ///< earliest time of an impact, into the substep (s)
  double left;      ///< time from `earliest` to the end of the substep (s)
  double slowest;   ///< speed over which an approach bounces (m/s)
  double farthest;  ///< distance over which an approach until the end is deep (m)

  SCREE_HD bool may_bounce(double speed) const { return speed > slowest; }
  SCREE_HD bool may_go_deep(double speed) const { return speed * left > farthest; }
  SCREE_HD bool may_count(double speed) const { return may_bounce(speed) || may_go_deep(speed); }
};

/// The bodies in flight, with the results of their impacts so far. It is cheap to copy; the caller owns the
/// bodies and the log.
struct FlightStage {
  template <class Space>
  FlightStage(const FlightTerms& t, const ResponseParameters& r, const BodyView& b, FlightLog<Space>& log)
      : terms(t),
        parameters(r),
        bodies(b),
        clock(log.clock.view()),
        budget_used(log.budget_used.view()),
        turn_speed(log.turn_speed.view()),
        top_speed(log.top_speed.view()),
        radius(log.radius.view()),
        bore_load(log.bore_load.view()) {}

  FlightTerms terms;
  ResponseParameters parameters;
  BodyView bodies;
  View<double> clock;
  View<double> budget_used;
  View<double> turn_speed;
  View<double> top_speed;
  View<double> radius;
  View<std::uint32_t> bore_load;
  double least_impact_speed = -1;  ///< two bodies whose top speeds sum to no more have no impact (m/s)

  SCREE_HD bool is_free(std::int32_t body) const { return bodies.mobility[body] == Mobility::free; }
  SCREE_HD bool is_absent(std::int64_t body) const { return bodies.mobility[body] == Mobility::absent; }
  /// Returns whether a body is so heavy that an impact with the other one hardly moves it.
  SCREE_HD bool is_heavy_to(std::int32_t body, std::int32_t other) const {
    return is_free(body) && tolerance::heavy_ratio * bodies.inverse_mass[body] <= bodies.inverse_mass[other];
  }
  SCREE_HD bool has_late_impact(std::int32_t body) const { return clock[body] > 0.5 * terms.step; }
  /// Returns whether both bodies bore load in the last substep. Such bodies bounce in the response, together
  /// with their contacts. One by one, their impacts would come in a chaotic order.
  SCREE_HD bool both_bore_load(std::int32_t i, std::int32_t j) const {
    return bore_load.size() > 0 && bore_load[i] != 0 && bore_load[j] != 0;
  }

  /// On a GPU, starts to load all that is known of a body: what is asked of two bodies in flight stands
  /// behind many branches.
  SCREE_HD void load_ahead(std::int32_t body) const {
    if constexpr (is_gpu_code) {
      const auto load = [body](const auto&... of) { (prefetch_whole(of[body]), ...); };
      load(bodies.position, bodies.orientation, bodies.velocity, bodies.spin, bodies.size,
           bodies.inverse_mass, bodies.inverse_inertia, bodies.shape, bodies.mobility, bodies.material,
           bodies.id);
      load(clock, budget_used, turn_speed, top_speed, radius);
      if (bore_load.size() > 0) load(bore_load);
    }
  }

  /// Returns the part of the substep's kick that the velocity of a body contains already (m/s).
  SCREE_HD Vec3 kick_of(std::int32_t body) const {
    return terms.from > 0 && is_free(body) ? Vec3(terms.step * parameters.acceleration_of(body))
                                           : Vec3(Vec3::Zero());
  }

  SCREE_HD BodyFlight flight(std::int32_t body) const {
    return {.shape = bodies.shape[body],
            .size = bodies.size[body],
            .inverse_inertia = bodies.inverse_inertia[body],
            .position = bodies.position[body],
            .orientation = bodies.orientation[body],
            .velocity = bodies.velocity[body] - kick_of(body),
            .spin = parameters.rotation || !is_free(body) ? bodies.spin[body] : Vec3(Vec3::Zero()),
            .acceleration = is_free(body) ? parameters.acceleration_of(body) : Vec3(Vec3::Zero()),
            .midpoint = 0.5 * terms.step};
  }

  /// Returns the speed over which an approach bounces on a part without load, apart from sinking_velocity()
  /// (m/s).
  SCREE_HD double slowest_bounce(std::int32_t i, std::int32_t j) const {
    const double restitution = terms.laws.between(i, j).restitution;
    if (!parameters.restitution || restitution == 0) return HUGE_VAL;
    const double rounding =
        tolerance::closing_speed * (bodies.velocity[i].norm() + bodies.velocity[j].norm());
    return std::max(parameters.restitution_threshold.of(restitution), rounding);
  }

  SCREE_HD PairShapes shapes_of(std::int32_t i, std::int32_t j) const {
    return {terms.laws.shape_data(i), terms.laws.shape_data(j)};
  }

  /// Returns the flights of two bodies until a time into the substep (s); no meeting of theirs counts yet.
  SCREE_HD PairFlight pair_of(std::int32_t i, std::int32_t j, double until) const {
    PairFlight pair{.i = flight(i), .j = flight(j), .until = until, .slowest = {}, .shapes = shapes_of(i, j)};
    bodies.period.bring_near(pair.i.position, pair.j.position);
    for (double& slowest : pair.slowest) slowest = HUGE_VAL;
    return pair;
  }

  /// Sets the turn speed, the top speed and the radius of a body in the given flight.
  SCREE_HD void bound(std::int32_t body, const BodyFlight& in) const {
    turn_speed[body] = turn_speed_of(body, in);
    top_speed[body] = top_speed_of(body, in);
    radius[body] = is_boundary(in.shape) ? HUGE_VAL : bounding_radius(in.shape, in.size);
  }
  SCREE_HD void bound(std::int32_t body) const { bound(body, flight(body)); }

  /// Returns the top speed of a body in the given flight, which bound() sets (m/s).
  SCREE_HD double top_speed_of(std::int32_t body, const BodyFlight& in) const {
    if (is_absent(body)) return 0.0;
    const bool gains = parameters.acceleration.size() > 0;
    return in.velocity.norm() + turn_speed_of(body, in) + (gains ? in.acceleration.norm() * terms.step : 0.0);
  }

  /// Returns the length to which the tolerances of a body are relative (m); infinite for absent bodies.
  SCREE_HD double size_of(std::int64_t body) const {
    return is_absent(body) ? HUGE_VAL : smallest_size(bodies.shape[body], bodies.size[body]);
  }

  /// Returns whether the meetings of a body with others need a search (next_meeting), by the turn speed that
  /// bound() has set.
  SCREE_HD bool needs_search(std::int32_t body) const {
    if (is_absent(body) || bodies.shape[body] == Shape::sphere) return false;
    return !is_boundary(bodies.shape[body]) || turn_speed[body] == HUGE_VAL;
  }

  /// Returns the largest possible `least_impact_speed` for the bodies as bound() has set them (m/s): two
  /// bodies whose speeds sum to no more neither go deep nor close fast enough to bounce, even if gravity adds
  /// to their approach. `smallest`: the smallest size_of() (m); `restitution`: the largest of the laws.
  SCREE_HD double find_least_impact_speed(double smallest, double restitution) const {
    double speed = HUGE_VAL;
    if (parameters.continuous) speed = tolerance::deep_approach * smallest / terms.step;
    if (terms.bounces && parameters.restitution)
      speed = std::min(speed, parameters.restitution_threshold.of(restitution));
    return speed - terms.step * parameters.gravity.norm();
  }

  /// Returns whether two bodies, one of which is free, may meet in an impact, without a look at their shapes.
  /// If so, sets the limits of what counts as an impact.
  SCREE_HD bool may_meet(std::int32_t i, std::int32_t j, ImpactLimits& limits) const {
    if (top_speed[i] + top_speed[j] <= least_impact_speed) return false;
    const double linear = linear_approach(i, j);
    if (are_far(i, j, linear) || std::max(budget_used[i], budget_used[j]) >= impacts_end) return false;
    limits.earliest = std::max(clock[i], clock[j]);
    if (!(limits.earliest < terms.step)) return false;
    limits.left = terms.step - limits.earliest;
    limits.slowest = terms.bounces && !both_bore_load(i, j) ? slowest_bounce(i, j) : HUGE_VAL;
    limits.farthest =
        parameters.continuous ? tolerance::deep_approach * terms.laws.smaller_size(i, j) : HUGE_VAL;
    return limits.may_count(linear + turn_speed[i] + turn_speed[j]);
  }

  /// Returns for two bodies that may_meet() whether an impact may count with these loads and whether they
  /// come near each other, by one look at their shapes. Balls are not looked at, since next() costs no more
  /// for them. The function is called and not inlined, so that its many registers are not taken from the
  /// searches.
  template <class Loads>
  [[gnu::noinline]] SCREE_HD bool come_near(std::int32_t i, std::int32_t j, const ImpactLimits& limits,
                                            const Loads& loads) const {
    if (!may_count(i, j, limits, loads, fastest(i, j))) return false;
    if (bodies.shape[i] == Shape::sphere && bodies.shape[j] == Shape::sphere) return true;
    const PairFlight pair = pair_of(i, j, terms.step);
    return may_count(i, j, limits, loads, fastest_approach(pair)) && may_touch(pair, limits.earliest);
  }

  /// Returns the next impact of two bodies, one of which is free. `loads`: the loads of the pair, as
  /// LoadedParts.
  template <class Loads>
  SCREE_HD Meeting next(std::int32_t i, std::int32_t j, const Loads& loads) const {
    ImpactLimits limits;
    if (!may_meet(i, j, limits)) return {};
    PairFlight pair = pair_of(i, j, terms.step);
    const double speed = fastest_approach(pair);
    if (!may_count(i, j, limits, loads, speed)) return {};
    if (limits.may_bounce(speed)) {
      for (int part = 0; part < PairFlight::parts; ++part) {
        if (!loads.is_loaded(part)) pair.slowest[part] = limits.slowest;
      }
    }
    if (limits.may_go_deep(speed)) pair.farthest = limits.farthest;
    pair.sinking = sinking_velocity(pair.i, pair.j);
    const Meeting meeting = next_meeting(pair, limits.earliest);
    return meeting.time < HUGE_VAL && pass_by(pair, limits.earliest, meeting.time) ? Meeting{} : meeting;
  }

 private:
  /// Returns a bound on the speed that rotation gives the surface of a body (m/s).
  SCREE_HD double turn_speed_of(std::int32_t body, const BodyFlight& in) const {
    return is_absent(body) ? 0.0 : fastest_turn(in);
  }
  /// Returns whether an approach at this speed may go deep, or bounce on a part that bears no load.
  template <class Loads>
  SCREE_HD bool may_count(std::int32_t i, std::int32_t j, const ImpactLimits& limits, const Loads& loads,
                          double speed) const {
    if (limits.may_go_deep(speed)) return true;
    if (!limits.may_bounce(speed)) return false;
    const bool has_tube = bodies.shape[i] == Shape::tube || bodies.shape[j] == Shape::tube;
    bool all_loaded = true;
    for (int part = 0; part < (has_tube ? PairFlight::parts : 1); ++part)
      all_loaded = all_loaded && loads.is_loaded(part);
    return !all_loaded;
  }
  /// Returns a bound on how fast two bodies come closer in the substep (m/s).
  SCREE_HD double fastest(std::int32_t i, std::int32_t j) const {
    return linear_approach(i, j) + turn_speed[i] + turn_speed[j];
  }
  /// Returns the part of that bound for the motion of their centres (m/s).
  SCREE_HD double linear_approach(std::int32_t i, std::int32_t j) const {
    Vec3 velocity = bodies.velocity[j] - bodies.velocity[i];
    Vec3 gained = Vec3::Zero();
    if (is_free(i) != is_free(j) || parameters.acceleration.size() > 0) {
      velocity += kick_of(i) - kick_of(j);
      if (is_free(i)) gained -= terms.step * parameters.acceleration_of(i);
      if (is_free(j)) gained += terms.step * parameters.acceleration_of(j);
    }
    return velocity.norm() + gained.norm();
  }

  /// Returns true if two bodies do not come near one another in the substep, with this linear_approach().
  SCREE_HD bool are_far(std::int32_t i, std::int32_t j, double linear) const {
    const double near = radius[i] + radius[j];
    const Vec3 offset = bodies.period.nearest(bodies.position[j] - bodies.position[i]);
    const double half = 0.5 * terms.step;
    if (near == HUGE_VAL)
      return is_boundary(bodies.shape[i]) ? is_far_from_boundary(j, i, offset, linear * half)
                                          : is_far_from_boundary(i, j, -offset, linear * half);
    const double reach = near + (linear + turn_speed[i] + turn_speed[j]) * half;
    return offset.squaredNorm() > reach * reach;
  }
  /// Returns true if a body does not come near the surfaces of a boundary in the substep. `offset`: from the
  /// boundary to the body (m); `travel`: how far the offset changes before or after the midpoint (m).
  SCREE_HD bool is_far_from_boundary(std::int32_t body, std::int32_t boundary, const Vec3& offset,
                                     double travel) const {
    const BodyFlight in = flight(boundary);
    const double half = 0.5 * terms.step;
    const double around = radius[body] + travel + turn_speed[body] * half;
    const double tilts = in.tilting_spin().norm() * half;
    const double room = around + tilts * (offset.norm() + around);
    const Vec3 at = in.orientation.conjugate() * offset;
    if (in.shape == Shape::plane) return at.z() > room;
    return hypot(at.x(), at.y()) + room < in.size.x() && fabs(at.z()) + room < in.size.z();
  }
};

}  // namespace scree
