// Corrections to contacts and bodies after impacts; they are needed only where a flight has had impacts.
#pragma once

#include "sim/contacts/contact_flight.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/observe/observation.hpp"
#include "sim/response/bodies.hpp"

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
    if (contacts.flags[c] != 0) return;
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
  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    if (contacts.flags[c] != 0) return;
    const Moving<Real> i = change(contacts.ends[c].i);
    const Moving<Real> j = change(contacts.ends[c].j);
    for (int k = 0; k < contacts.points[c]; ++k) {
      contacts.gaps.at(C::at_point(k, C::predicted_gap), c) +=
          static_cast<Real>(0.5 * step) * dot(contacts.fields.vector(C::normal, c),
                                              velocity_at(point_at<Scalar<Real>>(contacts, c, k), i, j));
    }
  }
  SCREE_HD Moving<Real> change(std::int32_t k) const {
    Moving<Real> body = after[k];
    body.velocity = body.velocity - before[k].velocity;
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
  std::int64_t first_part;
  ConstView<BodyRecord<Real>> before;
  View<BodyRecord<Real>> solver;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t part = k - first_part;
    solver[k] = before[k];
    if (k == first_part - 1 || part >= hub_of.size()) return;  // padding_body, or a point of a wall
    const std::int64_t body = part < 0 ? k : hubs[hub_of[part]].body;
    solver[k].velocity = v3<Real>(bodies.velocity[body]);
    solver[k].spin = v3<Real>(bodies.spin[body]);
  }
};

/// Finds the gap at the end of the substep of a contact whose normal at the midpoint does not tell it, since
/// its bodies fly past each other or were struck late. That of two balls is measured. If the contact carries
/// no load, it gets the normal at the end as well, along which the correction may push it. With other bodies,
/// a late contact's gap is completed from the positions at the end, and bodies that fly past each other have
/// none (passes()).
template <class Real>
struct FindEndGapsOfBalls {
  BallContacts<Real> contacts;
  ConstView<Slot> places;
  ConstView<BodyRecord<Real>> solver;
  FlightStage flight;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    if (contacts.flags[c] == 0) return;
    const BodyView& bodies = flight.bodies;
    const Slot& slot = places[contacts.slot[c]];
    const Vec3 apart = bodies.period.nearest(bodies.position[slot.j] - bodies.position[slot.i]);
    Real& predicted_gap = contacts.gaps.at(C::predicted_gap, c);
    if (bodies.shape[slot.i] == Shape::sphere && bodies.shape[slot.j] == Shape::sphere) {
      const double distance = apart.norm();
      predicted_gap = static_cast<Real>(distance - bodies.size[slot.i].x() - bodies.size[slot.j].x());
      const bool is_loaded = !is_zero(contacts.fields.vector(C::impulse, c));
      if (!is_loaded && distance > 0) contacts.fields.set(C::normal, c, v3<Real>(apart / distance));
    } else if ((contacts.flags[c] & flag_late_impact) != 0) {
      const double left = flight.terms.step - fmax(flight.clock[slot.i], flight.clock[slot.j]);
      const Vec3 turned = turning_of(slot.j, slot.end_j) - turning_of(slot.i, slot.end_i);
      const Vec3 normal = vec3(contacts.fields.vector(C::normal, c));
      predicted_gap += static_cast<Real>(normal.dot(apart + left * turned));
    }
  }

 private:
  /// Returns the velocity of a wall point relative to the centre of its wall.
  SCREE_HD Vec3 turning_of(std::int32_t body, std::int32_t end) const {
    const BodyView& bodies = flight.bodies;
    const bool is_wall_point = bodies.mobility[body] != Mobility::free && end != body;
    return is_wall_point ? Vec3(vec3(solver[end].velocity) - bodies.velocity[body]) : Vec3(Vec3::Zero());
  }
};

/// Completes the gaps of a contact of several points whose bodies were struck late.
template <class Real>
struct FindEndGapsOfPoints {
  PointContacts<Real> contacts;
  ConstView<Slot> places;  ///< slots of this kind of contacts
  FlightStage flight;
  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    if ((contacts.flags[c] & flag_late_impact) == 0) return;
    const BodyView& bodies = flight.bodies;
    const Slot& slot = places[contacts.slot[c]];
    const Vec3 n = vec3(contacts.fields.vector(C::normal, c));
    const Vec3 apart = bodies.period.nearest(bodies.position[slot.j] - bodies.position[slot.i]);
    const double left = flight.terms.step - fmax(flight.clock[slot.i], flight.clock[slot.j]);
    for (int k = 0; k < contacts.points[c]; ++k) {
      const auto at = point_at<Scalar<Real>>(contacts, c, k);
      const Vec3 turned =
          bodies.spin[slot.j].cross(vec3(at.arm_j)) - bodies.spin[slot.i].cross(vec3(at.arm_i));
      contacts.gaps.at(C::at_point(k, C::predicted_gap), c) +=
          static_cast<Real>(n.dot(apart + left * turned));
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
    return shift_after_late_impact(flight, body,
                                   impulse_on(free[k], after[k], flight.bodies.inverse_mass[k]));
  }
};

}  // namespace scree::solver
