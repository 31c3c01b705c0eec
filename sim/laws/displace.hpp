// The displacement of a body by position correction, with its energy accounting.
#pragma once

#include "core/bodies.hpp"
#include "sim/laws/rotation.hpp"
#include "sim/observe/observation.hpp"

#include <cstdint>

namespace scree {

/// Moves a free body by one vector (m) and turns it by another (rad), at unchanged velocities. Returns how
/// much that changes the energy and the angular momentum.
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
  const Vec3 moved = position - before;  // far from the origin, rounding drops a part of `by`
  ledger.correction = mass * gravity.dot(moved);
  ledger.angular_correction = mass * moved.cross(bodies.velocity[k]);
  if (rotation && !turn.isZero(0)) {
    const Mat3 before_turn = q.toRotationMatrix();
    q = (rotation_of(turn) * q).normalized();
    const Mat3 after_turn = q.toRotationMatrix();
    // The spin is unchanged, so the angular momentum changes.
    const Vec3 inertia = inverse_inertia.cwiseInverse();
    const Vec3 momentum = before_turn * (before_turn.transpose() * spin).cwiseProduct(inertia);
    const Vec3 gained = after_turn * (after_turn.transpose() * spin).cwiseProduct(inertia) - momentum;
    ledger.correction -= 0.5 * spin.dot(gained);
    ledger.angular_correction += gained;
  }
  return ledger;
}

}  // namespace scree
