// The joint effect of the impacts of many light bodies on one heavy body in the same round, in either space.
//
// Each impact is solved as if it were the only one. Together they would move more energy than the sum of what
// each does by itself, since what they give to the heavy body adds up or cancels out. So all of them are
// scaled by
//
//   x = Q / (Q + C),   C = E(sum of P) - sum of E(P),
//
// where Q is the sum of all p.W p / 2 (J), P is what one impact gives to the heavy body, and E is the energy
// that this gives to it at rest. The energy moved is L x + (Q + C) x^2, where L is the sum of all p.u, and
// this is x (L + Q): x times what the impacts would move one by one. So elastic impacts keep the energy,
// others cannot gain any, and the ledger of each impact is scaled by x as well. Momentum is exact, since each
// impulse acts on both bodies, and scaled impulses stay in Coulomb's cone. A single impact has C = 0. x
// differs from 1 by about the ratio of the light bodies' mass to that of the heavy one.
#pragma once

#include "core/space_atomic.hpp"
#include "sim/impacts/impact.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

namespace scree::detail {

/// The sums of what impacts of lighter bodies give to a heavy one, in units (ImpactGroupUnits).
struct ImpactGroup {
  std::uint64_t fastest;         ///< largest speed of the lighter bodies, as the bits of a double (m/s)
  std::uint64_t momentum[3];     ///< momentum given to the heavy body
  std::uint64_t delayed[3];      ///< sum of momentum times the time of its impact, into the substep
  std::uint64_t angular[3];      ///< angular momentum given to it, about its centre
  std::uint64_t light;           ///< the lighter bodies' share of p.W p / 2
  std::uint64_t own;             ///< the heavy body's share of p.W p / 2
  std::uint64_t turning;         ///< energy that the angular momentum gives, without its quadratic part
  std::uint64_t weight;          ///< sum of the sizes of the impulses
  std::uint64_t delayed_weight;  ///< sum of sizes times the times
  std::uint64_t impacts;
  std::uint64_t first_missing;  ///< first pair of the group, as ~PairNumbers; 0: none
  std::uint64_t place;          ///< place of that pair's impact among all resolved
};

/// The units of the sums. The sums are counted in integers, so that they do not depend on the order of their
/// terms. The units are as fine as the rounding of the body's own state, and leave room for hundreds of times
/// its momentum.
class ImpactGroupUnits {
 public:
  SCREE_HD ImpactGroupUnits(const FlightStage& stage, std::int32_t heavy, const ImpactGroup& impact_group) {
    constexpr double steps = 0x1p54;
    const double speed = std::bit_cast<double>(impact_group.fastest) + stage.top_speed[heavy] +
                         stage.terms.step * stage.parameters.gravity.norm();
    const double size = bounding_radius(stage.bodies.shape[heavy], stage.bodies.size[heavy]);
    momentum = power_over(speed / stage.bodies.inverse_mass[heavy]) / steps;
    delayed = power_over(stage.terms.step) * momentum;
    angular = power_over(size) * momentum;
    energy = power_over(speed) * momentum;
  }

  double momentum, delayed, angular, energy;

 private:
  /// Returns a power of two above x, so that values are rounded only to whole units.
  SCREE_HD static double power_over(double x) { return scalbn(1.0, ilogb(x) + 1); }
};

SCREE_HD inline void add_units(std::uint64_t* sum, double value, double unit) {
  add(sum, static_cast<std::uint64_t>(static_cast<std::int64_t>(rint(value / unit))));
}
SCREE_HD inline double value_of(std::uint64_t sum, double unit) {
  return static_cast<double>(static_cast<std::int64_t>(sum)) * unit;
}
SCREE_HD inline Vec3 value_of(const std::uint64_t (&sum)[3], double unit) {
  return {value_of(sum[0], unit), value_of(sum[1], unit), value_of(sum[2], unit)};
}

/// The heavy one of two bodies in an impact, with what the impact gives to it.
struct HeavySide {
  SCREE_HD HeavySide(const SolvedImpact& solved, bool is_i)
      : at(is_i ? solved.at_i : solved.at_j), after(is_i ? solved.after_i : solved.after_j) {
    const double sign = is_i ? -1 : 1;
    momentum = sign * solved.impulse();
    angular = Vec3::Zero();
    turns = !after.inverse_inertia.isZero(0);
    for (int k = 0; turns && k < solved.count; ++k) {
      const ContactRow& row = solved.rows[k];
      angular += (is_i ? row.arm_i : row.arm_j).cross(sign * row.impulse);
    }
    if (solved.rolling.reach > 0) angular += sign * solved.rolling.couple;
  }

  /// Returns the energy that the impact gives to the body if it is at rest (J).
  SCREE_HD double own_energy() const {
    return 0.5 * (momentum.dot(after.velocity - at.velocity) + angular.dot(after.spin - at.spin));
  }

