// Free rotation of a rigid body, exact in angular momentum.
#pragma once

#include "core/bodies.hpp"
#include "core/math.hpp"
#include "core/tolerances.hpp"

namespace scree {

/// Kinetic energy of rotation (J); 0 for a body without inertia (not free).
SCREE_HD inline double rotational_energy(const Quat& orientation, const Vec3& spin,
                                         const Vec3& inverse_inertia) {
  if (inverse_inertia.x() == 0) return 0;
  const Vec3 w = orientation.conjugate() * spin;
  return 0.5 * w.cwiseProduct(w).cwiseQuotient(inverse_inertia).sum();
}

/// Angular momentum about the centre of mass, world frame (kg m^2/s); 0 for a body that is not free.
SCREE_HD inline Vec3 spin_momentum(const Quat& orientation, const Vec3& spin, const Vec3& inverse_inertia) {
  if (inverse_inertia.x() == 0) return Vec3::Zero();
  return orientation * (orientation.conjugate() * spin).cwiseQuotient(inverse_inertia);
}

/// Bound on the spin of a body in free rotation, at any time (rad/s), by its angular momentum in its own
/// frame and by the energy that goes with it.
SCREE_HD inline double fastest_spin(const Vec3& momentum, const Vec3& inverse_inertia) {
  const double largest = inverse_inertia.maxCoeff();
  const double twice_energy = momentum.cwiseProduct(momentum).dot(inverse_inertia);
  return sqrt(fmin(largest * largest * momentum.squaredNorm(), largest * twice_energy));
}
SCREE_HD inline double fastest_spin(const Quat& orientation, const Vec3& spin, const Vec3& inverse_inertia) {
  if (has_equal_moments(inverse_inertia)) return spin.norm();
  return fastest_spin((orientation.conjugate() * spin).cwiseQuotient(inverse_inertia), inverse_inertia);
}

namespace detail {

/// Exact flow of the kinetic energy of one principal axis, L_k^2 / (2 I_k), for the time dt: a turn about
/// that axis, against which the body-frame momentum turns back.
SCREE_HD inline void turn_about(int axis, Quat& orientation, Vec3& momentum, const Vec3& inverse_inertia,
                                double dt) {
  const int a = axis == 2 ? 0 : axis + 1;
  const int b = axis == 0 ? 2 : axis - 1;
  const double half_angle = 0.5 * dt * momentum[axis] * inverse_inertia[axis];
  const double sh = sin(half_angle);
  const double ch = cos(half_angle);
  // orientation * (ch, sh about the axis)
  const double w = orientation.w();
  const Vec3 v = orientation.vec();
  orientation.w() = ch * w - sh * v[axis];
  orientation.vec()[axis] = ch * v[axis] + sh * w;
  orientation.vec()[a] = ch * v[a] + sh * v[b];
  orientation.vec()[b] = ch * v[b] - sh * v[a];
  const double s = 2.0 * sh * ch;
  const double c = ch * ch - sh * sh;
  const double la = c * momentum[a] + s * momentum[b];
  momentum[b] = c * momentum[b] - s * momentum[a];
  momentum[a] = la;
}

/// Spin of a body with the angular momentum l (world frame): taken from the momentum, and once more for the
/// difference, because the rounding of a rotation there and back is biased and would add up over the steps
/// (1e-11 in 27,000, against 1e-13).
SCREE_HD inline Vec3 spin_of(const Quat& orientation, const Vec3& inertia, const Vec3& inverse_inertia,
                             const Vec3& l) {
  const Mat3 r = orientation.toRotationMatrix();
  const auto once = [&](const Vec3& momentum) {
    return Vec3(r * (r.transpose() * momentum).cwiseProduct(inverse_inertia));
  };
  const Vec3 spin = once(l);
  return spin + once(l - r * (r.transpose() * spin).cwiseProduct(inertia));
}

/// Turns a body at constant angular momentum until its energy is the one given: about w x L, the direction in
/// which the energy changes most. A splitting's energy oscillates, and impacts that sample the oscillation
/// would make it a random walk.
SCREE_HD inline void restore_energy(Quat& orientation, Vec3& spin, const Vec3& inertia,
                                    const Vec3& inverse_inertia, const Vec3& l, double energy) {
  constexpr int most_iterations = 4;
  const double least_slope = tolerance::energy_slope * energy;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double excess = 0.5 * spin.dot(l) - energy;
    const Vec3 slope = spin.cross(l);
    const double square = slope.squaredNorm();
    if (fabs(excess) <= tolerance::energy_rounding * energy || square <= least_slope * least_slope) return;
    const Vec3 turn = (-excess / square) * slope;
    if (turn.norm() > tolerance::energy_turn) return;
    orientation = (rotation_of(turn) * orientation).normalized();
    spin = spin_of(orientation, inertia, inverse_inertia, l);
  }
}

}  // namespace detail

