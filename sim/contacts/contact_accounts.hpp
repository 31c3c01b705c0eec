// The energy that the contacts of a substep have moved, computed once their impulses are found: for the
// ledger, for the observation, and for the position correction that follows.
#pragma once

#include "core/space_atomic.hpp"
#include "core/space_record.hpp"
#include "core/tolerances.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/laws/impulse_energy.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/observe/observation.hpp"

#include <cmath>
#include <cstdint>

namespace scree::solver {

/// Sums over contacts, and the deepest overlap.
struct ContactTotals {
  double restitution = 0;  ///< energy dissipated by normal impulses (J)
  double friction = 0;
  double work = 0;            ///< work done by bodies that are not free (J)
  double gaps = 0;            ///< sum of |gap| of loaded points (m)
  std::int64_t loaded = 0;    ///< points that carry an impulse
  std::int64_t ends = 0;      ///< free bodies at loaded contacts
  std::int64_t gaining = 0;   ///< contacts that gain energy (Moved::gains); with none, no set of them gains
  double deepest = 0;         ///< deepest overlap at the end of the substep, relative to the cap
  double residual_power = 0;  ///< power of normal impulses on residual velocities: 0 at the solution (J)
  double impulse_power = 0;   ///< power of impulses on the relative velocities that they have changed (J)

  SCREE_HD friend ContactTotals operator+(const ContactTotals& a, const ContactTotals& b) {
    return {a.restitution + b.restitution,
            a.friction + b.friction,
            a.work + b.work,
            a.gaps + b.gaps,
            a.loaded + b.loaded,
            a.ends + b.ends,
            a.gaining + b.gaining,
            a.deepest > b.deepest ? a.deepest : b.deepest,
            a.residual_power + b.residual_power,
            a.impulse_power + b.impulse_power};
  }

  /// Returns the energy that all impulses have moved, as a parabola in their common scale.
  SCREE_HD Moved moved() const {
    const double square = 0.5 * impulse_power;
    return {-(restitution + friction) - square, square};
  }
};

/// A contact point: the impulse that acts there, and its lever arms on the two bodies.
struct AccountedPoint {
  Vec3 impulse;  ///< on j (N s)
  Vec3 normal;
  Vec3 arm_i, arm_j;
  double target;  ///< target of the normal velocity (m/s)
};

/// Velocities of j relative to i at a point: before the substep's forces, with these but without contacts,
/// and with both (m/s).
struct PointMotion {
  Vec3 before, free, after;
};

/// The two bodies of a contact as the solver has them: with the substep's forces, without contacts (`free`)
/// and with them (`after`).
template <class Real>
struct EndBodies {
  BodyRecord<Real> free_i, free_j, after_i, after_j;

  SCREE_HD bool is_free_i() const { return after_i.inverse_mass > 0; }
  SCREE_HD bool is_free_j() const { return after_j.inverse_mass > 0; }
  SCREE_HD std::int64_t free_ends() const {
    return static_cast<int>(is_free_i()) + static_cast<int>(is_free_j());
  }
};

/// The gain of energy that counts as rounding, relative to Moved::square. In float it is larger: rounding is
/// relative to the velocities, which may be thousands of times as large as their changes.
template <class Real>
inline constexpr double response_gain = tolerance::response_gain;
template <>
inline constexpr double response_gain<float> = tolerance::mixed_response_gain;

/// The data that the accounting of all contacts has in common.
template <class Real>
struct AccountStage {
  ConstView<Slot> places;
  ConstBodyView bodies;
  ConstView<BodyRecord<Real>> free;
  ConstView<BodyRecord<Real>> solver;
  ResponseParameters parameters;
  double step;
  View<std::uint32_t> loads;  ///< one byte for each candidate, with a bit for each part that bears load
  bool places_are_candidates = false;  ///< Slots::are_candidates()
  bool again = false;                  ///< whether the gaps at the end have been set already

  /// Returns the Manifold::part of a slot's surface. For a box in a tube, the eight surfaces of the corners
  /// are all parts of the one wall.
  SCREE_HD int part_of(const Slot& slot) const {
    const Shape a = bodies.shape[slot.i], b = bodies.shape[slot.j];
    const bool corners = (a == Shape::tube && b == Shape::box) || (a == Shape::box && b == Shape::tube);
    constexpr int box_corners = 8;
    if (!corners) return slot.surface;
    return slot.surface < box_corners ? 0 : slot.surface - box_corners + 1;
  }
  SCREE_HD void mark_loaded(std::int64_t candidate, int part) const {
    const auto byte = static_cast<std::uint32_t>(candidate % 4);
    set_bits(&loads[candidate / 4], 1u << (8 * byte + static_cast<std::uint32_t>(part)));
  }
  /// Marks the candidate of a slot of balls, without a look at the slot if that is not needed.
  SCREE_HD void mark_loaded_balls(std::int64_t place) const {
    if (places_are_candidates) {
      mark_loaded(place, 0);
    } else {
      mark_loaded(places[place].candidate, places[place].surface);
    }
  }

