// From slots to contacts: which of them have one at the midpoint, and what the sweeps need to know of it.
#pragma once

#include "core/space_atomic.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/far_apart.hpp"
#include "narrowphase/pair_contacts.hpp"
#include "narrowphase/sphere_box.hpp"
#include "narrowphase/sphere_plane.hpp"
#include "narrowphase/sphere_sphere.hpp"
#include "narrowphase/sphere_tube.hpp"
#include "narrowphase/tube.hpp"
#include "sim/dynamics/contact_flight.hpp"
#include "sim/dynamics/contact_row.hpp"
#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/rotation.hpp"
#include "sim/dynamics/state.hpp"
#include "sim/resident/layout.hpp"

#include <cmath>
#include <cstdint>

namespace scree::resident {

/// A slot and its bodies, read at once: memory is asked for less often than by field.
template <class Real>
struct SlotBodies {
  Slot slot;
  MidBody<Real> a, b;
  SCREE_HD double margin() const { return static_cast<double>(a.margin) + static_cast<double>(b.margin); }
  SCREE_HD double size() const { return fmin(a.size, b.size); }
};

/// What contacts are made from.
template <class Real>
struct FindStage {
  ConstView<Slot> places;
  ConstView<MidBody<Real>> mid;
  ConstBodyView bodies;                ///< at the midpoint, before the kick
  ConstView<BodyRecord<Real>> solver;  ///< kicked
  ConstView<PairLaw> laws;             ///< materials x materials
  std::int64_t materials;
  ResponseParameters parameters;
  double step;           ///< s
  double scale;          ///< of remembered impulses
  double noise;          ///< parting speeds that count as none (m/s)
  StruckFlights struck;  ///< the bodies after their impacts
  bool any_is_late;      ///< one was struck after the midpoint

  SCREE_HD SlotBodies<Real> load(const Slot& slot) const { return {slot, mid[slot.i], mid[slot.j]}; }
  SCREE_HD double friction_of(const SlotBodies<Real>& at) const {
    return parameters.friction ? laws[at.a.material * materials + at.b.material].friction : 0.0;
  }
  SCREE_HD BallMasses masses_of(const SlotBodies<Real>& at, double arm_i, double arm_j) const {
    const auto [mass_i, inertia_i] = inverses_of(at.a, at.slot.i, at.slot.end_i);
    const auto [mass_j, inertia_j] = inverses_of(at.b, at.slot.j, at.slot.end_j);
    return ball_masses(mass_i, inertia_i, arm_i * arm_i, mass_j, inertia_j, arm_j * arm_j);
  }
  SCREE_HD Vec3 kick_of(const MidBody<Real>& body, std::int32_t k) const {
    return body.is_free() ? Vec3(step * parameters.acceleration_of(k)) : Vec3(Vec3::Zero());
  }
  SCREE_HD Vec3 kicked_velocity(const MidBody<Real>& body, std::int32_t k) const {
    return vec3(body.velocity) + kick_of(body, k);
  }
  /// Of j relative to i, before the kick and with it.
  SCREE_HD static Vec3 relative_velocity(const SlotBodies<Real>& at) {
    return vec3(at.b.velocity) - vec3(at.a.velocity);
  }
  SCREE_HD Vec3 kicked_relative_velocity(const SlotBodies<Real>& at) const {
    return kicked_velocity(at.b, at.slot.j) - kicked_velocity(at.a, at.slot.i);
  }
  /// Whether a body that is not free is a point of a wall that turns, in the contact of a slot.
  SCREE_HD static bool is_wall_point(const MidBody<Real>& body, std::int32_t k, std::int32_t end) {
    return !body.is_free() && end != k;
  }
  /// Of a wall at a point, when a pair is seen (m/s). Rare: what is called takes no registers from the rest.
  [[gnu::noinline]] SCREE_HD V3<Real> wall_velocity(std::int32_t wall, const Vec3& point, double lead) const {
    const Vec3 centre = bodies.position[wall] + lead * bodies.velocity[wall];
    return v3<Real>(bodies.velocity[wall] + bodies.spin[wall].cross(point - centre));
  }
  /// Walls move as their points do.
  SCREE_HD void take_wall_points(SlotBodies<Real>& at) const {
    if (is_wall_point(at.a, at.slot.i, at.slot.end_i)) at.a.velocity = solver[at.slot.end_i].velocity;
    if (is_wall_point(at.b, at.slot.j, at.slot.end_j)) at.b.velocity = solver[at.slot.end_j].velocity;
  }
  /// After the midpoint, when a pair is to be seen (s); 0 for nearly all.
  SCREE_HD double lead_of(const Slot& slot) const { return any_is_late ? late_lead_of(slot.i, slot.j) : 0.0; }
  SCREE_HD Solid solid(std::int32_t body, double lead) const {
    if (lead > 0) return late_solid(body, lead);
    return {bodies.position[body], bodies.orientation[body], bodies.size[body]};
  }
  /// Where the centre is when a pair is seen.
  SCREE_HD Vec3 centre(const MidBody<Real>& body, std::int32_t k, double lead) const {
    return lead > 0 ? Vec3(body.position + lead * kicked_velocity(body, k)) : body.position;
  }
  SCREE_HD Vec3 remembered(const V3<Real>& impulse, const Vec3& normal, double friction) const {
    if (!parameters.warm_start) return Vec3::Zero();
    return project_on_cone(scale * vec3(impulse), normal, friction);
  }

