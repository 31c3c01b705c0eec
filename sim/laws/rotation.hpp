// Free rotation of a rigid body, exact in angular momentum.
#pragma once

#include "core/bodies.hpp"
#include "core/math.hpp"
#include "core/tolerances.hpp"
#include "sim/laws/simd/free_turn.hpp"

namespace scree {

/// Returns the kinetic energy of rotation (J); 0 for a body without inertia (not free).
SCREE_HD inline double rotational_energy(const Quat& orientation, const Vec3& spin,
                                         const Vec3& inverse_inertia) {
  if (inverse_inertia.x() == 0) return 0;
  const Vec3 w = orientation.conjugate() * spin;
  return 0.5 * w.cwiseProduct(w).cwiseQuotient(inverse_inertia).sum();
}

/// Returns the angular momentum about the centre of mass, world frame (kg m^2/s); 0 for a body that is not
/// free.
SCREE_HD inline Vec3 spin_momentum(const Quat& orientation, const Vec3& spin, const Vec3& inverse_inertia) {
  if (inverse_inertia.x() == 0) return Vec3::Zero();
  return orientation * (orientation.conjugate() * spin).cwiseQuotient(inverse_inertia);
}

/// Returns a bound on the spin of a body in free rotation at any time (rad/s), from its angular momentum in
/// its own frame and the energy that belongs to it.
SCREE_HD inline double fastest_spin(const Vec3& momentum, const Vec3& inverse_inertia) {
  const double largest = inverse_inertia.maxCoeff();
  const double twice_energy = momentum.cwiseProduct(momentum).dot(inverse_inertia);
  return sqrt(fmin(largest * largest * momentum.squaredNorm(), largest * twice_energy));
}
SCREE_HD inline double fastest_spin(const Quat& orientation, const Vec3& spin, const Vec3& inverse_inertia) {
  if (has_equal_moments(inverse_inertia)) return spin.norm();
  return fastest_spin((orientation.conjugate() * spin).cwiseQuotient(inverse_inertia), inverse_inertia);
}

/// The arithmetic of one body, for the laws in simd/free_turn.hpp.
struct Number {
  using V = double;
  SCREE_HD static double root(double a) { return sqrt(a); }
  SCREE_HD static bool any(bool condition) { return condition; }
  SCREE_HD static simd::HalfTurn<Number> half_turn(double square) {
    if (square <= simd::most_half_turn * simd::most_half_turn) return simd::half_turn_series<Number>(square);
    const double angle = sqrt(square);
    return {sin(angle) / angle, cos(angle)};
  }
};

/// The axes of a body in the order of ascending moments.
struct AxisOrder {
  int axis[3];
  double side;  ///< -1 where the last axis must be reversed to make them right-handed; else 1

  SCREE_HD explicit AxisOrder(const Vec3& inverse_inertia) {
    int smallest = 0;
    int largest = 0;
    for (int k = 1; k < 3; ++k) {
      if (inverse_inertia[k] > inverse_inertia[smallest]) smallest = k;
      if (inverse_inertia[k] <= inverse_inertia[largest]) largest = k;
    }
    axis[0] = smallest;
    axis[1] = 3 - smallest - largest;
    axis[2] = largest;
    side = axis[1] == (smallest + 1) % 3 ? 1.0 : -1.0;
  }

  /// Returns the moments, or other values without direction, in this order.
  SCREE_HD Vec3 ordered(const Vec3& a) const { return {a[axis[0]], a[axis[1]], a[axis[2]]}; }
  /// Returns a vector, or the vector part of a quaternion, in these axes. All vectors of a body and of the
  /// world may be renamed together in this way.
  SCREE_HD Vec3 renamed(const Vec3& a) const { return {a[axis[0]], a[axis[1]], side * a[axis[2]]}; }
  SCREE_HD Vec3 named_back(const Vec3& a) const {
    Vec3 back;
    back[axis[0]] = a.x();
    back[axis[1]] = a.y();
    back[axis[2]] = side * a.z();
    return back;
  }
};

enum class RotationOrder { second, fourth };

namespace detail {

/// Does rotate_freely() for a body with different moments. It is called and not inlined, since it is long.
[[gnu::noinline]] SCREE_HD inline double rotate_unequal(Quat& orientation, Vec3& spin,
                                                        const Vec3& inverse_inertia, double dt,
                                                        RotationOrder order) {
  const AxisOrder axes(inverse_inertia);
  const auto v3 = [](const Vec3& a) { return simd::V3<Number>{a.x(), a.y(), a.z()}; };
  const auto vec3 = [&axes](const simd::V3<Number>& a) { return axes.named_back(Vec3(a.x, a.y, a.z)); };
  const Vec3 inverse = axes.ordered(inverse_inertia);
  simd::RotatingBody<Number> body{{orientation.w(), v3(axes.renamed(orientation.vec()))},
                                  v3(axes.renamed(spin)),
                                  v3(inverse.cwiseInverse()),
                                  v3(inverse)};
  const auto start = simd::start_of(body);
  const double turn = start.fastest * fabs(dt);
  double drift = 0;
  if (turn < tolerance::hardly_a_turn) {
    simd::turn_little(body, start, dt);
  } else {
    constexpr double most_steps = 1000;
    const double steps = fmin(most_steps, fmax(1.0, ceil(turn / tolerance::split_turn)));
    drift = simd::turn_by_splitting(body, start, dt, static_cast<int>(steps), order == RotationOrder::fourth);
  }
  orientation.w() = body.orientation.w;
  orientation.vec() = vec3(body.orientation.v);
  spin = vec3(body.spin);
  return drift;
}

}  // namespace detail

/// Turns a free body for the time dt (s). For equal moments this is exact. Otherwise it is the symmetric
/// three-axis splitting of the body-frame equations (Touma and Wisdom 1994; Dullweber, Leimkuhler, McLachlan
/// 1997, sec. 3): it is of second order and keeps the world angular momentum to rounding; then a small turn
/// restores the energy, also to rounding. A body that turns far takes several such steps. Fourth order is
/// Suzuki's composition of five such steps, of p, p, 1 - 4 p, p, p times the length, with p = 1 / (4 -
/// 4^(1/3)) (Suzuki 1990, "Fractal decomposition of exponential operators"). A body that hardly turns is
/// turned about its mean spin, at a quarter of the cost (the second term of Magnus' expansion is of third
/// order, which is rounding here). Returns the drift of the rotational energy (J); 0 where the drift is only
/// rounding by construction.
SCREE_HD inline double rotate_freely(Quat& orientation, Vec3& spin, const Vec3& inverse_inertia, double dt,
                                     RotationOrder order = RotationOrder::second) {
  if (has_equal_moments(inverse_inertia)) {
    orientation = (rotation_of(spin * dt) * orientation).normalized();
    return 0;
  }
  return detail::rotate_unequal(orientation, spin, inverse_inertia, dt, order);
}

/// Returns the inverse inertia tensor in the world frame.
SCREE_HD inline Mat3 world_inverse_inertia(const Quat& orientation, const Vec3& inverse_inertia) {
  if (has_equal_moments(inverse_inertia)) return inverse_inertia.x() * Mat3::Identity();
  return rotated_diagonal(orientation.toRotationMatrix(), inverse_inertia);
}

}  // namespace scree