  SCREE_HD EndBodies<Real> ends_of(const Ends& ends) const {
    return {load_whole(free[ends.i]), load_whole(free[ends.j]), load_whole(solver[ends.i]),
            load_whole(solver[ends.j])};
  }

  /// Returns the change of the velocity of j relative to i by the substep's forces (m/s).
  SCREE_HD Vec3 kick_of(const Slot& slot, const EndBodies<Real>& at) const {
    return kick_of(slot.j, at.is_free_j()) - kick_of(slot.i, at.is_free_i());
  }

  /// `kick`: kick_of() of the contact.
  SCREE_HD PointMotion motion_of(const Vec3& arm_i, const Vec3& arm_j, const Slot& slot,
                                 const EndBodies<Real>& at, const Vec3& kick) const {
    const Vec3 with_forces = velocity_of(at.free_j, arm_j) - velocity_of(at.free_i, arm_i);
    Vec3 before = with_forces - kick;
    if (parameters.torque.size() > 0)
      before += turn_of(slot.i, at.free_i, arm_i) - turn_of(slot.j, at.free_j, arm_j);
    return {before, with_forces, velocity_of(at.after_j, arm_j) - velocity_of(at.after_i, arm_i)};
  }

  /// Adds what the impulse of a point has moved to the totals, as account() of impulse_energy.hpp does, with
  /// the lever arms of `at`.
  SCREE_HD void account(const AccountedPoint& at, const Slot& slot, const EndBodies<Real>& ends,
                        const Vec3& kick, ContactTotals& totals) const {
    const Vec3& p = at.impulse;
    const auto [before, free_u, after] = motion_of(at.arm_i, at.arm_j, slot, ends, kick);
    const double pn = p.dot(at.normal);
    const double through_mean = 0.5 * p.dot(before + after);
    const double normal_part = 0.5 * pn * at.normal.dot(before + after);
    const double changed = p.dot(after - free_u);
    totals.restitution -= normal_part;
    totals.friction -= through_mean - normal_part;
    if (!ends.is_free_i()) totals.work += p.dot(velocity_of(ends.after_i, at.arm_i));
    if (!ends.is_free_j()) totals.work -= p.dot(velocity_of(ends.after_j, at.arm_j));
    totals.residual_power += pn * (after.dot(at.normal) - at.target);
    totals.impulse_power += changed;
  }
  /// Sets `gaining` in the totals of one contact, all of whose points have been added.
  SCREE_HD static void judge_gain(ContactTotals& totals) {
    totals.gaining = totals.moved().gains(response_gain<Real>) ? 1 : 0;
  }

 private:
  SCREE_HD static Vec3 velocity_of(const BodyRecord<Real>& body, const Vec3& arm) {
    return vec3(body.velocity) + vec3(body.spin).cross(arm);
  }
  /// Returns what the substep's forces have added to the velocity of a body (m/s).
  SCREE_HD Vec3 kick_of(std::int32_t body, bool is_free) const {
    return is_free ? Vec3(step * parameters.acceleration_of(body)) : Vec3(Vec3::Zero());
  }
  /// Returns what the substep's torques have added to the velocity of a point of a body (m/s).
  SCREE_HD Vec3 turn_of(std::int32_t body, const BodyRecord<Real>& at, const Vec3& arm) const {
    return (vec3(at.spin) - bodies.spin[body]).cross(arm);
  }
};

/// Returns whether the bodies of a contact fly past each other: this was predicted, and none of its points
/// bears load (`loaded`). The gap of such a contact does not count, since a body that flies past is nearer to
/// the other's tangent plane than to the other itself.
SCREE_HD inline bool passes(std::uint8_t flags, bool loaded) { return (flags & flag_flying) != 0 && !loaded; }

/// Accounts for a contact of balls: returns its totals, sets its gap at the end, and stores its impulse in
/// the memory of its slot.
template <class Real>
struct AccountBalls {
  static constexpr int blocks_at_once = 2;

