// Work on contacts for the accurate mode: the residual of their impulses, and the time at which a sliding
// contact comes to stick.
#pragma once

#include "core/tolerances.hpp"
#include "sim/contacts/contact_accounts.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/rolling_visits.hpp"
#include "sim/contacts/slots.hpp"
#include "sim/impacts/flight_stage.hpp"
#include "sim/laws/contact_row.hpp"

#include <cmath>
#include <cstdint>

namespace scree::solver {

template <class Real>
SCREE_HD inline int points_of(const BallContacts<Real>&, std::int64_t) {
  return 1;
}
template <class Real>
SCREE_HD inline int points_of(const PointContacts<Real>& contacts, std::int64_t c) {
  return contacts.points[c];
}

/// Returns point k of a contact as a row, with its arms, target, masses and impulse, but without its gap.
template <class Real>
SCREE_HD inline ContactRow row_of(const BallContacts<Real>& contacts, std::int64_t c, int) {
  using C = BallContacts<Real>;
  const auto number = [&](int field) { return static_cast<double>(contacts.fields.at(field, c)); };
  const Vec3 normal = vec3(contacts.fields.vector(C::normal, c));
  ContactRow row = row_at(number(C::arm_i) * normal, number(C::arm_j) * normal, 0);
  row.target = number(C::target);
  row.normal_mass = number(C::normal_mass);
  row.tangent_mass = number(C::tangent_mass);
  row.impulse = vec3(contacts.fields.vector(C::impulse, c));
  return row;
}
template <class Real>
SCREE_HD inline ContactRow row_of(const PointContacts<Real>& contacts, std::int64_t c, int k) {
  using C = PointContacts<Real>;
  const auto& f = contacts.point_fields;
  const auto number = [&](auto field) { return static_cast<double>(f.at(C::at_point(k, field), c)); };
  const auto vector = [&](auto field) { return vec3(f.vector(C::at_point(k, field), c)); };
  ContactRow row = row_at(vector(C::arm_i), vector(C::arm_j), 0);
  row.target = number(C::target);
  row.normal_mass = number(C::normal_mass);
  row.tangent_mass = number(C::tangent_mass);
  row.impulse = vector(C::impulse);
  return row;
}

/// The natural residual of a contact: the change of its present impulses and its couple by natural_map().
template <class Real, class Contacts, class Turn>
struct Residual {
  Contacts contacts;
  bool rolls;  ///< whether contacts have couples
  RollingFields<Real> rolling;
  ConstView<BodyRecord<Real>> solver;

  SCREE_HD ImpulseChange operator()(std::int64_t c) const {
    return rolls ? of_impulses(c) + of_couple(c) : of_impulses(c);
  }

 private:
  SCREE_HD ImpulseChange of_impulses(std::int64_t c) const {
    const Vec3 normal = vec3(contacts.fields.vector(Contacts::normal, c));
    const auto friction = static_cast<double>(contacts.fields.at(Contacts::friction, c));
    const BodyRecord<Real>& i = solver[contacts.ends[c].i];
    const BodyRecord<Real>& j = solver[contacts.ends[c].j];
    ImpulseChange residual;
    for (int k = 0; k < points_of(contacts, c); ++k) {
      const ContactRow row = row_of(contacts, c, k);
      const Vec3 u = row.relative_velocity(vec3(i.velocity), vec3(i.spin), vec3(j.velocity), vec3(j.spin));
      residual.add(row, natural_map(row, normal, friction, u) - row.impulse);
    }
    return residual;
  }
  SCREE_HD ImpulseChange of_couple(std::int64_t c) const {
    using A = Scalar<Real>;
    const auto two = bodies_of<A>(solver.data(), contacts.ends + c);
    const auto turning = Turn::template of<A>(contacts, c, two);
    const V3<Real> n = contacts.fields.vector(Contacts::normal, c);
    const Real mass = Turn::template mass<A>(turning.i + turning.j, n);
    if (mass == 0) return {};
    const V3<Real> couple = rolling.fields.vector(RollingFields<Real>::couple, c);
    const Real most = rolling.fields.at(RollingFields<Real>::reach, c) * normal_impulse_of<A>(contacts, c);
    const V3<Real> change = simd::couple_of<A>(n, most, mass, couple, two.j.spin - two.i.spin) - couple;
    return {static_cast<double>(dot(change, change) / mass), static_cast<double>(dot(couple, couple) / mass)};
  }
};

/// The earliest of several times; its operator + takes the minimum.
struct Earliest {
  double time = HUGE_VAL;
  SCREE_HD friend Earliest operator+(const Earliest& a, const Earliest& b) { return {fmin(a.time, b.time)}; }
};

/// Finds when a sliding contact that carried a load in the last substep comes to stick, as a share of this
/// substep; 1 if it does not. If it slid during the whole substep, friction would be k times the friction
/// that holds it at the end (k < 0 where that one points up a slope), and the sliding speed of its points
/// would change from `before` to `free - k free` (docs/decisions/0015).
template <class Real, class Contacts>
struct SlipEnd {
  AccountStage<Real> stage;
  std::int64_t first_place;
  Contacts contacts;
  ConstView<LoadedParts> loads;  ///< loaded parts of each candidate in the last substep

  SCREE_HD Earliest operator()(std::int64_t c) const {
    const Slot& slot = stage.places[first_place + contacts.slot[c]];
    const bool flying = (contacts.flags[c] & flag_flying) != 0;
    if (flying || !loads[slot.candidate].is_loaded(stage.part_of(slot))) return {1.0};
    const Vec3 normal = vec3(contacts.fields.vector(Contacts::normal, c));
    const auto mu = static_cast<double>(contacts.fields.at(Contacts::friction, c));
    const int points = points_of(contacts, c);
    const EndBodies<Real> ends = stage.ends_of(contacts.ends[c]);
    const Vec3 kick = stage.kick_of(slot, ends);
    double before = 0, free = 0, after = 0, friction = 0, most_friction = 0;
    for (int k = 0; k < points; ++k) {
      const ContactRow row = row_of(contacts, c, k);
      const PointMotion u = stage.motion_of(row.arm_i, row.arm_j, slot, ends, kick);
      const Vec3 slip = across(u.before, normal);
      const double speed = slip.norm();
      if (speed > 0) {
        free += u.free.dot(slip) / speed;
        friction -= row.impulse.dot(slip) / speed;
      }
      before += speed;
      after += across(u.after, normal).norm();
      most_friction += mu * row.impulse.dot(normal);
    }
    const bool slides = before * stage.step > points * tolerance::least_slide * size_of(slot);
    if (!slides || after > tolerance::sticking_slip * before || !(free * friction > 0)) return {1.0};
    const double share = before / (before + (most_friction / friction - 1) * free);
    return {share > tolerance::least_cut && share < 1 - tolerance::least_cut ? share : 1.0};
  }

 private:
  SCREE_HD static Vec3 across(const Vec3& v, const Vec3& normal) { return v - v.dot(normal) * normal; }
  SCREE_HD double size_of(const Slot& slot) const {
    const ConstBodyView& bodies = stage.bodies;
    return fmin(smallest_size(bodies.shape[slot.i], bodies.size[slot.i]),
                smallest_size(bodies.shape[slot.j], bodies.size[slot.j]));
  }
};

}  // namespace scree::solver
