// Visits to the contacts of a substep: visits that find the impulses, and visits of the position correction,
// which move overlapping bodies apart. Each visit is written once, for an arithmetic A that works on one
// contact or on several side by side (Scalar, and ContactLanes in visit_kernels.cpp).
#pragma once

#include "core/space_prefetch.hpp"
#include "core/space_unroll.hpp"
#include "sim/contacts/layout.hpp"

#include <cstdint>

namespace scree::solver {

/// The largest number of points of a contact.
inline constexpr int most_points = Manifold::max_points;

/// The state that one sweep of a substep leaves to the next.
struct SweepState {
  double last_step = 0;
  double beta = 0;  ///< factor by which the next sweep extrapolates the last change, rounded
  std::int32_t sweeps = 0;
  bool pushed = false;  ///< whether the bodies have received the remembered impulses
  bool converged = false;
};

/// The change of the impulses by a sweep, and their size, as in ImpulseChange. The sums are in double, since
/// the decisions made with them (ImpulsePhases::judge) must not depend on the order of their terms.
struct SweepChange {
  double step = 0, size = 0;
  SCREE_HD friend SweepChange operator+(const SweepChange& a, const SweepChange& b) {
    return {a.step + b.step, a.size + b.size};
  }
};

/// The change of the impulses by one visit, and their size.
template <class A>
struct ChangeOf {
  typename A::V step{}, size{};
  SCREE_LAW friend ChangeOf operator+(const ChangeOf& a, const ChangeOf& b) {
    return {a.step + b.step, a.size + b.size};
  }
  SCREE_LAW operator SweepChange() const requires(A::width == 1) {
    return {static_cast<double>(step), static_cast<double>(size)};
  }
};

template <class A, class Real>
SCREE_LAW simd::Balls<A> balls_at(const BallContacts<Real>& contacts, std::int64_t c) {
  using C = BallContacts<Real>;
  const auto get = [&](int field) { return contacts.fields.template get<A>(field, c); };
  return {contacts.fields.template vector<A>(C::normal, c),
          get(C::arm_i),
          get(C::arm_j),
          get(C::friction),
          get(C::target),
          get(C::normal_mass),
          get(C::tangent_mass)};
}

template <class A, class Real>
SCREE_LAW simd::Point<A> point_at(const PointContacts<Real>& contacts, std::int64_t c, int k) {
  using C = PointContacts<Real>;
  const auto& f = contacts.point_fields;
  return {f.template vector<A>(C::at_point(k, C::arm_i), c),
          f.template vector<A>(C::at_point(k, C::arm_j), c)};
}

template <class A, class Real>
SCREE_LAW simd::PointLaw<A> law_at(const PointContacts<Real>& contacts, std::int64_t c, int k) {
  using C = PointContacts<Real>;
  const auto& f = contacts.point_fields;
  const auto get = [&](auto field) { return f.template get<A>(C::at_point(k, field), c); };
  const auto stick = [&](int e) { return f.template get<A>(C::at_point(k, C::stick) + e, c); };
  return {{stick(0), stick(1), stick(2), stick(3), stick(4), stick(5)},
          f.template vector<A>(C::at_point(k, C::coupling), c),
          get(C::target),
          get(C::normal_mass),
          get(C::tangent_mass)};
}

/// The two bodies of each contact that A works on.
template <class A, class Body>
struct Two {
  Body i, j;
};
template <class A, class Record>
SCREE_LAW auto bodies_of(const Record* bodies, const Ends* ends) {
  auto i = A::template bodies<End::i>(bodies, ends);
  auto j = A::template bodies<End::j>(bodies, ends);
  return Two<A, decltype(i)>{i, j};
}
template <class A, class Body, class Record>
SCREE_LAW void store(const Two<A, Body>& two, Record* bodies, const Ends* ends) {
  A::template put<End::i>(two.i, bodies, ends);
  A::template put<End::j>(two.j, bodies, ends);
}
template <class A, class Real>
SCREE_LAW Two<A, simd::Symmetric<A>> inertia_of(const PointContacts<Real>& contacts, std::int64_t c) {
  using C = PointContacts<Real>;
  const auto& f = contacts.fields;
  const auto at = [&](int first) {
    return simd::Symmetric<A>{f.template get<A>(first, c),     f.template get<A>(first + 1, c),
                              f.template get<A>(first + 2, c), f.template get<A>(first + 3, c),
                              f.template get<A>(first + 4, c), f.template get<A>(first + 5, c)};
  };
  return {at(C::inertia_i), at(C::inertia_j)};
}

/// Applies the impulse of a contact of balls to its bodies.
template <class Real>
struct PushBalls {
  BallContacts<Real> contacts;
  BodyRecord<Real>* bodies;