  AccountStage<Real> stage;
  BallContacts<Real> contacts;
  View<BallMemory<Real>> memory;

  SCREE_HD ContactTotals operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    const std::int64_t place = contacts.slot[c];
    const EndBodies<Real> ends = stage.ends_of(contacts.ends[c]);
    const auto& f = contacts.fields;
    const V3<Real> n = f.vector(C::normal, c);
    const V3<Real> impulse = f.vector(C::impulse, c);
    ContactTotals totals;
    memory[place] = {impulse};
    const bool loaded = memory[place].is_loaded();
    if (loaded) {
      const Slot& slot = stage.places[place];
      const Vec3 normal = vec3(n);
      const auto number = [&](int field) { return static_cast<double>(f.at(field, c)); };
      stage.account(
          {vec3(impulse), normal, number(C::arm_i) * normal, number(C::arm_j) * normal, number(C::target)},
          slot, ends, stage.kick_of(slot, ends), totals);
      totals.gaps = fabs(static_cast<double>(contacts.gaps.at(C::gap, c)));
      totals.loaded = 1;
      totals.ends = ends.free_ends();
      stage.judge_gain(totals);
      if (stage.loads.size() > 0) stage.mark_loaded_balls(place);
    }
    if ((contacts.flags[c] & flag_late_impact) != 0) return totals;
    Real& predicted_gap = contacts.gaps.at(C::predicted_gap, c);
    const V3<Real> u = ends.after_j.velocity - ends.after_i.velocity;
    if (!stage.again) predicted_gap += static_cast<Real>(0.5 * stage.step) * dot(n, u);
    if (!passes(contacts.flags[c], loaded))
      totals.deepest = fmax(0.0, static_cast<double>(-predicted_gap / contacts.gaps.at(C::cap, c)));
    return totals;
  }
};

/// Accounts for a contact of several points, as AccountBalls does for one of balls.
template <class Real>
struct AccountPoints {
  AccountStage<Real> stage;
  std::int64_t first_place;
  PointContacts<Real> contacts;
  View<PointMemory<Real>> memory;

  SCREE_HD ContactTotals operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    const std::int64_t place = contacts.slot[c];
    const Slot& slot = stage.places[first_place + place];
    const EndBodies<Real> ends = stage.ends_of(contacts.ends[c]);
    const Vec3 kick = stage.kick_of(slot, ends);
    const Vec3 n = vec3(contacts.fields.vector(C::normal, c));
    const double cap = static_cast<double>(contacts.fields.at(C::cap, c));
    const auto& f = contacts.point_fields;
    ContactTotals totals;
    bool any_loaded = false;
    for (int k = 0; k < contacts.points[c]; ++k)
      any_loaded = any_loaded || !is_zero(f.vector(C::at_point(k, C::impulse), c));
    const bool flies_past = passes(contacts.flags[c], any_loaded);
    for (int k = 0; k < contacts.points[c]; ++k) {
      const auto number = [&](auto field) { return static_cast<double>(f.at(C::at_point(k, field), c)); };
      const auto at = point_at<Scalar<Real>>(contacts, c, k);
      const V3<Real> impulse = f.vector(C::at_point(k, C::impulse), c);
      const bool loaded = !is_zero(impulse);
      memory[place].impulse[k] = impulse;
      if (loaded) {
        stage.account({vec3(impulse), n, vec3(at.arm_i), vec3(at.arm_j), number(C::target)}, slot, ends, kick,
                      totals);
        totals.gaps += fabs(static_cast<double>(contacts.gaps.at(C::at_point(k, C::gap), c)));
        ++totals.loaded;
      }
      if ((contacts.flags[c] & flag_late_impact) != 0) continue;
      Real& predicted_gap = contacts.gaps.at(C::at_point(k, C::predicted_gap), c);
      const V3<Real> u = velocity_at(at, ends.after_i, ends.after_j);
      if (!stage.again)
        predicted_gap += static_cast<Real>(0.5 * stage.step) * dot(contacts.fields.vector(C::normal, c), u);
      if (!flies_past) totals.deepest = fmax(totals.deepest, static_cast<double>(-predicted_gap) / cap);
    }
    if (totals.loaded == 0) return totals;
    totals.ends = ends.free_ends();
    stage.judge_gain(totals);
    if (stage.loads.size() > 0) stage.mark_loaded(slot.candidate, stage.part_of(slot));
    return totals;
  }
};

}  // namespace scree::solver