enum class RotationOrder { second, fourth };

/// Turns a free body for the time dt (s). Equal moments: exact. Otherwise the symmetric three-axis splitting
/// of the body-frame equations (Touma and Wisdom 1994; Dullweber, Leimkuhler, McLachlan 1997, sec. 3): second
/// order, world angular momentum kept to rounding; then a small turn restores the energy, also to rounding.
/// What turns far goes in several such steps. The axes are taken by ascending moment, whatever their names:
/// about a middle axis (accuracy of a tumbling box after 12 s) the other orders are up to 20 times worse.
/// Fourth order: Suzuki's composition of five such steps, of p, p, 1 - 4 p, p, p times the length, p = 1 / (4
/// - 4^(1/3)) (Suzuki 1990, "Fractal decomposition of exponential operators"). What hardly turns does so
/// about its mean spin (Magnus' second term is of third order, and rounding here), at a quarter of the cost.
/// Returns the drift of the rotational energy (J); where it is but rounding by construction, 0.
SCREE_HD inline double rotate_freely(Quat& orientation, Vec3& spin, const Vec3& inverse_inertia, double dt,
                                     RotationOrder order = RotationOrder::second) {
  if (has_equal_moments(inverse_inertia)) {
    orientation = (rotation_of(spin * dt) * orientation).normalized();
    return 0;
  }
  const Vec3 inertia = inverse_inertia.cwiseInverse();
  const Mat3 r = orientation.toRotationMatrix();
  const Vec3 body_spin = r.transpose() * spin;
  Vec3 momentum = body_spin.cwiseProduct(inertia);
  const Vec3 world_momentum = r * momentum;
  const double fastest = fastest_spin(momentum, inverse_inertia);
  if (fastest * fabs(dt) < tolerance::hardly_a_turn) {
    const Vec3 half_turn =
        (0.5 * dt) * (body_spin + (0.5 * dt) * momentum.cross(body_spin).cwiseProduct(inverse_inertia));
    orientation = (orientation * Quat(1, half_turn.x(), half_turn.y(), half_turn.z())).normalized();
    spin = detail::spin_of(orientation, inertia, inverse_inertia, world_momentum);
    return 0;
  }
  int smallest = 0;
  int largest = 0;
  for (int k = 1; k < 3; ++k) {
    if (inverse_inertia[k] > inverse_inertia[smallest]) smallest = k;
    if (inverse_inertia[k] <= inverse_inertia[largest]) largest = k;
  }
  const int middle = 3 - smallest - largest;
  constexpr double most_turns = 1000;
  const double turns = fmin(most_turns, fmax(1.0, ceil(fastest * fabs(dt) / tolerance::split_turn)));
  const double energy = 0.5 * spin.dot(world_momentum);
  const double h = dt / turns;
  for (int turn = 0; turn < static_cast<int>(turns); ++turn) {
    if (turn > 0) momentum = orientation.conjugate() * world_momentum;
    const auto split = [&](double length) {
      detail::turn_about(smallest, orientation, momentum, inverse_inertia, 0.5 * length);
      detail::turn_about(middle, orientation, momentum, inverse_inertia, 0.5 * length);
      detail::turn_about(largest, orientation, momentum, inverse_inertia, length);
      detail::turn_about(middle, orientation, momentum, inverse_inertia, 0.5 * length);
      detail::turn_about(smallest, orientation, momentum, inverse_inertia, 0.5 * length);
    };
    if (order == RotationOrder::second) {
      split(h);
    } else {
      const double p = 1.0 / (4.0 - cbrt(4.0));
      for (int k = 0; k < 5; ++k) split(k == 2 ? (1.0 - 4.0 * p) * h : p * h);
    }
    orientation.normalize();
    spin = detail::spin_of(orientation, inertia, inverse_inertia, world_momentum);
    detail::restore_energy(orientation, spin, inertia, inverse_inertia, world_momentum, energy);
  }
  return 0.5 * spin.dot(world_momentum) - energy;
}

/// Inverse inertia tensor in the world frame.
SCREE_HD inline Mat3 world_inverse_inertia(const Quat& orientation, const Vec3& inverse_inertia) {
  if (has_equal_moments(inverse_inertia)) return inverse_inertia.x() * Mat3::Identity();
  return rotated_diagonal(orientation.toRotationMatrix(), inverse_inertia);
}

}  // namespace scree
