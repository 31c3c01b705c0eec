// Free rotation of a body with unequal moments of inertia: the law behind rotate_freely(), for one body or
// for several side by side, like the laws of wide_laws.hpp.
//
// The arithmetic A must also have A::half_turn(square), which returns a HalfTurn.
#pragma once

#include "sim/laws/simd/wide_laws.hpp"

namespace scree::simd {

/// The values of sin(x) / x and cos(x) for half an angle x, as functions of its square.
template <class A>
struct HalfTurn {
  typename A::V sine_ratio, cosine;
};

/// The largest half angle for which half_turn_series() is exact to rounding: half of split_turn.
inline constexpr double most_half_turn = 0.5 * tolerance::split_turn;

/// Returns the HalfTurn for s = x^2 by Taylor series, to rounding.
template <class A>
SCREE_LAW HalfTurn<A> half_turn_series(const typename A::V& s) {
  constexpr double f3 = 6, f5 = 120, f7 = 5040, f9 = 362880, f11 = 39916800;
  constexpr double f2 = 2, f4 = 24, f6 = 720, f8 = 40320, f10 = 3628800, f12 = 479001600;
  return {1.0 - s * (1 / f3 - s * (1 / f5 - s * (1 / f7 - s * (1 / f9 - s * (1 / f11))))),
          1.0 - s * (1 / f2 - s * (1 / f4 - s * (1 / f6 - s * (1 / f8 - s * (1 / f10 - s * (1 / f12))))))};
}

/// A unit quaternion.
template <class A>
struct Quaternion {
  typename A::V w;
  V3<A> v;

  SCREE_LAW friend Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    return {a.w * b.w - dot(a.v, b.v), a.w * b.v + b.w * a.v + cross(a.v, b.v)};
  }
  SCREE_LAW Quaternion normalized() const {
    const typename A::V length = A::root(w * w + dot(v, v));
    return {w / length, v / length};
  }
};

/// The axes of a body in the world frame.
template <class A>
struct Axes {
  V3<A> x, y, z;

  SCREE_LAW V3<A> to_world(const V3<A>& a) const { return a.x * x + a.y * y + a.z * z; }
  SCREE_LAW V3<A> to_body(const V3<A>& a) const { return {dot(x, a), dot(y, a), dot(z, a)}; }
};
template <class A>
SCREE_LAW Axes<A> axes_of(const Quaternion<A>& q) {
  using V = typename A::V;
  const V3<A> twice = {q.v.x + q.v.x, q.v.y + q.v.y, q.v.z + q.v.z};
  const V wx = q.w * twice.x, wy = q.w * twice.y, wz = q.w * twice.z;
  const V xx = q.v.x * twice.x, xy = q.v.x * twice.y, xz = q.v.x * twice.z;
  const V yy = q.v.y * twice.y, yz = q.v.y * twice.z, zz = q.v.z * twice.z;
  return {{1.0 - (yy + zz), xy + wz, xz - wy},
          {xy - wz, 1.0 - (xx + zz), yz + wx},
          {xz + wy, yz - wx, 1.0 - (xx + yy)}};
}

