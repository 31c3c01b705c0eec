// Visits to contacts that find the couples of rolling friction; they follow the visits that find the
// impulses.
#pragma once

#include "sim/contacts/sweeps.hpp"

#include <cstdint>

namespace scree::solver {

/// The fields of rolling friction of each contact; they are empty if nothing rolls.
template <class Real>
struct RollingFields {
  enum Field {
    reach,              ///< largest couple for a unit normal impulse (m)
    couple,             ///< couple on j, reversed on i, perpendicular to the normal (N m s)
    last = couple + 3,  ///< the couple before the last sweep
    count = last + 3
  };
  Fields<Real, count> fields;
};

template <class A, class Real>
SCREE_LAW typename A::V normal_impulse_of(const BallContacts<Real>& contacts, std::int64_t c) {
  using C = BallContacts<Real>;
  return dot(contacts.fields.template vector<A>(C::impulse, c),
             contacts.fields.template vector<A>(C::normal, c));
}
template <class A, class Real>
SCREE_LAW typename A::V normal_impulse_of(const PointContacts<Real>& contacts, std::int64_t c) {
  using C = PointContacts<Real>;
  simd::V3<A> sum{};
  const int count = A::most(contacts.points + c);
  for (int p = 0; p < count; ++p)
    sum = sum + contacts.point_fields.template vector<A>(C::at_point(p, C::impulse), c);
  return dot(sum, contacts.fields.template vector<A>(C::normal, c));
}

/// The effect of a couple on the bodies of a contact of balls.
struct TurnBalls {
  template <class A, class Real>
  SCREE_LAW static Two<A, typename A::V> of(const BallContacts<Real>&, std::int64_t,
                                            const Two<A, simd::Moving<A>>& bodies) {
    return {bodies.i.inverse_inertia, bodies.j.inverse_inertia};
  }
  template <class A>
  SCREE_LAW static typename A::V mass(const typename A::V& inverse_inertia, const simd::V3<A>&) {
    return simd::rolling_mass<A>(inverse_inertia);
  }
};
/// The effect of a couple on the bodies of a contact of any shapes.
struct TurnPoints {
  template <class A, class Real>
  SCREE_LAW static Two<A, simd::Symmetric<A>> of(const PointContacts<Real>& contacts, std::int64_t c,
                                                 const Two<A, simd::Moving<A>>&) {
    return inertia_of<A>(contacts, c);
  }
  template <class A>
  SCREE_LAW static typename A::V mass(const simd::Symmetric<A>& inverse_inertia, const simd::V3<A>& n) {
    return simd::rolling_mass<A>(inverse_inertia, n);
  }
};

template <class A, class By>
SCREE_LAW void turn_by(const Two<A, By>& by, const simd::V3<A>& couple, Two<A, simd::Moving<A>>& two) {
  two.i.spin = two.i.spin - by.i * couple;
  two.j.spin = two.j.spin + by.j * couple;
}

/// Applies the couple that a contact has to its bodies. Turn is TurnBalls or TurnPoints.
template <class Real, class Contacts, class Turn>
struct PushRolling {
  Contacts contacts;
  RollingFields<Real> rolling;
  BodyRecord<Real>* bodies;

  template <class A>
  SCREE_LAW void visit(std::int64_t c) const {
    const simd::V3<A> couple = rolling.fields.template vector<A>(RollingFields<Real>::couple, c);
    if (!A::any(!is_zero(couple))) return;
    const Ends* const ends = contacts.ends + c;
    auto two = bodies_of<A>(bodies, ends);
    turn_by<A>(Turn::template of<A>(contacts, c, two), couple, two);
    store<A>(two, bodies, ends);
  }
};

/// Finds the couple of a contact whose impulse has been found.
template <class Real, class Contacts, class Turn>
struct Roll {
  Contacts contacts;
  RollingFields<Real> rolling;
  BodyRecord<Real>* bodies;
  bool remembers;  ///< whether the couple before the visit is stored as `last`; if not, beta is 0

  template <class A>
  SCREE_LAW ChangeOf<A> visit(std::int64_t c, Real beta) const {
    using R = RollingFields<Real>;
    using V3 = simd::V3<A>;
    const auto& f = rolling.fields;
    const auto reach = f.template get<A>(R::reach, c);
    if (!A::any(reach > 0)) return {};
    const Ends* const ends = contacts.ends + c;
    auto two = bodies_of<A>(bodies, ends);
    const auto turning = Turn::template of<A>(contacts, c, two);
    const V3 before = f.template vector<A>(R::couple, c);
    const V3 last = remembers ? f.template vector<A>(R::last, c) : before;
    const V3 ahead = before + A::all(beta) * (before - last);
    const V3 n = contacts.fields.template vector<A>(Contacts::normal, c);
    const auto mass = Turn::template mass<A>(turning.i + turning.j, n);
    const V3 couple = simd::couple_of<A>(n, reach * normal_impulse_of<A>(contacts, c), mass, ahead,
                                         two.j.spin - two.i.spin);
    const V3 change = couple - ahead;
    turn_by<A>(turning, change, two);
    store<A>(two, bodies, ends);
    if (remembers) f.template put<A>(R::last, c, before);
    f.template put<A>(R::couple, c, couple);
    const auto inverse = mass > 0 ? 1 / mass : typename A::V{};
    return {dot(change, change) * inverse, dot(couple, couple) * inverse};
  }
};

}  // namespace scree::solver
