// The laws of one visit to a contact, for one contact or for several side by side. No function here depends
// on how contacts and bodies lie in memory.
//
// The template parameter A is an arithmetic. A::V is a number, or one number of each contact; A::root(V)
// returns its square roots, and A::any(condition) whether a condition holds anywhere. Everything here is a
// template on A, so that code for different instruction sets shares no function.
#pragma once

#include "core/space.hpp"
#include "core/tolerances.hpp"

#include <type_traits>

#define SCREE_LAW [[gnu::always_inline]] SCREE_HD inline

namespace scree::simd {

/// The number of contacts on which one visit of Host works.
inline constexpr int width = 8;

template <class A>
struct V3 {
  using V = typename A::V;
  V x, y, z;

  SCREE_LAW friend V3 operator+(const V3& a, const V3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  SCREE_LAW friend V3 operator-(const V3& a, const V3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  SCREE_LAW friend V3 operator*(const V& s, const V3& a) { return {s * a.x, s * a.y, s * a.z}; }
  SCREE_LAW friend V3 operator/(const V3& a, const V& s) { return {a.x / s, a.y / s, a.z / s}; }
  SCREE_LAW friend V dot(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  SCREE_LAW friend V3 cross(const V3& a, const V3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

template <class A, class Condition>
SCREE_LAW V3<A> where(const Condition& yes, const V3<A>& a, const V3<A>& b) {
  return {yes ? a.x : b.x, yes ? a.y : b.y, yes ? a.z : b.z};
}

template <class A>
SCREE_LAW typename A::V above_zero(const typename A::V& a) {
  return a > 0 ? a : typename A::V{};
}

/// A symmetric matrix.
template <class A>
struct Symmetric {
  typename A::V xx, yy, zz, xy, xz, yz;

  SCREE_LAW friend V3<A> operator*(const Symmetric& m, const V3<A>& a) {
    return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
            m.xz * a.x + m.yz * a.y + m.zz * a.z};
  }
  SCREE_LAW friend Symmetric operator+(const Symmetric& m, const Symmetric& n) {
    return {m.xx + n.xx, m.yy + n.yy, m.zz + n.zz, m.xy + n.xy, m.xz + n.xz, m.yz + n.yz};
  }
};

/// The centre of a body: its velocity, or its displacement in the position correction.
template <class A>
struct Centre {
  V3<A> velocity;
  typename A::V inverse_mass;  ///< 0 for a body that is not free
};

/// A body: its velocities, or its displacement and turn in the position correction.
template <class A>
struct Moving {
  V3<A> velocity;
  typename A::V inverse_mass;
  V3<A> spin;
  typename A::V inverse_inertia;  ///< inverse moment of inertia, of a ball
};

/// A contact of balls with balls, or with bodies that are not free and do not turn. Only the part of the
/// lever arms along the normal matters.
template <class A>
struct Balls {
  V3<A> normal;
  typename A::V arm_i, arm_j;  ///< lever arms along the normal (m)
  typename A::V friction, target, normal_mass, tangent_mass;
};

/// A point of a contact of any bodies.
template <class A>
struct Point {
  V3<A> arm_i, arm_j;
};
template <class A>
struct PointLaw {
  Symmetric<A> stick;  ///< RowCoupling::stick
  V3<A> coupling;      ///< RowCoupling::normal
  typename A::V target, normal_mass, tangent_mass;
};

/// Two directions in the plane across a normal: t is that of tangent_of(), and b is at right angles to it.
template <class A>
struct Tangents {
  V3<A> t, b;
};
template <class A>
SCREE_LAW Tangents<A> tangents_of(const V3<A>& n) {
  using V = typename A::V;
  const V zero{};
  const V one = zero + 1.0;
  const V sign = n.z < 0 ? -one : one;
  const V a = -1.0 / (sign + n.z);
  const V3<A> t = {one + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
  return {t, cross(n, t)};
}

/// Returns the largest eigenvalue of a matrix in the plane across a normal.
template <class A>
SCREE_LAW typename A::V largest_across(const Symmetric<A>& w, const V3<A>& n) {
  using V = typename A::V;
  const auto [t, b] = tangents_of<A>(n);
  const V3<A> wt = w * t, wb = w * b;
  const V tt = dot(t, wt), bb = dot(b, wb), tb = dot(t, wb);
  const V half_difference = 0.5 * (tt - bb);
  return 0.5 * (tt + bb) + A::root(half_difference * half_difference + tb * tb);
}

/// A contact of balls at the midpoint: its law, its gap and its curvature.
template <class A>
struct BallContact {
  Balls<A> law;
  typename A::V gap, curvature;  ///< gap (m); acceleration of the gap by the turning of the normal (m/s^2)
};

/// A ball at the midpoint.
template <class A>
struct Round {
  typename A::V radius;
  V3<A> velocity;  ///< velocity before the substep's kick
  typename A::V inverse_mass, inverse_inertia;
};

/// Returns the contact of two balls. `offset`: the vector from the centre of i to that of j; `kick`: the
/// change that the substep's forces make to the velocity of j relative to i.
template <class A>
SCREE_LAW BallContact<A> contact_of(const V3<A>& offset, const typename A::V& friction, const Round<A>& i,
                                    const Round<A>& j, const V3<A>& kick, double step, double noise) {
  using V = typename A::V;
  const V zero{};
  const V reach = i.radius + j.radius;
  const V distance = A::root(dot(offset, offset));
  // Coincident centres have no direction of their own; any one serves, if it is always the same.
  const V3<A> normal =
      where(distance > tolerance::coincident * reach, offset / distance, V3<A>{zero, zero, zero + 1.0});
  const V gap = distance - reach;
  const V arm_i = i.radius + 0.5 * gap;
  const V arm_j = -(j.radius + 0.5 * gap);
  const V3<A> before = j.velocity - i.velocity;
  const V3<A> w = before + kick;
  const V3<A> across = w - dot(w, normal) * normal;
  const V curvature = dot(across, across) / reach;
  const V closing = (gap > 0 ? -gap / step : zero) - 0.5 * step * curvature;
  const V separating = noise - dot(before, normal);
  const V target = separating < closing ? separating : closing;
  const V masses = i.inverse_mass + j.inverse_mass;
  const V turning = i.inverse_inertia * (arm_i * arm_i) + j.inverse_inertia * (arm_j * arm_j);
  return {{normal, arm_i, arm_j, friction, target, 1.0 / masses, 1.0 / (masses + turning)}, gap, curvature};
}

/// Returns a vector cut to the disc of a radius. If the radius is 0 the result is 0, even where the square of
/// the vector underflows.
template <class A>
SCREE_LAW V3<A> cut_to_disc(const V3<A>& v, const typename A::V& radius) {
  using V = typename A::V;
  const V square = dot(v, v);
  const V scale = radius > 0 ? radius / A::root(square) : V{};
  return where((radius > 0) & (square <= radius * radius), v, scale * v);
}

/// Returns an impulse in Coulomb's cone, from its normal part and its tangential part, which is cut to the
/// disc.
template <class A>
SCREE_LAW V3<A> on_disc(const typename A::V& pn, const V3<A>& pt, const V3<A>& n,
                        const typename A::V& friction) {
  return pn * n + cut_to_disc(pt, friction * pn);
}

/// Applies an impulse to the velocity of j, and its opposite to that of i. Body is Centre or Moving.
template <class A, class Body>
SCREE_LAW void push_centres(const V3<A>& p, Body& i, Body& j) {
  i.velocity = i.velocity - i.inverse_mass * p;
  j.velocity = j.velocity + j.inverse_mass * p;
}

template <class A>
SCREE_LAW void push(const Balls<A>& c, const V3<A>& p, Moving<A>& i, Moving<A>& j) {
  push_centres(p, i, j);
  // Rounding must not turn smooth balls.
  const V3<A> turn = where(c.friction > 0, cross(c.normal, p), V3<A>{});
  i.spin = i.spin - (i.inverse_inertia * c.arm_i) * turn;
  j.spin = j.spin + (j.inverse_inertia * c.arm_j) * turn;
}

template <class A>
SCREE_LAW void push(const Symmetric<A>& inertia_i, const Symmetric<A>& inertia_j, const Point<A>& at,
                    const V3<A>& p, Moving<A>& i, Moving<A>& j) {
  push_centres(p, i, j);
  i.spin = i.spin - inertia_i * cross(at.arm_i, p);
  j.spin = j.spin + inertia_j * cross(at.arm_j, p);
}

template <class A>
SCREE_LAW V3<A> velocity_at(const Balls<A>& c, const Moving<A>& i, const Moving<A>& j) {
  return j.velocity - i.velocity + cross(c.arm_j * j.spin - c.arm_i * i.spin, c.normal);
}

/// Returns an impulse cut to Coulomb's cone, as project_on_cone() does.
template <class A>
SCREE_LAW V3<A> in_cone(const V3<A>& p, const V3<A>& n, const typename A::V& friction) {
  using V = typename A::V;
  const V pn = dot(p, n);
  return where(pn > 0, on_disc(pn, p - pn * n, n, friction), V3<A>{});
}

/// Returns natural_map() of a contact that carries `last`; for balls this is the exact local solution.
template <class A>
SCREE_LAW V3<A> impulse_of(const Balls<A>& c, const V3<A>& last, const Moving<A>& i, const Moving<A>& j) {
  using V = typename A::V;
  const V3<A>& n = c.normal;
  const V3<A> u = velocity_at(c, i, j);
  const V un = dot(u, n);
  const V pn_old = dot(last, n);
  const V pn = above_zero<A>(pn_old - (un - c.target) * c.normal_mass);
  const V3<A> pt = last - pn_old * n - c.tangent_mass * (u - un * n);
  return on_disc(pn, pt, n, c.friction);
}

template <class A>
SCREE_LAW V3<A> velocity_at(const Point<A>& at, const Moving<A>& i, const Moving<A>& j) {
  return j.velocity + cross(j.spin, at.arm_j) - i.velocity - cross(i.spin, at.arm_i);
}

/// The first part of coulomb_update() of a point that carries p, given its relative velocity u: the impulse
/// that would make the point stick, and whether it does so within the cone.
template <class A, class Condition>
struct Sticking {
  V3<A> impulse;
  Condition holds;
};
template <class A>
SCREE_LAW auto sticking(const PointLaw<A>& law, const V3<A>& n, const typename A::V& friction, const V3<A>& p,
                        const V3<A>& u) {
  using V = typename A::V;
  const V3<A> impulse = p - law.stick * (u - law.target * n);
  const V pn = dot(impulse, n);
  const V3<A> pt = impulse - pn * n;
  const V radius = friction * pn;
  const auto holds = (friction > 0) & (pn >= 0) & (dot(pt, pt) <= radius * radius);
  return Sticking<A, std::remove_const_t<decltype(holds)>>{impulse, holds};
}
/// Returns the normal impulse of coulomb_update() for a point that does not stick.
template <class A>
SCREE_LAW typename A::V normal_impulse_of(const PointLaw<A>& law, const V3<A>& n, const V3<A>& p,
                                          const V3<A>& u) {
  return above_zero<A>(dot(p, n) - (dot(u, n) - law.target) * law.normal_mass);
}
/// Returns the whole impulse of coulomb_update() for a point that slides with the normal impulse pn.
template <class A>
SCREE_LAW V3<A> sliding_impulse(const PointLaw<A>& law, const V3<A>& n, const typename A::V& friction,
                                const V3<A>& p, const V3<A>& u, const typename A::V& pn) {
  const typename A::V pn_old = dot(p, n);
  const V3<A> v = u + (pn - pn_old) * law.coupling;
  const V3<A> pt = p - pn_old * n - law.tangent_mass * (v - dot(v, n) * n);
  return on_disc(pn, pt, n, friction);
}
template <class A>
SCREE_LAW V3<A> impulse_of(const PointLaw<A>& law, const V3<A>& n, const typename A::V& friction,
                           const V3<A>& p, const V3<A>& u) {
  const auto stuck = sticking(law, n, friction, p, u);
  const auto pn = normal_impulse_of(law, n, p, u);
  const V3<A> impulse = where(stuck.holds, stuck.impulse, pn * n);
  // No point slides: the sliding part, which costs as much as everything before, is left out.
  if (!A::any((!stuck.holds) & (pn > 0))) return impulse;
  return where(stuck.holds, impulse, sliding_impulse(law, n, friction, p, u, pn));
}

/// Returns the ratio of a couple to the change of the spin with which two balls roll (kg m^2), from the sum
/// of their inverse inertias; 0 where nothing turns.
template <class A>
SCREE_LAW typename A::V rolling_mass(const typename A::V& inverse_inertia) {
  return inverse_inertia > 0 ? 1.0 / inverse_inertia : typename A::V{};
}
/// Returns the smallest such ratio for any two bodies; 0 where nothing turns.
template <class A>
SCREE_LAW typename A::V rolling_mass(const Symmetric<A>& inverse_inertia, const V3<A>& n) {
  return rolling_mass<A>(largest_across(inverse_inertia, n));
}

/// Returns the couple on j of a contact that carries the couple `last`. It acts against the spin of j
/// relative to i with which they roll, and not about the normal. It is a projected step, in the disc of
/// radius `most`; for balls it is the exact solution at this impulse.
template <class A>
SCREE_LAW V3<A> couple_of(const V3<A>& n, const typename A::V& most, const typename A::V& mass,
                          const V3<A>& last, const V3<A>& spin) {
  const V3<A> step = last - mass * spin;
  return cut_to_disc(step - dot(step, n) * n, most);
}

/// Returns how much more (kg m) a point pushes in the position correction, if it has pushed by `pushed` so
/// far, to remove a share of its overlap, at most `cap` (m). If other contacts have opened the gap since, the
/// point takes back its own push, so that bodies move apart no more than they must. Sets `pushed` to the new
/// total.
template <class A>
SCREE_LAW typename A::V correction_push(const typename A::V& gap, const typename A::V& cap,
                                        const typename A::V& share, const typename A::V& normal_mass,
                                        typename A::V& pushed) {
  using V = typename A::V;
  const V part = -share * gap;
  const V before = pushed;
  pushed = above_zero<A>(before + (part < cap ? part : cap) * normal_mass);
  return pushed - before;
}

}  // namespace scree::simd