template <class A>
SCREE_LAW V3<A> times(const V3<A>& a, const V3<A>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// A body that turns freely. Its axes are in the order of ascending moments: for rotation about a middle
/// axis, other orders of the splitting are up to 20 times less accurate (a tumbling box after 12 s).
template <class A>
struct RotatingBody {
  Quaternion<A> orientation;
  V3<A> spin;  ///< world frame (rad/s)
  V3<A> inertia, inverse_inertia;

  /// Sets the spin from the angular momentum l (world frame). The spin is computed from l and then corrected
  /// once by what is left of l, because the rounding of a rotation there and back is biased and would add up
  /// over the steps (1e-11 in 27,000, against 1e-13).
  SCREE_LAW void spin_by(const V3<A>& l) {
    const Axes<A> axes = axes_of(orientation);
    spin = axes.to_world(times(axes.to_body(l), inverse_inertia));
    const V3<A> left = l - axes.to_world(times(axes.to_body(spin), inertia));
    spin = spin + axes.to_world(times(axes.to_body(left), inverse_inertia));
  }
};

template <class A, class Condition>
SCREE_LAW void choose(const Condition& yes, const RotatingBody<A>& other, RotatingBody<A>& body) {
  body.orientation.w = yes ? other.orientation.w : body.orientation.w;
  body.orientation.v = where(yes, other.orientation.v, body.orientation.v);
  body.spin = where(yes, other.spin, body.spin);
}

/// The state of a body before it turns.
template <class A>
struct RotationStart {
  V3<A> body_spin, momentum;  ///< spin and angular momentum in the body frame
  V3<A> world_momentum;
  typename A::V fastest;  ///< bound on the spin at any time, fastest_spin() (rad/s)
};
template <class A>
SCREE_LAW RotationStart<A> start_of(const RotatingBody<A>& body) {
  using V = typename A::V;
  const Axes<A> axes = axes_of(body.orientation);
  const V3<A> body_spin = axes.to_body(body.spin);
  const V3<A> momentum = times(body_spin, body.inertia);
  const V largest = body.inverse_inertia.x;
  const V by_momentum = largest * largest * dot(momentum, momentum);
  const V by_energy = largest * dot(times(momentum, momentum), body.inverse_inertia);
  return {body_spin, momentum, axes.to_world(momentum),
          A::root(by_momentum < by_energy ? by_momentum : by_energy)};
}

/// Turns a body that turns by a very small angle, about its mean spin. The second term of Magnus' expansion
/// is of third order, which is rounding here.
template <class A>
SCREE_LAW void turn_little(RotatingBody<A>& body, const RotationStart<A>& start, double dt) {
  using V = typename A::V;
  const V3<A> change = times(cross(start.momentum, start.body_spin), body.inverse_inertia);
  const V half = V{} + 0.5 * dt;
  const V3<A> half_turn = half * (start.body_spin + half * change);
  body.orientation = (body.orientation * Quaternion<A>{V{} + 1.0, half_turn}).normalized();
  body.spin_by(start.world_momentum);
}

/// Applies the exact flow of the kinetic energy of one principal axis, L^2 / (2 I), with the angular momentum
/// L along it: a turn about that axis, against which the other two components of the momentum turn back. In
/// the order of the axes, `axis` is followed by `a`, then `b`.
template <class A>
SCREE_LAW void turn_about(const typename A::V& half_angle, typename A::V& w, typename A::V& axis,
                          typename A::V& a, typename A::V& b, typename A::V& momentum_a,
                          typename A::V& momentum_b) {
  using V = typename A::V;
  const HalfTurn<A> half = A::half_turn(half_angle * half_angle);
  const V sh = half_angle * half.sine_ratio;
  const V ch = half.cosine;
  // orientation * (ch, sh about the axis)
  const V old_w = w, old_a = a;
  w = ch * w - sh * axis;
  axis = ch * axis + sh * old_w;
  a = ch * a + sh * b;
  b = ch * b - sh * old_a;
  const V s = 2.0 * sh * ch;
  const V c = ch * ch - sh * sh;
  const V turned = c * momentum_a + s * momentum_b;
  momentum_b = c * momentum_b - s * momentum_a;
  momentum_a = turned;
}

/// Does one step of the symmetric three-axis splitting of the body-frame equations.
template <class A>
SCREE_LAW void split(RotatingBody<A>& body, V3<A>& momentum, double length) {
  using V = typename A::V;
  auto& [w, v] = body.orientation;
  V3<A>& l = momentum;
  const V3<A>& inverse = body.inverse_inertia;
  const V quarter = V{} + 0.25 * length;
  const V half = V{} + 0.5 * length;
  turn_about<A>(quarter * l.x * inverse.x, w, v.x, v.y, v.z, l.y, l.z);
  turn_about<A>(quarter * l.y * inverse.y, w, v.y, v.z, v.x, l.z, l.x);
  turn_about<A>(half * l.z * inverse.z, w, v.z, v.x, v.y, l.x, l.y);
  turn_about<A>(quarter * l.y * inverse.y, w, v.y, v.z, v.x, l.z, l.x);
  turn_about<A>(quarter * l.x * inverse.x, w, v.x, v.y, v.z, l.y, l.z);
}

/// Turns a body at constant angular momentum until its energy is the given one. It turns about w x L, the
/// direction in which the energy changes most. The energy of a splitting oscillates, and impacts that sample
/// the oscillation would make it a random walk.
template <class A>
SCREE_LAW void restore_energy(RotatingBody<A>& body, const V3<A>& l, const typename A::V& energy) {
  using V = typename A::V;
  constexpr int most_iterations = 4;
  const V zero{};
  const V least_slope = tolerance::energy_slope * energy;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const V excess = 0.5 * dot(body.spin, l) - energy;
    const V3<A> slope = cross(body.spin, l);
    const V square = dot(slope, slope);
    const V3<A> half_turn = (-0.5 * excess / square) * slope;
    const V half_square = dot(half_turn, half_turn);
    const auto turns = ((excess < 0 ? zero - excess : excess) > tolerance::energy_rounding * energy) &
                       (square > least_slope * least_slope) &
                       (half_square <= 0.25 * tolerance::energy_turn * tolerance::energy_turn);
    if (!A::any(turns)) return;
    const HalfTurn<A> half = A::half_turn(half_square);
    RotatingBody<A> turned = body;
    turned.orientation =
        (Quaternion<A>{half.cosine, half.sine_ratio * half_turn} * body.orientation).normalized();
    turned.spin_by(l);
    choose(turns, turned, body);
  }
}

/// Turns a body by the splitting, in the given number of steps. Returns the drift of the rotational energy
/// (J).
template <class A>
SCREE_LAW typename A::V turn_by_splitting(RotatingBody<A>& body, const RotationStart<A>& start, double dt,
                                          int steps, bool fourth_order) {
  using V = typename A::V;
  const V3<A>& l = start.world_momentum;
  const V energy = 0.5 * dot(body.spin, l);
  const double h = dt / steps;
  for (int step = 0; step < steps; ++step) {
    V3<A> momentum = step == 0 ? start.momentum : axes_of(body.orientation).to_body(l);
    if (fourth_order) {
      constexpr double p = 0.41449077179437573714;  // 1 / (4 - 4^(1/3))
      for (int k = 0; k < 5; ++k) split(body, momentum, k == 2 ? (1.0 - 4.0 * p) * h : p * h);
    } else {
      split(body, momentum, h);
    }
    body.orientation = body.orientation.normalized();
    body.spin_by(l);
    restore_energy(body, l, energy);
  }
  return 0.5 * dot(body.spin, l) - energy;
}

}  // namespace scree::simd
