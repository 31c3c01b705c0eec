// The displacement of a body by position correction, with its energy accounting.
#pragma once

#include "core/bodies.hpp"
#include "sim/laws/rotation.hpp"
#include "sim/observe/observation.hpp"

#include <cstdint>

namespace scree {

/// Gives a free body another orientation, at unchanged velocities. Returns how much that changes the energy
/// and the angular momentum.
SCREE_HD inline Ledger turn_to(const BodyView& bodies, std::int64_t k, const Quat& orientation) {
  const Vec3& spin = bodies.spin[k];
  const Vec3& inverse_inertia = bodies.inverse_inertia[k];
  const Vec3 before = spin_momentum(bodies.orientation[k], spin, inverse_inertia);
  bodies.orientation[k] = orientation;
  const Vec3 gained = spin_momentum(orientation, spin, inverse_inertia) - before;
  Ledger ledger;
  ledger.correction = -0.5 * spin.dot(gained);
  ledger.angular_correction = gained;
  return ledger;
}

/// Moves a free body by one vector (m) and turns it by another (rad), at unchanged velocities. Returns how
/// much that changes the energy and the angular momentum.
SCREE_HD inline Ledger displace(const BodyView& bodies, std::int64_t k, const Vec3& by, const Vec3& turn,
                                const Vec3& gravity, bool rotation) {
  const double mass = 1.0 / bodies.inverse_mass[k];
  Ledger ledger;
  Vec3& position = bodies.position[k];
  const Vec3 before = position;
  position += by;
  const Vec3 moved = position - before;  // far from the origin, rounding drops a part of `by`
  ledger.correction = mass * gravity.dot(moved);
  ledger.angular_correction = mass * moved.cross(bodies.velocity[k]);
  if (rotation && !turn.isZero(0))
    ledger = ledger + turn_to(bodies, k, (rotation_of(turn) * bodies.orientation[k]).normalized());
  return ledger;
}

}  // namespace scree
