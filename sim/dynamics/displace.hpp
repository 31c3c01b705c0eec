// What position correction does to a body.
#pragma once

#include "core/bodies.hpp"
#include "sim/dynamics/rotation.hpp"
#include "sim/observation.hpp"

#include <cstdint>

namespace scree {

/// Moves a free body by a vector (m), turns it by another (rad), and says what that changed, at velocities
/// that stay.
SCREE_HD inline Ledger displace(const BodyView& bodies, std::int64_t k, const Vec3& by, const Vec3& turn,
                                const Vec3& gravity, bool rotation) {
  const double mass = 1.0 / bodies.inverse_mass[k];
  const Vec3& spin = bodies.spin[k];
  const Vec3& inverse_inertia = bodies.inverse_inertia[k];
  Quat& q = bodies.orientation[k];
  Ledger ledger;
  Vec3& position = bodies.position[k];
  const Vec3 before = position;
  position += by;
  const Vec3 moved = position - before;  // far from the origin rounding drops some
  ledger.correction = mass * gravity.dot(moved);
  ledger.angular_correction = mass * moved.cross(bodies.velocity[k]);
  if (rotation && !turn.isZero(0)) {
    const double energy = rotational_energy(q, spin, inverse_inertia);
    const Vec3 momentum = spin_momentum(q, spin, inverse_inertia);
    q = (rotation_of(turn) * q).normalized();
    ledger.correction -= rotational_energy(q, spin, inverse_inertia) - energy;
    ledger.angular_correction += spin_momentum(q, spin, inverse_inertia) - momentum;
  }
  return ledger;
}

}  // namespace scree