  /// Normal velocity that a point may have at the end, so that the next midpoint does not overlap: the gap
  /// may close by then, and no more. Held, a contact that was parting before the kick would gain energy: it
  /// may close as fast.
  SCREE_HD double target_of(double gap, double shell, double bend, double parting, double lead) const {
    const double closing = gap > shell ? -(gap - shell) / (step - lead) : 0.0;
    return fmin(closing - 0.5 * step * bend, noise - parting);
  }
  /// Of what flies past: it is not held at all. `free` is the normal velocity without contacts, and rounding
  /// pushes nobody.
  SCREE_HD static double target_in_flight(double target, double free) {
    return fmin(target, free - tolerance::flight_margin * fabs(free));
  }

  /// What the gap at the end has beside what the velocities after the response open (m): it bends; and a
  /// late contact is told from where its centres will be then, so that where they are now goes off.
  SCREE_HD double opened_by_then(const SlotBodies<Real>& at, const Vec3& n, double bend, double lead) const {
    if (lead > 0) return -n.dot(centre(at.b, at.slot.j, lead) - centre(at.a, at.slot.i, lead));
    return 0.125 * step * step * bend;
  }

  /// Acceleration of the gap by the turning of the normal: of balls on one another, and of a ball along the
  /// wall of a tube (m/s^2).
  SCREE_HD double bend_of(const SlotBodies<Real>& at, const Vec3& n) const {
    const bool ball_a = at.a.shape == Shape::sphere;
    const bool ball_b = at.b.shape == Shape::sphere;
    if (!ball_a && !ball_b) return 0;
    const Vec3 w = kicked_relative_velocity(at);
    const Vec3 across = w - w.dot(n) * n;
    if (ball_a && ball_b) return across.squaredNorm() / (at.a.size + at.b.size);
    if ((ball_a ? at.b : at.a).shape != Shape::tube || at.slot.surface != tube_wall) return 0;
    return bend_along_tube(across, ball_a ? at.slot.j : at.slot.i, at.size());
  }

