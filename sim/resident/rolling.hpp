// Couples of rolling friction: for contacts of either kind, beside what their impulses need.
#pragma once

#include "sim/resident/books.hpp"
#include "sim/resident/find_stage.hpp"
#include "sim/resident/sweeps.hpp"

#include <cstdint>

namespace scree::resident {

/// Of each contact; without fields if nothing rolls.
template <class Real>
struct RollingFields {
  enum Field {
    reach,              ///< couple for each normal impulse, at most (m)
    couple,             ///< on j, and reversed on i, across the normal (N m s)
    last = couple + 3,  ///< the couple before the last sweep
    count = last + 3
  };
  Fields<Real> fields;
};

template <class Real>
SCREE_HD inline Real normal_impulse_of(const BallContacts<Real>& contacts, std::int64_t c) {
  using C = BallContacts<Real>;
  return dot(contacts.fields.vector(C::impulse, c), contacts.fields.vector(C::normal, c));
}
template <class Real>
SCREE_HD inline Real normal_impulse_of(const PointContacts<Real>& contacts, std::int64_t c) {
  using C = PointContacts<Real>;
  V3<Real> sum{};
  for (int p = 0; p < contacts.points[c]; ++p)
    sum = sum + contacts.point_fields.vector(C::at_point(p, C::impulse), c);
  return dot(sum, contacts.fields.vector(C::normal, c));
}

/// How couples turn the bodies of contacts: of balls,
template <class Real>
struct TurnBalls {
  SCREE_HD Real of(std::int32_t, const BodyRecord<Real>& body) const { return body.inverse_inertia; }
  SCREE_HD static Real mass(Real inverse_inertia, const V3<Real>&) {
    return lanes::rolling_mass<Scalar<Real>>(inverse_inertia);
  }
};
/// and of any.
template <class Real>
struct TurnPoints {
  const InertiaRecord<Real>* inertia;
  SCREE_HD lanes::Symmetric<Scalar<Real>> of(std::int32_t end, const BodyRecord<Real>&) const {
    return inertia[end];
  }
  SCREE_HD static Real mass(const lanes::Symmetric<Scalar<Real>>& inverse_inertia, const V3<Real>& n) {
    return lanes::rolling_mass<Scalar<Real>>(inverse_inertia, n);
  }
};

/// Starts from what the places remember, as far as the impulses that the contacts start from allow. Points of
/// walls that turn get the spins of these.
template <class Real, class Contacts>
struct StartRolling {
  FindStage<Real> stage;
  std::int64_t first_place;
  Contacts contacts;
  RollingFields<Real> rolling;
  ConstView<V3<Real>> couples;  ///< of all places
  View<BodyRecord<Real>> solver;

  SCREE_HD void operator()(std::int64_t c) const {
    using R = RollingFields<Real>;
    const std::int64_t place = first_place + c - c % 256 + contacts.slot[c];
    const Slot slot = stage.places[place];
    const SlotBodies<Real> at = stage.load(slot);
    const auto reach = static_cast<Real>(reach_of(at));
    const V3<Real> n = contacts.fields.vector(Contacts::normal, c);
    const auto share = static_cast<Real>(stage.parameters.warm_start ? stage.scale : 0.0);
    const V3<Real> couple = lanes::couple_of<Scalar<Real>>(n, reach * normal_impulse_of(contacts, c), Real{},
                                                           share * couples[place], V3<Real>{});
    rolling.fields.at(R::reach, c) = reach;
    rolling.fields.set(R::couple, c, couple);
    rolling.fields.set(R::last, c, couple);
    if (stage.is_wall_point(at.a, slot.i, slot.end_i))
      solver[slot.end_i].spin = v3<Real>(stage.bodies.spin[slot.i]);
    if (stage.is_wall_point(at.b, slot.j, slot.end_j))
      solver[slot.end_j].spin = v3<Real>(stage.bodies.spin[slot.j]);
  }

