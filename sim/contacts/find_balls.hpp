// The search for contacts of balls: finds which of their slots have a contact, and computes what the sweeps
// need to know of it.
#pragma once

#include "narrowphase/any_contacts.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"
#include "sim/contacts/find_stage.hpp"
#include "sim/contacts/solver_bodies.hpp"

namespace scree::solver {

/// Finds the contact of a slot of balls, `delay` after the midpoint (s). With `rare` it handles all slots of
/// balls; without, only those of balls and planes at the midpoint.
template <bool rare, class Real>
SCREE_HD inline bool meet(const FindStage<Real>& stage, const SlotBodies<Real>& at, double delay,
                          Manifold& out) {
  const bool ball_a = at.a.shape == Shape::sphere;
  const bool ball_b = at.b.shape == Shape::sphere;
  const auto ball = [&](const MidBody<Real>& body, std::int32_t k) {
    return Solid{stage.centre(body, k, delay), Quat::Identity(), Vec3(body.size, 0, 0)};
  };
  out.part = 0;
  const Period& period = stage.bodies.period;
  if (ball_a && ball_b) {
    const Solid a = ball(at.a, at.slot.i);
    Solid b = ball(at.b, at.slot.j);
    period.bring_near(a.position, b.position);
    return sphere_sphere(a, b, at.margin(), out);
  }
  const Solid of_ball = ball_a ? ball(at.a, at.slot.i) : ball(at.b, at.slot.j);
  Solid other = stage.solid(ball_a ? at.slot.j : at.slot.i, delay);
  period.bring_near(of_ball.position, other.position);
  const Shape shape = ball_a ? at.b.shape : at.a.shape;
  bool found = false;
  if (shape == Shape::plane) {
    found = sphere_plane(of_ball, other, at.margin(), out);
  } else if constexpr (rare) {
    constexpr int most_manifolds = 3;  // largest number for a ball and a tube
    Manifold all[most_manifolds];
    const PairShapes shapes = stage.shapes_of(ball_a ? at.slot.i : at.slot.j, ball_a ? at.slot.j : at.slot.i);
    const int count =
        find_any_contacts({Shape::sphere, of_ball}, {shape, other}, shapes, {.margin = at.margin()}, all);
    const Manifold* on = manifold_on(at.slot.surface, false, all, count);
    found = on != nullptr;
    if (found) out = *on;
  }
  if (found && !ball_a) out.normal = -out.normal;
  if constexpr (rare) {
    if (found && out.at_edge)
      take_normal_of_face(stage.struck, at.slot.i, at.slot.j, 1, out.points, out.normal);
  }
  return found;
}

/// A contact of one point.
struct Touch {
  Vec3 normal;
  Vec3 position;
  double gap;
};

SCREE_HD inline Touch touch_of(const Manifold& m) {
  return {m.normal, m.points[0].position, m.points[0].gap};
}

/// Does the same as meet() for all slots of balls. This function is needed rarely and is not inlined, so that
/// it takes no registers from the common code.
template <class Real>
[[gnu::noinline]] SCREE_HD bool meet_rarely(const FindStage<Real>& stage, const Slot& slot, double delay,
                                            Touch& out) {
  Manifold m;
  const bool found = meet<true>(stage, stage.load(slot), delay, m);
  if (found) out = touch_of(m);
  return found;
}

template <bool rare, class Real>
SCREE_HD inline bool meet_balls(const FindStage<Real>& stage, std::int64_t place, const SlotBodies<Real>& at,
                                double delay, Touch& out) {
  if constexpr (rare) {
    if (delay > 0 || !is_ball_or_plane(at.a.shape) || !is_ball_or_plane(at.b.shape)) {
      Touch touch;  // in memory, since the called function takes its address
      const bool found = meet_rarely(stage, stage.places[place], delay, touch);
      if (found) out = touch;
      return found;
    }
  }
  Manifold m;
  const bool found = meet<false>(stage, at, 0, m);
  if (found) out = touch_of(m);
  return found;
}

/// Finds and makes contacts of balls as if all their bodies met and stayed together. Contacts whose bodies
/// may fly past each other or bounce are added to `approaching`. Without `rare`, no slot may be rare
/// (Slots::has_rare_balls()) and no body struck after the midpoint: this takes fewer registers.
template <class Real, bool rare = true>
struct FindBalls {
  struct Record {
    Vec3 normal;
    double gap;
    double arm_i, arm_j;  ///< lever arms along the normal (m)
    double delay;
  };

  // More would spill registers, which is worse than waiting threads.
  static constexpr int blocks_at_once = rare ? 2 : 3;
  static constexpr int kinds = 0;  // the work on all slots is alike

  FindStage<Real> stage;
  BallContacts<Real> contacts;
  View<BallMemory<Real>> memory;
  View<BodyRecord<Real>> solver;  ///< receives the velocities of points of walls
  ApproachList approaching;