 private:
  struct Inverses {
    double mass, inertia;
  };
  SCREE_HD Inverses inverses_of(const MidBody<Real>& body, std::int32_t k, std::int32_t end) const {
    if (k == end) return {static_cast<double>(body.inverse_mass), static_cast<double>(body.inverse_inertia)};
    return {static_cast<double>(solver[end].inverse_mass), static_cast<double>(solver[end].inverse_inertia)};
  }
  // What is rare must not take registers from the rest.
  [[gnu::noinline]] SCREE_HD double late_lead_of(std::int32_t i, std::int32_t j) const {
    return fmax(0.0, struck.time_of(i, j) - 0.5 * step);
  }
  [[gnu::noinline]] SCREE_HD Solid late_solid(std::int32_t body, double lead) const {
    return struck.at(body, 0.5 * step + lead).solid;
  }
  [[gnu::noinline]] SCREE_HD double bend_along_tube(const Vec3& across, std::int32_t tube,
                                                    double size) const {
    const Vec3 axis = bodies.orientation[tube] * Vec3::UnitZ();
    const double reach = bodies.size[tube].x() - size;
    return reach > 0 ? -(across - across.dot(axis) * axis).squaredNorm() / reach : 0.0;
  }
};

/// Which of a pair's manifolds is that of a surface of a slot, among those that its test has found.
SCREE_HD inline const Manifold* manifold_on(int surface, bool corners, const Manifold* found, int count) {
  constexpr int box_corners = 8;
  for (int m = 0; m < count; ++m) {
    int of = found[m].part;
    if (corners) {
      if (of == tube_wall) {
        // The vertex of the box, a side of each axis.
        const std::uint32_t vertex = found[m].points[0].feature;
        of = static_cast<int>((vertex >> 1 & 1) | (vertex >> 3 & 1) << 1 | (vertex >> 5 & 1) << 2);
      } else {
        of += box_corners - 1;
      }
    }
    if (of == surface) return &found[m];
  }
  return nullptr;
}

/// The contact of a slot of balls, at its time. With `rare`, of any; without, of balls and planes at the
/// midpoint.
template <bool rare, class Real>
SCREE_HD inline bool meet(const FindStage<Real>& stage, const SlotBodies<Real>& at, double lead,
                          Manifold& out) {
  const bool ball_a = at.a.shape == Shape::sphere;
  const bool ball_b = at.b.shape == Shape::sphere;
  const auto ball = [&](const MidBody<Real>& body, std::int32_t k) {
    return Solid{stage.centre(body, k, lead), Quat::Identity(), Vec3(body.size, 0, 0)};
  };
  out.part = 0;
  if (ball_a && ball_b) return sphere_sphere(ball(at.a, at.slot.i), ball(at.b, at.slot.j), at.margin(), out);
  const Solid of_ball = ball_a ? ball(at.a, at.slot.i) : ball(at.b, at.slot.j);
  const Solid other = stage.solid(ball_a ? at.slot.j : at.slot.i, lead);
  const Shape shape = ball_a ? at.b.shape : at.a.shape;
  bool found = false;
  if (shape == Shape::plane) {
    found = sphere_plane(of_ball, other, at.margin(), out);
  } else if constexpr (rare) {
    if (shape == Shape::box) {
      found = sphere_box(of_ball, other, at.margin(), out);
    } else {
      Manifold all[3];
      const Manifold* on =
          manifold_on(at.slot.surface, false, all, sphere_tube(of_ball, other, at.margin(), all));
      found = on != nullptr;
      if (found) out = *on;
    }
  }
  if (found && !ball_a) out.normal = -out.normal;
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

/// What is rare must take no registers from the rest, and so it is called.
template <class Real>
[[gnu::noinline]] SCREE_HD bool meet_rarely(const FindStage<Real>& stage, const Slot& slot, double lead,
                                            Touch& out) {
  Manifold m;
  const bool found = meet<true>(stage, stage.load(slot), lead, m);
  if (found) out = touch_of(m);
  return found;
}

template <class Real>
SCREE_HD inline bool meet_balls(const FindStage<Real>& stage, std::int64_t place, const SlotBodies<Real>& at,
                                double lead, Touch& out) {
  const auto is_common = [](Shape shape) { return shape == Shape::sphere || shape == Shape::plane; };
  if (lead > 0 || !is_common(at.a.shape) || !is_common(at.b.shape)) {
    Touch rare;  // in memory, as what is called asks for
    const bool found = meet_rarely(stage, stage.places[place], lead, rare);
    if (found) out = rare;
    return found;
  }
  Manifold m;
  const bool found = meet<false>(stage, at, 0, m);
  if (found) out = touch_of(m);
  return found;
}

/// Places of contacts that may fly past, in any order.
struct PassingList {
  View<std::int32_t> places;
  std::uint64_t* count;
  SCREE_HD void add(std::int64_t place) const {
    places[static_cast<std::int64_t>(count_up(count))] = static_cast<std::int32_t>(place);
  }
};

/// Contacts of balls, all as if they met. Those that may fly past are listed.
template <class Real>
struct FindBalls {
  struct Record {
    Vec3 normal;
    double gap;
    double arm_i, arm_j;  ///< along the normal
    double lead;
  };

  static constexpr int blocks_at_once = 2;  // spilled registers cost more than threads that wait

  FindStage<Real> stage;
  BallContacts<Real> contacts;
  View<BallMemory<Real>> memory;
  View<BodyRecord<Real>> solver;  ///< gets the points of walls
  PassingList passing;

  SCREE_HD bool find(std::int64_t place, Record& record) const {
    const Slot slot = stage.places[place];
    if (slot.i == Slot::empty) return false;
    const SlotBodies<Real> at = stage.load(slot);
    record.lead = stage.lead_of(slot);
    Touch m;
    if (!meet_balls(stage, place, at, record.lead, m)) {
      memory[place] = {};
      return false;
    }
    record.normal = m.normal;
    record.gap = m.gap;
    const auto arm = [&](const MidBody<Real>& body, std::int32_t k) {
      return body.is_free() ? m.normal.dot(m.position - stage.centre(body, k, record.lead)) : 0.0;
    };
    record.arm_i = arm(at.a, slot.i);
    record.arm_j = arm(at.b, slot.j);
    return true;
  }

  SCREE_HD void store(std::int64_t to, std::int64_t place, const Record& record) const {
    using C = BallContacts<Real>;
    const Slot slot = stage.places[place];
    SlotBodies<Real> at = stage.load(slot);
    const BallMemory<Real> remembered = memory[place];
    const Vec3& n = record.normal;
    const double friction = stage.friction_of(at);
    const double bend = stage.bend_of(at, n);
    const double opened = stage.opened_by_then(at, n, bend, record.lead);
    set_wall_points(at, record);
    const double parting = n.dot(stage.relative_velocity(at));
    // A look at the normal velocity tells of nearly all that they are not held apart (flight_of_contact).
    const double closing = -n.dot(stage.kicked_relative_velocity(at));
    const bool may_pass = record.gap > 0 && !remembered.is_loaded() &&
                          (record.lead > 0 || closing * stage.step > tolerance::likely_closing * record.gap);
    const BallMasses masses = stage.masses_of(at, record.arm_i, record.arm_j);
    contacts.ends[to] = {slot.end_i, slot.end_j};
    contacts.slot[to] = static_cast<std::uint8_t>(place % 256);
    contacts.flags[to] = static_cast<std::uint8_t>(record.lead > 0 ? flag_late : 0);
    if (may_pass) passing.add(to);
    const Fields<Real>& f = contacts.fields;
    const auto put = [&](int field, double value) { f.at(field, to) = static_cast<Real>(value); };
    const V3<Real> impulse = v3<Real>(stage.remembered(remembered.impulse, n, friction));
    f.set(C::normal, to, v3<Real>(n));
    put(C::arm_i, record.arm_i);
    put(C::arm_j, record.arm_j);
    put(C::friction, friction);
    put(C::target, stage.target_of(record.gap, 0.0, bend, parting, record.lead));
    put(C::normal_mass, masses.normal);
    put(C::tangent_mass, masses.tangent);
    f.set(C::impulse, to, impulse);
    f.set(C::last, to, impulse);
    put(C::gap, record.gap);
    put(C::flown, record.gap + opened);
    put(C::pushed, 0);
    put(C::cap, tolerance::correction_cap * at.size());
  }

 private:
  /// The ball has the contact on its normal.
  SCREE_HD void set_wall_points(SlotBodies<Real>& at, const Record& record) const {
    const Slot& slot = at.slot;
    if (stage.is_wall_point(at.a, slot.i, slot.end_i)) {
      const Vec3 point = stage.centre(at.b, slot.j, record.lead) + record.arm_j * record.normal;
      solver[slot.end_i].velocity = stage.wall_velocity(slot.i, point, record.lead);
    } else if (stage.is_wall_point(at.b, slot.j, slot.end_j)) {
      const Vec3 point = stage.centre(at.a, slot.i, record.lead) + record.arm_i * record.normal;
      solver[slot.end_j].velocity = stage.wall_velocity(slot.j, point, record.lead);
    } else {
      return;
    }
    stage.take_wall_points(at);
  }
};

/// Decides on them: work of another kind than that on the many which touch, and so it is done apart.
template <class Real>
struct JudgePassing {
  static constexpr std::int64_t threads = 1 << 15;  ///< of which each takes one in so many

  FindStage<Real> stage;
  BallContacts<Real> contacts;
  PassingList passing;

  SCREE_HD void operator()(std::int64_t thread) const {
    const auto count = static_cast<std::int64_t>(*passing.count);
    for (std::int64_t k = thread; k < count; k += threads) judge(passing.places[k]);
  }

 private:
  SCREE_HD void judge(std::int64_t c) const {
    using C = BallContacts<Real>;
    SlotBodies<Real> at = stage.load(stage.places[c - c % 256 + contacts.slot[c]]);
    Manifold m;
    if (!meet<true>(stage, at, stage.lead_of(at.slot), m)) return;
    m.i = at.slot.i;
    m.j = at.slot.j;
    if (!flight_of_contact(stage.struck, m, m.points, at.size(), false).flying) return;
    contacts.flags[c] |= flag_flying;
    stage.take_wall_points(at);
    const double free = m.normal.dot(stage.kicked_relative_velocity(at));
    Real& target = contacts.fields.at(C::target, c);
    target = static_cast<Real>(stage.target_in_flight(static_cast<double>(target), free));
  }
};

/// The others.
template <class Real>
struct FindPoints {
  struct Record {
    Manifold manifold;
    ContactFlight flight;
  };

  FindStage<Real> stage;
  std::int64_t first_place;  ///< of the slots that are not of balls
  PointContacts<Real> contacts;
  View<PointMemory<Real>> memory;
  ConstView<LoadedParts> loads;  ///< of candidates

  SCREE_HD bool find(std::int64_t k, Record& record) const {
    const Slot slot = stage.places[first_place + k];
    if (slot.i == Slot::empty) return false;
    const SlotBodies<Real> at = stage.load(slot);
    const Shape a = at.a.shape, b = at.b.shape;
    const double lead = stage.lead_of(slot);
    bool found = false;
    if (lead > 0 || !are_far(at)) {
      Manifold all[max_pair_manifolds];
      const int count =
          find_pair_contacts(a, stage.solid(slot.i, lead), b, stage.solid(slot.j, lead), at.margin(), all);
      const bool tube = a == Shape::tube || b == Shape::tube;
      const bool corners = tube && (a == Shape::box || b == Shape::box);
      const Manifold* on = manifold_on(slot.surface, corners, all, count);
      found = on != nullptr;
      if (found) record.manifold = *on;
    }
    if (!found) {
      memory[k].count = 0;
      return false;
    }
    Manifold& m = record.manifold;
    m.i = slot.i;
    m.j = slot.j;
    const bool loaded = loads[slot.candidate].is_loaded(m.part);
    record.flight = flight_of_contact(stage.struck, m, m.points, at.size(), loaded);
    return true;
  }

  SCREE_HD void store(std::int64_t to, std::int64_t k, const Record& record) const {
    using C = PointContacts<Real>;
    const Manifold& m = record.manifold;
    const double lead = record.flight.lead;
    const Slot slot = stage.places[first_place + k];
    const SlotBodies<Real> pair = stage.load(slot);
    const double friction = stage.friction_of(pair);
    const double shell = m.count == 1 ? 0.0 : tolerance::closed_gap * pair.size();
    const SolverBody i = solver_body(pair.a, slot.i, slot.end_i);
    const SolverBody j = solver_body(pair.b, slot.j, slot.end_j);
    const Vec3 kick = stage.kick_of(pair.b, slot.j) - stage.kick_of(pair.a, slot.i);
    PointMemory<Real> old = memory[k];
    PointMemory<Real>& now = memory[k];
    contacts.ends[to] = {slot.end_i, slot.end_j};
    contacts.slot[to] = static_cast<std::uint8_t>(k % 256);
    contacts.flags[to] = static_cast<std::uint8_t>((record.flight.flying ? flag_flying : 0) |
                                                   (record.flight.lead > 0 ? flag_late : 0));
    contacts.points[to] = m.count;
    contacts.fields.set(C::normal, to, v3<Real>(m.normal));
    contacts.fields.at(C::friction, to) = static_cast<Real>(friction);
    contacts.fields.at(C::cap, to) = static_cast<Real>(tolerance::correction_cap * pair.size());
    now.count = m.count;
    const double bend = stage.bend_of(pair, m.normal);
    for (int p = 0; p < m.count; ++p) {
      const ContactPoint& point = m.points[p];
      RowCoupling coupling;
      const ContactRow row =
          make_row(m.normal, point.position - stage.bodies.position[slot.i],
                   point.position - stage.bodies.position[slot.j], point.gap, i, j, coupling);
      now.feature[p] = point.feature;
      V3<Real> last{};
      for (int q = 0; q < old.count; ++q)
        if (old.feature[q] == point.feature) last = old.impulse[q];
      const V3<Real> impulse = v3<Real>(stage.remembered(last, m.normal, friction));
      const double parting = m.normal.dot(row.relative_velocity(i, j));
      const double free = parting + m.normal.dot(kick);
      const auto at = [p](int field) { return C::at_point(p, field); };
      const Fields<Real>& f = contacts.point_fields;
      const auto put = [&](int field, double value) { f.at(at(field), to) = static_cast<Real>(value); };
      f.set(at(C::arm_i), to, v3<Real>(row.arm_i));
      f.set(at(C::arm_j), to, v3<Real>(row.arm_j));
      const Mat3& w = coupling.stick;
      const double stick[] = {w(0, 0), w(1, 1), w(2, 2), w(0, 1), w(0, 2), w(1, 2)};
      for (int e = 0; e < 6; ++e) put(C::stick + e, stick[e]);
      f.set(at(C::coupling), to, v3<Real>(coupling.normal));
      const double target = stage.target_of(point.gap, shell, bend, parting, lead);
      put(C::target, record.flight.flying ? stage.target_in_flight(target, free) : target);
      put(C::normal_mass, row.normal_mass);
      put(C::tangent_mass, row.tangent_mass);
      f.set(at(C::impulse), to, impulse);
      f.set(at(C::last), to, impulse);
      put(C::gap, point.gap);
      put(C::flown, point.gap + stage.opened_by_then(pair, m.normal, bend, lead));
      put(C::pushed, 0);
    }
  }

 private:
  /// Before the kick.
  SCREE_HD SolverBody solver_body(const MidBody<Real>& body, std::int32_t k, std::int32_t end) const {
    const ConstBodyView& bodies = stage.bodies;
    const double parts = k == end || !body.is_free()
                             ? 1.0
                             : static_cast<double>(stage.solver[end].inverse_mass) / bodies.inverse_mass[k];
    return {bodies.velocity[k], bodies.spin[k], parts * bodies.inverse_mass[k],
            parts * world_inverse_inertia(bodies.orientation[k], bodies.inverse_inertia[k])};
  }
  /// True if the spheres around two bodies are too far apart for a contact.
  SCREE_HD bool are_far(const SlotBodies<Real>& at) const {
    if (is_boundary(at.a.shape) || is_boundary(at.b.shape)) return false;
    const double reach = bounding_radius(at.a.shape, stage.bodies.size[at.slot.i]) +
                         bounding_radius(at.b.shape, stage.bodies.size[at.slot.j]) + at.margin();
    return are_far_apart(at.a.position, at.b.position, reach);
  }
};

}  // namespace scree::resident
