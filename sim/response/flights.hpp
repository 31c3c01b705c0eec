// Corrections to contacts and bodies after impacts; they are needed only where a flight has had impacts.
#pragma once

#include "sim/contacts/contact_accounts.hpp"
#include "sim/contacts/contact_flight.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/observe/observation.hpp"
#include "sim/response/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace scree::solver {

/// Corrects the gap of a contact at the end of the substep, for changes of the velocities after the response.
template <class Real>
struct PredictGapsOfBalls {
  BallContacts<Real> contacts;
  ConstView<BodyRecord<Real>> before, after;
  double step;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    if ((contacts.flags[c] & flag_late_impact) != 0) return;
    const auto change = [&](std::int32_t k) { return after[k].velocity - before[k].velocity; };
    const V3<Real> u = change(contacts.ends[c].j) - change(contacts.ends[c].i);
    contacts.gaps.at(C::predicted_gap, c) +=
        static_cast<Real>(0.5 * step) * dot(contacts.fields.vector(C::normal, c), u);
  }
};
template <class Real>
struct PredictGapsOfPoints {
  PointContacts<Real> contacts;
  ConstView<BodyRecord<Real>> before, after;
  double step;
  bool rotations_are_applied;  ///< whether TurnLatePoints has added the rotations after the response
  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    // Once they are applied, the positions at the end of bodies with a late impact are measured directly.
    const bool is_late = (contacts.flags[c] & flag_late_impact) != 0;
    if (is_late && !rotations_are_applied) return;
    const Moving<Real> i = change(contacts.ends[c].i, is_late);
    const Moving<Real> j = change(contacts.ends[c].j, is_late);
    for (int k = 0; k < contacts.points[c]; ++k) {
      contacts.gaps.at(C::at_point(k, C::predicted_gap), c) +=
          static_cast<Real>(0.5 * step) * dot(contacts.fields.vector(C::normal, c),
                                              velocity_at(point_at<Scalar<Real>>(contacts, c, k), i, j));
    }
  }
  SCREE_HD Moving<Real> change(std::int32_t k, bool of_spin_alone) const {
    Moving<Real> body = after[k];
    body.velocity = of_spin_alone ? V3<Real>{} : body.velocity - before[k].velocity;
    body.spin = body.spin - before[k].spin;
    return body;
  }
};

/// Gives each body of the solver the velocities that its body has now.
template <class Real>
struct ReloadBody {
  ConstBodyView bodies;
  ConstView<Hub> hubs;
  ConstView<std::int32_t> hub_of;
  std::int64_t first_wall_point, first_part;
  ConstView<BodyRecord<Real>> before;
  View<BodyRecord<Real>> solver;

  SCREE_HD void operator()(std::int64_t k) const {
    solver[k] = before[k];
    const std::int64_t body = body_of(k);
    if (body < 0) return;
    solver[k].velocity = v3<Real>(bodies.velocity[body]);
    solver[k].spin = v3<Real>(bodies.spin[body]);
  }
  /// Returns the body that a body of the solver is, or is a part of; -1 for padding_body and wall points.
  SCREE_HD std::int64_t body_of(std::int64_t k) const {
    const std::int64_t padding_body = first_wall_point - 1;
    if (k >= first_part) return hubs[hub_of[k - first_part]].body;
    return k < padding_body ? k : -1;
  }
};

/// Takes the velocities of bodies after impacts in the second half of the substep, and replaces those before.
/// A body flies with its new velocity only for what is left of the substep. The replaced velocities are
/// chosen so that the change, over the whole half, moves the body by as much. The displacement of its centre
/// is known from where it is, however many impacts it had. Its turn is computed as if it had one impact.
template <class Real>
struct TakeImpacts {
  ReloadBody<Real> reload;
  ConstView<MidBody<Real>> mid;
  FlightStage flight;
  View<BodyRecord<Real>> before;

  SCREE_HD void operator()(std::int64_t k) const {
    reload(k);
    const std::int64_t body = reload.body_of(k);
    if (body < 0 || !flight.is_free(static_cast<std::int32_t>(body))) return;
    const BodyRecord<Real> after = reload.solver[k];
    const double half = 0.5 * flight.terms.step;
    const Vec3 moved = flight.bodies.position[body] - mid[body].position;
    const double left = (flight.terms.step - flight.clock[body]) / half;
    before[k].velocity = before[k].velocity - v3<Real>(moved / half);
    before[k].spin = after.spin - static_cast<Real>(left) * (after.spin - before[k].spin);
  }
};