  template <class A>
  SCREE_LAW void visit(std::int64_t c) const {
    const Ends* const ends = contacts.ends + c;
    auto two = bodies_of<A>(bodies, ends);
    push(balls_at<A>(contacts, c), contacts.fields.template vector<A>(BallContacts<Real>::impulse, c), two.i,
         two.j);
    store<A>(two, bodies, ends);
  }
};

template <class Real>
struct PushPoints {
  PointContacts<Real> contacts;
  BodyRecord<Real>* bodies;

  template <class A>
  SCREE_LAW void visit(std::int64_t c) const {
    using C = PointContacts<Real>;
    const Ends* const ends = contacts.ends + c;
    auto two = bodies_of<A>(bodies, ends);
    const auto turning = inertia_of<A>(contacts, c);
    const int count = A::most(contacts.points + c);
    for (int p = 0; p < count; ++p) {
      push<A>(turning.i, turning.j, point_at<A>(contacts, c, p),
              contacts.point_fields.template vector<A>(C::at_point(p, C::impulse), c), two.i, two.j);
    }
    store<A>(two, bodies, ends);
  }
};

/// Solves a contact of balls. The impulse is first extrapolated by beta times its change in the last sweep;
/// Accelerate has done the same to the velocities of the bodies.
template <class Real>
struct SweepBalls {
  BallContacts<Real> contacts;
  BodyRecord<Real>* bodies;
  bool remembers;  ///< whether the impulse before the visit is stored as C::last; if not, beta is 0

  template <class A>
  SCREE_LAW ChangeOf<A> visit(std::int64_t c, Real beta) const {
    using C = BallContacts<Real>;
    const auto& f = contacts.fields;
    const Ends* const ends = contacts.ends + c;
    auto two = bodies_of<A>(bodies, ends);
    const simd::V3<A> before = f.template vector<A>(C::impulse, c);
    const simd::V3<A> last = remembers ? f.template vector<A>(C::last, c) : before;
    const simd::V3<A> ahead = before + A::all(beta) * (before - last);
    auto balls = balls_at<A>(contacts, c);
    // Many contacts are open and stay so; nothing more is done for them. Several contacts side by side are
    // seldom all open.
    if constexpr (A::width == 1) {
      load_here(balls.arm_i, balls.arm_j, balls.friction, balls.normal_mass, balls.tangent_mass);
      if (is_zero(before) && is_zero(last) &&
          dot(balls.normal, two.j.velocity - two.i.velocity) >= balls.target)
        return {};
    }
    const simd::V3<A> p = impulse_of(balls, ahead, two.i, two.j);
    const simd::V3<A> change = p - ahead;
    push(balls, change, two.i, two.j);
    store<A>(two, bodies, ends);
    if (remembers) f.template put<A>(C::last, c, before);
    f.template put<A>(C::impulse, c, p);
    return {dot(change, change) / balls.normal_mass, dot(p, p) / balls.normal_mass};
  }
};

/// Solves the points of a contact, one after the other. On a GPU the loads of all points are issued before
/// the first of them is used.
template <class Real>
struct SweepPoints {
  PointContacts<Real> contacts;
  BodyRecord<Real>* bodies;
  int block_sweeps;

