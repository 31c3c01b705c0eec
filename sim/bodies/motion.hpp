// Free motion: the two half steps of Moreau's midpoint rule.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/laws/rotation.hpp"

#include <cstdint>

namespace scree {

/// Moves every free body by its velocity and spin for the time dt (s), in place. Returns the drift of their
/// rotational energy (J), which the ledger accounts as integration.
template <class Space>
double advance(Bodies<Space>& bodies, double dt, const ResponseParameters& parameters);

/// Returns the work (J) of the forces that give free bodies these accelerations (m/s^2), on the way from
/// `start` to the present positions.
template <class Space>
double work_of_forces(const Bodies<Space>& bodies, const Array<Vec3, Space>& start,
                      ConstView<Vec3> acceleration);

/// Sums over the free bodies, computed in every step.
struct Energies {
  double kinetic_linear = 0;
  double kinetic_angular = 0;
  double potential = 0;  ///< potential energy relative to the reference point
  /// Number of bodies with a number in their state that is not finite.
  std::int64_t not_finite = 0;

  double kinetic() const { return kinetic_linear + kinetic_angular; }
  SCREE_HD friend Energies operator+(const Energies& a, const Energies& b) {
    return {a.kinetic_linear + b.kinetic_linear, a.kinetic_angular + b.kinetic_angular,
            a.potential + b.potential, a.not_finite + b.not_finite};
  }
};
/// Sums over the free bodies, computed for an observation.
struct Totals : Energies {
  double mass = 0;
  Vec3 momentum = Vec3::Zero();
  Vec3 angular_momentum = Vec3::Zero();  ///< angular momentum about the origin
  Vec3 first_moment = Vec3::Zero();      ///< sum of m (x - reference)
  double speed_squared = 0;
  double speed_fourth = 0;
  std::int64_t count = 0;

  SCREE_HD friend Totals operator+(const Totals& a, const Totals& b) {
    return {static_cast<const Energies&>(a) + static_cast<const Energies&>(b),
            a.mass + b.mass,
            a.momentum + b.momentum,
            a.angular_momentum + b.angular_momentum,
            a.first_moment + b.first_moment,
            a.speed_squared + b.speed_squared,
            a.speed_fourth + b.speed_fourth,
            a.count + b.count};
  }
};

/// Returns whether position, orientation, velocity and spin are finite.
SCREE_HD inline bool is_finite(const ConstBodyView& bodies, std::int64_t k) {
  // Zero times a number that is not finite is NaN.
  const double zero = (0 * bodies.position[k]).sum() + (0 * bodies.orientation[k].coeffs()).sum() +
                      (0 * bodies.velocity[k]).sum() + (0 * bodies.spin[k]).sum();
  return zero == 0;
}

/// Returns one body's share of the sums; zero unless it is free. Potential energy is -m g.(x - reference).
SCREE_HD inline Energies energies_of_body(const ConstBodyView& bodies, std::int64_t k, const Vec3& gravity,
                                          const Vec3& reference) {
  if (bodies.mobility[k] != Mobility::free) return {};
  const double mass = 1.0 / bodies.inverse_mass[k];
  return {0.5 * mass * bodies.velocity[k].squaredNorm(),
          rotational_energy(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k]),
          -mass * gravity.dot(bodies.position[k] - reference), is_finite(bodies, k) ? 0 : 1};
}
SCREE_HD inline Totals totals_of_body(const ConstBodyView& bodies, std::int64_t k, const Vec3& gravity,
                                      const Vec3& reference) {
  if (bodies.mobility[k] != Mobility::free) return {};
  const double mass = 1.0 / bodies.inverse_mass[k];
  const Vec3& x = bodies.position[k];
  const Vec3& v = bodies.velocity[k];
  Totals t{energies_of_body(bodies, k, gravity, reference)};
  t.mass = mass;
  t.momentum = mass * v;
  t.angular_momentum =
      mass * x.cross(v) + spin_momentum(bodies.orientation[k], bodies.spin[k], bodies.inverse_inertia[k]);
  t.first_moment = mass * (x - reference);
  t.speed_squared = v.squaredNorm();
  t.speed_fourth = t.speed_squared * t.speed_squared;
  t.count = 1;
  return t;
}

template <class Space>
Energies energies_of(const Bodies<Space>& bodies, const Vec3& gravity, const Vec3& reference);
template <class Space>
Totals totals_of(const Bodies<Space>& bodies, const Vec3& gravity, const Vec3& reference);
template <class Space>
double largest_speed(const Bodies<Space>& bodies);

}  // namespace scree