/// Adds to the gap at the end of the substep of a late contact what its points move by the spins of the two
/// bodies, after the response. The contact was found `delay` after the midpoint, with the spins before the
/// response. A body that was struck late itself flies with its new spin from its impact on
/// (shift_after_late_impact()), and others do from the midpoint on.
template <class Real>
struct TurnLateBalls {
  BallContacts<Real> contacts;
  ConstView<Slot> places;
  ConstView<BodyRecord<Real>> solver;
  FlightStage flight;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    if ((contacts.flags[c] & flag_late_impact) == 0) return;
    const Slot& slot = places[contacts.slot[c]];
    const double left = flight.terms.step - fmax(flight.clock[slot.i], flight.clock[slot.j]);
    const Vec3 turned = turning_of(slot.j, slot.end_j) - turning_of(slot.i, slot.end_i);
    contacts.gaps.at(C::predicted_gap, c) +=
        static_cast<Real>(left * vec3(contacts.fields.vector(C::normal, c)).dot(turned));
  }

 private:
  /// Returns the velocity of a wall point relative to the centre of its wall. The point of a ball that
  /// touches is always the one on the normal.
  SCREE_HD Vec3 turning_of(std::int32_t body, std::int32_t end) const {
    const BodyView& bodies = flight.bodies;
    const bool is_wall_point = bodies.mobility[body] != Mobility::free && end != body;
    return is_wall_point ? Vec3(vec3(solver[end].velocity) - bodies.velocity[body]) : Vec3(Vec3::Zero());
  }
};
template <class Real>
struct TurnLatePoints {
  PointContacts<Real> contacts;
  ConstView<Slot> places;  ///< slots of this kind of contacts
  ConstView<BodyRecord<Real>> free, after;
  FlightStage flight;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    if ((contacts.flags[c] & flag_late_impact) == 0) return;
    const Slot& slot = places[contacts.slot[c]];
    const double half = 0.5 * flight.terms.step;
    const double delay = fmax(flight.clock[slot.i], flight.clock[slot.j]) - half;
    const auto turn = [&](std::int32_t body, std::int32_t end) {
      const double from = flight.is_free(body) ? fmax(flight.clock[body] - half, 0.0) : 0.0;
      return Vec3((half - from) * vec3(after[end].spin) - (delay - from) * vec3(free[end].spin));
    };
    const Vec3 turn_i = turn(slot.i, slot.end_i), turn_j = turn(slot.j, slot.end_j);
    const Vec3 n = vec3(contacts.fields.vector(C::normal, c));
    for (int k = 0; k < contacts.points[c]; ++k) {
      const auto at = point_at<Scalar<Real>>(contacts, c, k);
      contacts.gaps.at(C::at_point(k, C::predicted_gap), c) +=
          static_cast<Real>(n.dot(turn_j.cross(vec3(at.arm_j)) - turn_i.cross(vec3(at.arm_i))));
    }
  }
};

/// Finds the gap at the end of the substep of a contact whose normal at the midpoint does not tell it, since
/// its bodies fly past each other or were struck late. That of two balls is measured. If the contact carries
/// no load, it gets the normal at the end as well, along which the correction may push it. With other bodies,
/// a late contact's gap is completed from the positions at the end. Bodies that fly past each other
/// (passes()) do not overlap, whatever the normal at the midpoint says. The gap keeps the correction from
/// pushing one of them into the other.
template <class Real>
struct FindEndGapsOfBalls {
  BallContacts<Real> contacts;
  ConstView<Slot> places;
  ConstBodyView bodies;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    const std::uint8_t flags = contacts.flags[c];
    if (flags == 0) return;
    const Slot& slot = places[contacts.slot[c]];
    const Vec3 apart = bodies.period.nearest(bodies.position[slot.j] - bodies.position[slot.i]);
    const bool is_loaded = !is_zero(contacts.fields.vector(C::impulse, c));
    Real& predicted_gap = contacts.gaps.at(C::predicted_gap, c);
    if (bodies.shape[slot.i] == Shape::sphere && bodies.shape[slot.j] == Shape::sphere) {
      const double distance = apart.norm();
      predicted_gap = static_cast<Real>(distance - bodies.size[slot.i].x() - bodies.size[slot.j].x());
      if (!is_loaded && distance > 0) contacts.fields.set(C::normal, c, v3<Real>(apart / distance));
      return;
    }
    if ((flags & flag_late_impact) != 0)
      predicted_gap += static_cast<Real>(vec3(contacts.fields.vector(C::normal, c)).dot(apart));
    if (passes(flags, is_loaded)) predicted_gap = std::max(predicted_gap, Real{0});
  }
};