  const BodyInstant& at;
  const SolverBody& after;
  Vec3 momentum, angular;
  bool turns;
};

/// Adds an impact to the group of its heavy body.
SCREE_HD inline void add_to_impact_group(const FlightStage& stage, std::int32_t heavy,
                                         const SolvedImpact& solved, std::uint64_t pair,
                                         ImpactGroup& impact_group) {
  const ImpactGroupUnits unit(stage, heavy, impact_group);
  const HeavySide side(solved, solved.i == heavy);
  double square = 0;
  for (int k = 0; k < solved.count; ++k) {
    const ContactRow& row = solved.rows[k];
    square += 0.5 * row.impulse.dot(row.relative_velocity(solved.after_i, solved.after_j) - solved.before[k]);
  }
  if (solved.rolling.reach > 0) square += solved.rolling.square(solved.after_i, solved.after_j);
  const double own = side.own_energy();
  for (int axis = 0; axis < 3; ++axis) {
    add_units(&impact_group.momentum[axis], side.momentum[axis], unit.momentum);
    add_units(&impact_group.delayed[axis], side.momentum[axis] * solved.time, unit.delayed);
    add_units(&impact_group.angular[axis], side.angular[axis], unit.angular);
  }
  add_units(&impact_group.light, square - own, unit.energy);
  add_units(&impact_group.own, own, unit.energy);
  add_units(&impact_group.turning, side.angular.dot(side.at.spin), unit.energy);
  add_units(&impact_group.weight, side.momentum.norm(), unit.momentum);
  add_units(&impact_group.delayed_weight, side.momentum.norm() * solved.time, unit.delayed);
  count_up(&impact_group.impacts);
  raise(&impact_group.first_missing, ~pair);
}

/// The effect of an impact group on its heavy body.
class ImpactGroupOutcome {
 public:
  SCREE_HD ImpactGroupOutcome(const FlightStage& stage, std::int32_t heavy, const ImpactGroup& impact_group)
      : flight_(stage.flight(heavy)) {
    const ImpactGroupUnits unit(stage, heavy, impact_group);
    momentum_ = value_of(impact_group.momentum, unit.momentum);
    angular_ = value_of(impact_group.angular, unit.angular);
    turning_ = value_of(impact_group.turning, unit.energy);
    const double weight = value_of(impact_group.weight, unit.momentum);
    time_ = weight > 0 ? value_of(impact_group.delayed_weight, unit.delayed) / weight : flight_.midpoint;
    at_ = instant_of(flight_, time_);
    velocity_ = stage.bodies.inverse_mass[heavy] * momentum_;
    delayed_velocity_ = stage.bodies.inverse_mass[heavy] * value_of(impact_group.delayed, unit.delayed);
    hold_to_guide(stage.parameters.guides, heavy, velocity_);
    hold_to_guide(stage.parameters.guides, heavy, delayed_velocity_);
    spin_ = world_inverse_inertia(at_.solid.orientation, flight_.inverse_inertia) * angular_;
    if (impact_group.impacts == 1) return;
    const double light = value_of(impact_group.light, unit.energy);
    const double together = 0.5 * (momentum_.dot(velocity_) + angular_.dot(spin_));
    if (light > 0) scale_ = (light + value_of(impact_group.own, unit.energy)) / (light + together);
  }

  /// Returns x, the scale of all impacts of the group.
  SCREE_HD double scale() const { return scale_; }

  /// Applies the group to the heavy body, which gets it at the mean time of the impacts. Returns the drift of
  /// its rotational energy, and the angular momentum by which impacts at several times differ from one at
  /// their mean.
  SCREE_HD Ledger fly_on(const FlightStage& stage, std::int32_t heavy) const {
    Ledger moved;
    const Vec3 back = scale_ * (delayed_velocity_ - flight_.midpoint * velocity_);
    stage.bodies.position[heavy] -= back;
    stage.bodies.velocity[heavy] += scale_ * velocity_;
    moved.angular_correction = -back.cross(scale_ * momentum_);
    if (stage.parameters.rotation) {
      const double given = scale_ * turning_ + 0.5 * scale_ * scale_ * angular_.dot(spin_);
      BodyFlight next = flight_;
      turn_on(next, at_.solid.orientation, at_.spin + scale_ * spin_, time_);
      moved.integration = energy_gained(next, flight_) - given;
      stage.bodies.orientation[heavy] = next.orientation;
      stage.bodies.spin[heavy] = next.spin;
    }
    stage.bound(heavy);
    return moved;
  }

 private:
  BodyFlight flight_;
  Vec3 momentum_, angular_;
  double turning_;
  double time_;
  BodyInstant at_;
  Vec3 velocity_, delayed_velocity_, spin_;  // delayed_velocity_: times the time (m)
  double scale_ = 1;
};

/// Gives the lighter body its share of an impact in an impact group. Returns the ledger of what the impact
/// moved.
SCREE_HD inline Ledger fly_on_scaled(const FlightStage& stage, std::int32_t heavy, const SolvedImpact& solved,
                                     double scale, Impact& impact) {
  const bool heavy_is_i = solved.i == heavy;
  const BodyInstant& at = heavy_is_i ? solved.at_j : solved.at_i;
  SolverBody after = heavy_is_i ? solved.after_j : solved.after_i;
  after.velocity = at.velocity + scale * (after.velocity - at.velocity);
  after.spin = at.spin + scale * (after.spin - at.spin);
  impact = solved.of_pair();
  impact.impulse *= scale;
  count_impact_cost(stage, solved);
  Ledger moved = solved.moved();
  moved.restitution *= scale;
  moved.friction *= scale;
  moved.integration += fly_on(stage, heavy_is_i ? solved.j : solved.i,
                              heavy_is_i ? solved.flight_j : solved.flight_i, at, after, solved.time);
  return moved;
}

}  // namespace scree::detail