  bool is_end(std::int64_t place) const { return stage.places[place].i == Slot::empty; }
  SCREE_HD bool find(std::int64_t place, Record& record) const {
    const Slot slot = stage.places[place];
    if (slot.i == Slot::empty) return false;
    const SlotBodies<Real> at = stage.load(slot);
    record.delay = rare ? stage.delay_of(slot) : 0.0;
    Touch m;
    if (!meet_balls<rare>(stage, place, at, record.delay, m)) {
      memory[place] = {};
      return false;
    }
    record.normal = m.normal;
    record.gap = m.gap;
    const auto arm = [&](const MidBody<Real>& body, std::int32_t k) {
      if (!body.is_free()) return 0.0;
      return m.normal.dot(stage.bodies.period.nearest(m.position - stage.centre(body, k, record.delay)));
    };
    record.arm_i = arm(at.a, slot.i);
    record.arm_j = arm(at.b, slot.j);
    return true;
  }

  /// Keeps nothing: make() reads the same bodies and finds the contact again.
  SCREE_HD void keep(std::int64_t, const Record&) const {}
  /// Makes contact `to` from a slot that has a contact.
  SCREE_HD void make(std::int64_t to, std::int64_t place) const {
    using C = BallContacts<Real>;
    Record record;
    find(place, record);
    const Slot slot = stage.places[place];
    SlotBodies<Real> at = stage.load(slot);
    const BallMemory<Real> remembered = memory[place];
    const Vec3& n = record.normal;
    const double friction = stage.friction_of(at);
    const double curvature = stage.curvature_of(at, n);
    const double opened = stage.opened_by_then(at, n, curvature, record.delay);
    if constexpr (rare) set_wall_points(at, record);
    const double separating = n.dot(stage.relative_velocity(at));
    const double closing = -n.dot(stage.kicked_relative_velocity(at));
    const bool approaches =
        !remembered.is_loaded() && stage.may_be_held_apart(record.gap, closing, record.delay);
    const BallMasses masses = stage.masses_of(at, record.arm_i, record.arm_j);
    contacts.ends[to] = {slot.end_i, slot.end_j};
    contacts.flags[to] = static_cast<std::uint8_t>(record.delay > 0 ? flag_late_impact : 0);
    if (approaches) approaching.add(to);
    const auto& f = contacts.fields;
    const auto put = [&](int field, double value) { f.at(field, to) = static_cast<Real>(value); };
    const V3<Real> impulse = v3<Real>(stage.remembered(remembered.impulse, n, friction));
    f.set(C::normal, to, v3<Real>(n));
    put(C::arm_i, record.arm_i);
    put(C::arm_j, record.arm_j);
    put(C::friction, friction);
    put(C::target, stage.target_of(record.gap, 0.0, curvature, separating, record.delay));
    put(C::normal_mass, masses.normal);
    put(C::tangent_mass, masses.tangent);
    f.set(C::impulse, to, impulse);
    f.set(C::last, to, impulse);
    const auto put_gap = [&](int field, double value) {
      contacts.gaps.at(field, to) = static_cast<Real>(value);
    };
    put_gap(C::gap, record.gap);
    put_gap(C::predicted_gap, record.gap + opened);
    put_gap(C::pushed, 0);
    put_gap(C::pushed_before, 0);
    put_gap(C::cap, tolerance::correction_cap * at.size());
  }

 private:
  /// Sets the velocity of the point of a wall in this contact, if there is one. The contact point lies on the
  /// normal through the ball's centre.
  SCREE_HD void set_wall_points(SlotBodies<Real>& at, const Record& record) const {
    const Slot& slot = at.slot;
    if (stage.is_wall_point(at.a, slot.i, slot.end_i)) {
      const Vec3 point = stage.centre(at.b, slot.j, record.delay) + record.arm_j * record.normal;
      solver[slot.end_i].velocity = stage.wall_velocity(slot.i, point, record.delay);
    } else if (stage.is_wall_point(at.b, slot.j, slot.end_j)) {
      const Vec3 point = stage.centre(at.a, slot.i, record.delay) + record.arm_i * record.normal;
      solver[slot.end_j].velocity = stage.wall_velocity(slot.j, point, record.delay);
    } else {
      return;
    }
    stage.take_wall_points(at);
  }
};

/// Decides for a contact of balls that approach whether they fly past each other or bounce, and sets its
/// target.
template <class Real>
struct JudgeBalls {
  FindStage<Real> stage;
  BallContacts<Real> contacts;

  SCREE_HD void operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    SlotBodies<Real> at = stage.load(stage.places[contacts.slot[c]]);
    const double delay = stage.delay_of(at.slot);
    Manifold m;
    if (!meet<true>(stage, at, delay, m)) return;
    m.i = at.slot.i;
    m.j = at.slot.j;
    Real& target = contacts.fields.at(C::target, c);
    if (!flight_of_contact(stage.struck, m, m.points, at.size(), false).flying) {
      if (!stage.struck.stage.both_bore_load(m.i, m.j)) return;
      target = static_cast<Real>(stage.target_of_bounce(
          at.slot, static_cast<double>(target), m.points[0].gap, m.normal.dot(stage.relative_velocity(at)),
          m.normal.dot(stage.kicked_relative_velocity(at)), delay));
      return;
    }
    contacts.flags[c] |= flag_flying;
    stage.take_wall_points(at);
    const Vec3 velocity_i = stage.kicked_velocity(at.a, at.slot.i);
    const Vec3 velocity_j = stage.kicked_velocity(at.b, at.slot.j);
    const double free = m.normal.dot(velocity_j - velocity_i);
    target = static_cast<Real>(
        stage.target_in_flight(static_cast<double>(target), free, velocity_i.norm() + velocity_j.norm()));
  }
};

}  // namespace scree::solver