/// Does for a contact of several points what FindEndGapsOfBalls does for one with a wall.
template <class Real>
struct FindEndGapsOfPoints {
  PointContacts<Real> contacts;
  ConstView<Slot> places;  ///< slots of this kind of contacts
  ConstBodyView bodies;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    const std::uint8_t flags = contacts.flags[c];
    if (flags == 0) return;
    Real along{};
    if ((flags & flag_late_impact) != 0) {
      const Slot& slot = places[contacts.slot[c]];
      const Vec3 apart = bodies.period.nearest(bodies.position[slot.j] - bodies.position[slot.i]);
      along = static_cast<Real>(vec3(contacts.fields.vector(C::normal, c)).dot(apart));
    }
    bool is_loaded = false;
    for (int k = 0; k < contacts.points[c]; ++k)
      is_loaded = is_loaded || !is_zero(contacts.point_fields.vector(C::at_point(k, C::impulse), c));
    for (int k = 0; k < contacts.points[c]; ++k) {
      Real& predicted_gap = contacts.gaps.at(C::at_point(k, C::predicted_gap), c);
      predicted_gap += along;
      if (passes(flags, is_loaded)) predicted_gap = std::max(predicted_gap, Real{0});
    }
  }
};

/// Returns the total impulse that the contacts gave to a free body (N s).
template <class Real>
SCREE_HD inline Vec3 impulse_on(const BodyRecord<Real>& free, const BodyRecord<Real>& after,
                                double inverse_mass) {
  return vec3(after.velocity - free.velocity) / inverse_mass;
}

/// Sums moment_of_delay() over the two bodies of a contact found after the midpoint.
template <class Real>
struct LateMoments {
  FlightStage flight;
  ConstView<BodyRecord<Real>> free, after;

  SCREE_HD Vec3 of_end(std::int32_t body, const Vec3& impulse, double delay) const {
    if (!flight.is_free(body)) return Vec3::Zero();
    const Vec3 total = impulse_on(free[body], after[body], flight.bodies.inverse_mass[body]);
    return moment_of_delay(flight.bodies, body, total, delay, impulse);
  }
  SCREE_HD Ledger of(const Slot& slot, const Vec3& impulse) const {
    const double delay = fmax(flight.clock[slot.i], flight.clock[slot.j]) - 0.5 * flight.terms.step;
    Ledger ledger;
    ledger.angular_correction = of_end(slot.i, -impulse, delay) + of_end(slot.j, impulse, delay);
    return ledger;
  }
};
template <class Real>
struct LateBallMoments {
  LateMoments<Real> moments;
  BallContacts<Real> contacts;
  ConstView<Slot> places;
  SCREE_HD Ledger operator()(std::int64_t c) const {
    if ((contacts.flags[c] & flag_late_impact) == 0) return {};
    return moments.of(places[contacts.slot[c]], vec3(contacts.fields.vector(BallContacts<Real>::impulse, c)));
  }
};
template <class Real>
struct LatePointMoments {
  LateMoments<Real> moments;
  PointContacts<Real> contacts;
  ConstView<Slot> places;
  SCREE_HD Ledger operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    if ((contacts.flags[c] & flag_late_impact) == 0) return {};
    Vec3 impulse = Vec3::Zero();
    for (int k = 0; k < contacts.points[c]; ++k)
      impulse += vec3(contacts.point_fields.vector(C::at_point(k, C::impulse), c));
    return moments.of(places[contacts.slot[c]], impulse);
  }
};

/// Calls shift_after_late_impact() for a body.
template <class Real>
struct ShiftLate {
  FlightStage flight;
  ConstView<BodyRecord<Real>> free, after;
  SCREE_HD Ledger operator()(std::int64_t k) const {
    const auto body = static_cast<std::int32_t>(k);
    if (!flight.is_free(body)) return {};
    return shift_after_late_impact(flight, body, impulse_on(free[k], after[k], flight.bodies.inverse_mass[k]),
                                   vec3(free[k].spin));
  }
};

}  // namespace scree::solver