 private:
  /// ContactLaws::rolling_reach(), where balls are all that is round.
  SCREE_HD double reach_of(const SlotBodies<Real>& at) const {
    const auto curvature_of = [](const MidBody<Real>& body) {
      return body.shape == Shape::sphere ? 1 / body.size : 0.0;
    };
    const double curvature = curvature_of(at.a) + curvature_of(at.b);
    const double coefficient = stage.law_of(at).rolling_friction;
    return curvature > 0 ? coefficient / curvature : 0.0;
  }
};

/// Visits a contact whose impulse has been found: Turn is one of the above. Before the first sweep it gives
/// the bodies the couple that is there.
template <class Real, class Contacts, class Turn>
struct Roll {
  Contacts contacts;
  RollingFields<Real> rolling;
  Turn turn;
  BodyRecord<Real>* bodies;
  bool momentum;  ///< as of SweepBalls

  SCREE_HD void push(std::int64_t c) const {
    const V3<Real> couple = rolling.fields.vector(RollingFields<Real>::couple, c);
    if (is_zero<Real>(couple)) return;
    const Ends ends = contacts.ends[c];
    give(ends, couple, bodies[ends.i], bodies[ends.j]);
  }

  SCREE_HD SweepChange<Real> sweep(std::int64_t c, Real beta) const {
    using R = RollingFields<Real>;
    const Fields<Real>& f = rolling.fields;
    const Real reach = f.at(R::reach, c);
    if (reach == 0) return {};
    const Ends ends = contacts.ends[c];
    const V3<Real> before = f.vector(R::couple, c);
    const V3<Real> last = momentum ? f.vector(R::last, c) : before;
    const V3<Real> ahead = before + beta * (before - last);
    const V3<Real> n = contacts.fields.vector(Contacts::normal, c);
    const BodyRecord<Real> i = bodies[ends.i];
    const BodyRecord<Real> j = bodies[ends.j];
    const Real mass = Turn::mass(turn.of(ends.i, i) + turn.of(ends.j, j), n);
    const V3<Real> couple = lanes::couple_of<Scalar<Real>>(n, reach * normal_impulse_of(contacts, c), mass,
                                                           ahead, j.spin - i.spin);
    const V3<Real> change = couple - ahead;
    give(ends, change, i, j);
    if (momentum) f.set(R::last, c, before);
    f.set(R::couple, c, couple);
    const Real inverse = mass > 0 ? 1 / mass : Real{};
    return {dot(change, change) * inverse, dot(couple, couple) * inverse};
  }

 private:
  SCREE_HD void give(const Ends& ends, const V3<Real>& couple, const BodyRecord<Real>& from_i,
                     const BodyRecord<Real>& from_j) const {
    BodyRecord<Real> i = from_i;
    BodyRecord<Real> j = from_j;
    i.spin = i.spin - turn.of(ends.i, i) * couple;
    j.spin = j.spin + turn.of(ends.j, j) * couple;
    store_free(bodies, ends.i, i);
    store_free(bodies, ends.j, j);
  }
};

/// What the couple of a contact has moved, which its place remembers: account_couple().
template <class Real, class Contacts>
struct BookRolling {
  BookStage<Real> stage;
  std::int64_t first_place;
  Contacts contacts;
  RollingFields<Real> rolling;
  View<V3<Real>> couples;  ///< of all places

  SCREE_HD Books operator()(std::int64_t c) const {
    const std::int64_t place = first_place + c - c % 256 + contacts.slot[c];
    const V3<Real> found = rolling.fields.vector(RollingFields<Real>::couple, c);
    couples[place] = found;
    Books books;
    if (is_zero<Real>(found)) return books;
    const Slot slot = stage.places[place];
    const Ends ends = contacts.ends[c];
    const Vec3 couple = vec3(found);
    const Vec3 spin_i = vec3(stage.solver[ends.i].spin);
    const Vec3 spin_j = vec3(stage.solver[ends.j].spin);
    const Vec3 before = stage.bodies.spin[slot.j] - stage.bodies.spin[slot.i];
    books.friction = -0.5 * couple.dot(before + spin_j - spin_i);
    if (!stage.is_free(ends.i)) books.work += couple.dot(spin_i);
    if (!stage.is_free(ends.j)) books.work -= couple.dot(spin_j);
    return books;
  }
};

}  // namespace scree::resident
