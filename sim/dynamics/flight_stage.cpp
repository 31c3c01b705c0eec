#include "sim/dynamics/flight_stage.hpp"

#include "core/parallel.hpp"
#include "core/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

struct MinusSize {
  BodyView bodies;
  SCREE_HD double operator()(std::int64_t k) const {
    return bodies.mobility[k] == Mobility::absent ? -HUGE_VAL
                                                  : -smallest_size(bodies.shape[k], bodies.size[k]);
  }
};

}  // namespace

double FlightStage::harmless_speed() const {
  double speed = HUGE_VAL;
  if (parameters.continuous) {
    const double size =
        -parallel::max<double, Host>("impact.size", bodies.count(), MinusSize{bodies}, -HUGE_VAL);
    speed = tolerance::deep_approach * size / problem.step;
  }
  if (problem.bounces && parameters.restitution) {
    double largest = 0;
    for (const PairLaw& law : problem.laws.table) largest = std::max(largest, law.restitution);
    speed = std::min(speed, parameters.restitution_threshold.of(largest));
  }
  return speed - problem.step * parameters.gravity.norm();
}

BodyFlight FlightStage::flight(std::int32_t body) const {
  return {.shape = bodies.shape[body],
          .size = bodies.size[body],
          .inverse_inertia = bodies.inverse_inertia[body],
          .position = bodies.position[body],
          .orientation = bodies.orientation[body],
          .velocity = bodies.velocity[body] - kick_of(body),
          .spin = parameters.rotation || !is_free(body) ? bodies.spin[body] : Vec3(Vec3::Zero()),
          .acceleration = is_free(body) ? parameters.acceleration_of(body) : Vec3(Vec3::Zero()),
          .midpoint = 0.5 * problem.step};
}

double FlightStage::slowest_bounce(std::int32_t i, std::int32_t j) const {
  const double restitution = problem.laws.between(i, j).restitution;
  if (!parameters.restitution || restitution == 0) return HUGE_VAL;
  const double rounding = tolerance::closing_speed * (bodies.velocity[i].norm() + bodies.velocity[j].norm());
  return std::max(parameters.restitution_threshold.of(restitution), rounding);
}

PairFlight FlightStage::pair_of(std::int32_t i, std::int32_t j, double until) const {
  PairFlight pair{.i = flight(i), .j = flight(j), .until = until, .slowest = {}};
  std::fill_n(pair.slowest, PairFlight::parts, HUGE_VAL);
  return pair;
}

void FlightStage::bound(std::int32_t body) const {
  const bool absent = bodies.mobility[body] == Mobility::absent;
  turn[body] = absent ? 0.0 : fastest_turn(flight(body));
  const double linear = (bodies.velocity[body] - kick_of(body)).norm();
  const double gained = is_free(body) ? parameters.acceleration_of(body).norm() * problem.step : 0.0;
  top_speed[body] = absent ? 0.0 : linear + turn[body] + (parameters.acceleration.size() > 0 ? gained : 0.0);
  reach[body] = absent ? 0.0 : (linear + gained + turn[body]) * (0.5 * problem.step);
  extent[body] = is_boundary(bodies.shape[body])
                     ? HUGE_VAL
                     : bounding_radius(bodies.shape[body], bodies.size[body]) + reach[body];
}

double FlightStage::fastest(std::int32_t i, std::int32_t j) const {
  Vec3 velocity = bodies.velocity[j] - bodies.velocity[i];
  Vec3 gained = Vec3::Zero();
  if (is_free(i) != is_free(j) || parameters.acceleration.size() > 0) {
    velocity += kick_of(i) - kick_of(j);
    if (is_free(i)) gained -= problem.step * parameters.acceleration_of(i);
    if (is_free(j)) gained += problem.step * parameters.acceleration_of(j);
  }
  return velocity.norm() + gained.norm() + turn[i] + turn[j];
}

bool FlightStage::are_far(std::int32_t i, std::int32_t j) const {
  const double near = extent[i] + extent[j];
  const Vec3 offset = bodies.position[j] - bodies.position[i];
  if (near < HUGE_VAL) return offset.squaredNorm() > near * near;
  const bool boundary_i = is_boundary(bodies.shape[i]);
  const std::int32_t boundary = boundary_i ? i : j;
  if (bodies.shape[boundary] == Shape::tube) return false;
  const Vec3 up = bodies.orientation[boundary] * Vec3::UnitZ();
  return (boundary_i ? 1.0 : -1.0) * up.dot(offset) > extent[boundary_i ? j : i] + reach[boundary];
}

Meeting FlightStage::next(std::int32_t i, std::int32_t j) const {
  if (top_speed[i] + top_speed[j] <= harmless || are_far(i, j) || std::max(hits[i], hits[j]) >= most_hits)
    return {};
  const double earliest = std::max(clock[i], clock[j]);
  if (!(earliest < problem.step)) return {};
  const double farthest = tolerance::deep_approach * problem.laws.smaller_size(i, j);
  const double slowest = problem.bounces ? slowest_bounce(i, j) : HUGE_VAL;
  const auto may_bounce = [&](double speed) { return speed > slowest; };
  const auto may_go_deep = [&](double speed) {
    return parameters.continuous && speed * (problem.step - earliest) > farthest;
  };
  const double bound = fastest(i, j);
  if (!may_bounce(bound) && !may_go_deep(bound)) return {};
  PairFlight pair = pair_of(i, j, problem.step);
  const double speed = fastest_approach(pair);
  if (!may_bounce(speed) && !may_go_deep(speed)) return {};
  if (may_bounce(speed)) {
    for (int part = 0; part < PairFlight::parts; ++part) {
      if (!problem.memory.is_loaded(i, j, part)) pair.slowest[part] = slowest;
    }
  }
  if (may_go_deep(speed)) pair.farthest = farthest;
  return next_meeting(pair, earliest);
}

}  // namespace scree