  template <class A>
  SCREE_LAW ChangeOf<A> visit(std::int64_t c, Real beta) const {
    using C = PointContacts<Real>;
    using V3 = simd::V3<A>;
    const Ends* const ends = contacts.ends + c;
    auto two = bodies_of<A>(bodies, ends);
    const auto turning = inertia_of<A>(contacts, c);
    const V3 n = contacts.fields.template vector<A>(C::normal, c);
    const auto friction = contacts.fields.template get<A>(C::friction, c);
    const int count = A::most(contacts.points + c);
    const auto& f = contacts.point_fields;
    simd::Point<A> points[most_points]{};
    simd::PointLaw<A> laws[most_points]{};
    V3 before[most_points]{}, last[most_points]{};
    SCREE_UNROLL for (int p = 0; p < most_points; ++p) {
      if (p >= count) continue;
      before[p] = f.template vector<A>(C::at_point(p, C::impulse), c);
      last[p] = f.template vector<A>(C::at_point(p, C::last), c);
      if constexpr (is_gpu_code) {
        points[p] = point_at<A>(contacts, c, p);
        laws[p] = law_at<A>(contacts, c, p);
      }
    }
    const auto point = [&](int p) { return is_gpu_code ? points[p] : point_at<A>(contacts, c, p); };
    const auto law = [&](int p) { return is_gpu_code ? laws[p] : law_at<A>(contacts, c, p); };
    V3 ahead[most_points]{}, now[most_points]{};
    SCREE_UNROLL for (int p = 0; p < most_points; ++p) {
      if (p >= count) continue;
      now[p] = ahead[p] = before[p] + A::all(beta) * (before[p] - last[p]);
      f.template put<A>(C::at_point(p, C::last), c, before[p]);
    }
    for (int sweep = 0; sweep < block_sweeps; ++sweep) {
      SCREE_UNROLL for (int p = 0; p < most_points; ++p) {
        if (p >= count) continue;
        const auto at = point(p);
        const V3 impulse = impulse_of(law(p), n, friction, now[p], velocity_at(at, two.i, two.j));
        push<A>(turning.i, turning.j, at, impulse - now[p], two.i, two.j);
        now[p] = impulse;
      }
    }
    store<A>(two, bodies, ends);
    ChangeOf<A> total;
    SCREE_UNROLL for (int p = 0; p < most_points; ++p) {
      if (p >= count) continue;
      f.template put<A>(C::at_point(p, C::impulse), c, now[p]);
      const V3 change = now[p] - ahead[p];
      const auto mass =
          is_gpu_code ? laws[p].normal_mass : f.template get<A>(C::at_point(p, C::normal_mass), c);
      total = total + ChangeOf<A>{dot(change, change) / mass, dot(now[p], now[p]) / mass};
    }
    return total;
  }
};

/// Extrapolates the velocities of the bodies by beta, as the visits do with the impulses: velocities are
/// linear in the impulses.
template <class Real>
struct Accelerate {
  BodyRecord<Real>* bodies;
  BodyRecord<Real>* last;

  /// Extrapolates body k.
  SCREE_LAW void visit(std::int64_t k, Real beta) const {
    const BodyRecord<Real> now = bodies[k];
    if (beta > 0) {
      BodyRecord<Real> ahead = now;
      const BodyRecord<Real> before = last[k];
      ahead.velocity = now.velocity + beta * (now.velocity - before.velocity);
      ahead.spin = now.spin + beta * (now.spin - before.spin);
      bodies[k] = ahead;
    }
    last[k] = now;
  }
};

/// The displacements or the turns of the bodies, and those before the last sweep of the position correction.
template <class Real>
struct Displacements {
  CentreRecord<Real>* now;
  CentreRecord<Real>* last;

  /// Extrapolates those of body k by beta, as the visits do with the pushes.
  SCREE_LAW void extrapolate(std::int64_t k, Real beta) const {
    const CentreRecord<Real> body = now[k];
    if (beta > 0) now[k].velocity = body.velocity + beta * (body.velocity - last[k].velocity);
    last[k] = body;
  }
};

/// The overlaps that a sweep of the position correction has found, relative to the cap.
struct Overlaps {
  float deepest = 0;
  double sum = 0;
  double count = 0;

  SCREE_HD static Overlaps of_gap(float gap) {
    if (!(gap < 0)) return {};
    return {-gap, -static_cast<double>(gap), 1};
  }
  SCREE_HD friend Overlaps operator+(const Overlaps& a, const Overlaps& b) {
    return {a.deepest > b.deepest ? a.deepest : b.deepest, a.sum + b.sum, a.count + b.count};
  }
};

/// Moves the bodies of a contact of balls apart. The push is first extrapolated by beta times its change in
/// the last sweep; Displacements::extrapolate has done the same to the bodies. visit() returns the gap before
/// the push changes, relative to the cap; it is 0 or more where nothing overlapped.
template <class Real>
struct CorrectBalls {
  BallContacts<Real> contacts;
  CentreRecord<Real>* bodies;
  Real share;
  bool remembers;  ///< whether the push before the visit is stored as C::pushed_before; if not, beta is 0

