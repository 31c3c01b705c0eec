// Couples of rolling friction: their initial values, and the accounts of their energy.
#pragma once

#include "sim/contacts/contact_accounts.hpp"
#include "sim/contacts/find_stage.hpp"
#include "sim/contacts/rolling_visits.hpp"

#include <cstdint>

namespace scree::solver {

/// Sets the initial couple of a contact to the one that its slot remembers, cut to the disc that the initial
/// normal impulse allows. Points of walls that turn get the spins of the walls.
template <class Real, class Contacts>
struct StartRolling {
  FindStage<Real> stage;
  std::int64_t first_place;
  Contacts contacts;
  RollingFields<Real> rolling;
  ConstView<V3<Real>> couples;  ///< couples of all slots, by place
  View<BodyRecord<Real>> solver;

  SCREE_HD void operator()(std::int64_t c) const {
    using R = RollingFields<Real>;
    const std::int64_t place = first_place + contacts.slot[c];
    const Slot slot = stage.places[place];
    const SlotBodies<Real> at = stage.load(slot);
    const auto reach = static_cast<Real>(stage.laws.rolling_reach(slot.i, slot.j));
    const V3<Real> n = contacts.fields.vector(Contacts::normal, c);
    const auto share = static_cast<Real>(stage.parameters.warm_start ? stage.scale : 0.0);
    const V3<Real> couple = simd::couple_of<Scalar<Real>>(
        n, reach * normal_impulse_of<Scalar<Real>>(contacts, c), Real{}, share * couples[place], V3<Real>{});
    rolling.fields.at(R::reach, c) = reach;
    rolling.fields.set(R::couple, c, couple);
    rolling.fields.set(R::last, c, couple);
    if (stage.is_wall_point(at.a, slot.i, slot.end_i))
      solver[slot.end_i].spin = v3<Real>(stage.bodies.spin[slot.i]);
    if (stage.is_wall_point(at.b, slot.j, slot.end_j))
      solver[slot.end_j].spin = v3<Real>(stage.bodies.spin[slot.j]);
  }
};

/// Accounts for the energy that the couple of a contact has moved, as account_couple() does, and stores the
/// couple in the contact's slot.
template <class Real, class Contacts>
struct AccountRolling {
  AccountStage<Real> stage;
  std::int64_t first_place;
  Contacts contacts;
  RollingFields<Real> rolling;
  View<V3<Real>> couples;  ///< couples of all slots, by place

  SCREE_HD ContactTotals operator()(std::int64_t c) const {
    const std::int64_t place = first_place + contacts.slot[c];
    const V3<Real> found = rolling.fields.vector(RollingFields<Real>::couple, c);
    couples[place] = found;
    ContactTotals totals;
    if (is_zero(found)) return totals;
    const Slot slot = stage.places[place];
    const Ends ends = contacts.ends[c];
    const Vec3 couple = vec3(found);
    const BodyRecord<Real> i = load_whole(stage.solver[ends.i]);
    const BodyRecord<Real> j = load_whole(stage.solver[ends.j]);
    const Vec3 spin_i = vec3(i.spin), spin_j = vec3(j.spin);
    const Vec3 before = stage.bodies.spin[slot.j] - stage.bodies.spin[slot.i];
    const Vec3 free = vec3(stage.free[ends.j].spin) - vec3(stage.free[ends.i].spin);
    totals.friction = -0.5 * couple.dot(before + spin_j - spin_i);
    totals.impulse_power = couple.dot(spin_j - spin_i - free);
    stage.judge_gain(totals);
    if (!(i.inverse_mass > 0)) totals.work += couple.dot(spin_i);
    if (!(j.inverse_mass > 0)) totals.work -= couple.dot(spin_j);
    return totals;
  }
};

/// Sums the energy that the impulses of a contact and its couple move. `Account` is AccountBalls or
/// AccountPoints.
template <class Account, class Rolling>
struct MovedBy {
  bool rolls;
  Account account;
  Rolling rolling;
  SCREE_HD Moved operator()(std::int64_t c) const {
    return rolls ? account(c).moved() + rolling(c).moved() : account(c).moved();
  }
};

}  // namespace scree::solver