  template <class A>
  SCREE_LAW typename A::V visit(std::int64_t c, Real beta) const {
    using C = BallContacts<Real>;
    const auto& f = contacts.fields;
    const Ends* const ends = contacts.ends + c;
    auto two = bodies_of<A>(bodies, ends);
    const simd::V3<A> n = f.template vector<A>(C::normal, c);
    const auto gap =
        contacts.gaps.template get<A>(C::predicted_gap, c) + dot(n, two.j.velocity - two.i.velocity);
    const auto before = contacts.gaps.template get<A>(C::pushed, c);
    const auto last = remembers ? contacts.gaps.template get<A>(C::pushed_before, c) : before;
    auto cap = contacts.gaps.template get<A>(C::cap, c);
    auto mass = f.template get<A>(C::normal_mass, c);
    if constexpr (A::width == 1) load_here(cap, mass);
    if (!A::any((gap < 0) | (before > 0) | (last > 0))) return typename A::V{};
    auto pushed = before + A::all(beta) * (before - last);
    const auto more = simd::correction_push<A>(gap, cap, A::all(share), mass, pushed);
    push_centres(more * n, two.i, two.j);
    store<A>(two, bodies, ends);
    contacts.gaps.template put<A>(C::pushed, c, pushed);
    if (remembers) contacts.gaps.template put<A>(C::pushed_before, c, before);
    return gap / cap;
  }
};

/// Moves the bodies of a contact of several points apart. All points share one normal, so a displacement
/// along it changes all their gaps by the same amount. visit() returns the least gap, relative to the cap.
template <class Real>
struct CorrectPoints {
  PointContacts<Real> contacts;
  CentreRecord<Real>* bodies;
  CentreRecord<Real>* turns;
  Real share;
  bool remembers;

  template <class A>
  SCREE_LAW typename A::V visit(std::int64_t c, Real beta) const {
    using C = PointContacts<Real>;
    using V = typename A::V;
    const Ends* const ends = contacts.ends + c;
    auto centres = bodies_of<A>(bodies, ends);
    auto turned = bodies_of<A>(turns, ends);
    const auto turning = inertia_of<A>(contacts, c);
    const simd::V3<A> n = contacts.fields.template vector<A>(C::normal, c);
    const V cap = contacts.fields.template get<A>(C::cap, c);
    const V masses = centres.i.inverse_mass + centres.j.inverse_mass;
    V apart = dot(n, centres.j.velocity - centres.i.velocity);
    V pushed_apart{}, least{};
    const int count = A::most(contacts.points + c);
    simd::Point<A> points[most_points]{};
    V predicted_gap[most_points]{}, before[most_points]{}, pushed[most_points]{}, masses_there[most_points]{};
    bool parts[most_points]{};
    const auto mass_at = [&](int p) {
      return contacts.point_fields.template get<A>(C::at_point(p, C::normal_mass), c);
    };
    SCREE_UNROLL for (int p = 0; p < most_points; ++p) {
      if (p >= count) continue;
      predicted_gap[p] = contacts.gaps.template get<A>(C::at_point(p, C::predicted_gap), c);
      before[p] = contacts.gaps.template get<A>(C::at_point(p, C::pushed), c);
      const V last =
          remembers ? contacts.gaps.template get<A>(C::at_point(p, C::pushed_before), c) : before[p];
      parts[p] = A::any((before[p] > 0) | (last > 0));
      pushed[p] = before[p] + A::all(beta) * (before[p] - last);
      if constexpr (is_gpu_code) {
        points[p] = point_at<A>(contacts, c, p);
        masses_there[p] = mass_at(p);
      }
    }
    SCREE_UNROLL for (int p = 0; p < most_points; ++p) {
      if (p >= count) continue;
      const auto at = is_gpu_code ? points[p] : point_at<A>(contacts, c, p);
      const simd::V3<A> lever_i = cross(at.arm_i, n), lever_j = cross(at.arm_j, n);
      const V gap =
          predicted_gap[p] + apart + (dot(lever_j, turned.j.velocity) - dot(lever_i, turned.i.velocity));
      parts[p] = parts[p] || A::any(gap < 0);
      if (parts[p]) {
        const V mass = is_gpu_code ? masses_there[p] : mass_at(p);
        const V more = simd::correction_push<A>(gap, cap, A::all(share), mass, pushed[p]);
        apart = apart + masses * more;
        pushed_apart = pushed_apart + more;
        turned.i.velocity = turned.i.velocity - more * (turning.i * lever_i);
        turned.j.velocity = turned.j.velocity + more * (turning.j * lever_j);
      }
      least = gap < least ? gap : least;
    }
    push_centres(pushed_apart * n, centres.i, centres.j);
    store<A>(centres, bodies, ends);
    store<A>(turned, turns, ends);
    SCREE_UNROLL for (int p = 0; p < most_points; ++p) {
      if (p >= count || !parts[p]) continue;
      contacts.gaps.template put<A>(C::at_point(p, C::pushed), c, pushed[p]);
      if (remembers) contacts.gaps.template put<A>(C::at_point(p, C::pushed_before), c, before[p]);
    }
    return least / cap;
  }
};

}  // namespace scree::solver
