// From slots to contacts: which of them have one at the midpoint, and what the sweeps need to know of it.
#pragma once

#include "core/tolerances.hpp"
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

  SCREE_HD double friction_of(const Slot& slot) const {
    if (!parameters.friction) return 0;
    return laws[mid[slot.i].material * materials + mid[slot.j].material].friction;
  }
  SCREE_HD Real inverse_mass(std::int32_t body, std::int32_t end) const {
    return body == end ? mid[body].inverse_mass : solver[end].inverse_mass;
  }
  SCREE_HD Real inverse_inertia(std::int32_t body, std::int32_t end) const {
    return body == end ? mid[body].inverse_inertia : solver[end].inverse_inertia;
  }
  SCREE_HD Vec3 kick_of(std::int32_t body) const {
    return mid[body].is_free() ? Vec3(step * parameters.acceleration_of(body)) : Vec3(Vec3::Zero());
  }
  SCREE_HD Vec3 kicked_velocity(std::int32_t body) const { return vec3(mid[body].velocity) + kick_of(body); }
  /// After the midpoint, when a pair is to be seen (s); 0 for nearly all.
  SCREE_HD double lead_of(const Slot& slot) const {
    return any_is_late ? fmax(0.0, struck.time_of(slot.i, slot.j) - 0.5 * step) : 0.0;
  }
  SCREE_HD Solid solid(std::int32_t body, double lead) const {
    if (lead > 0) return struck.at(body, 0.5 * step + lead).solid;
    return {bodies.position[body], bodies.orientation[body], bodies.size[body]};
  }
  /// Where the centre is when a pair is seen.
  SCREE_HD Vec3 centre(std::int32_t body, double lead) const {
    const Vec3& position = mid[body].position;
    return lead > 0 ? Vec3(position + lead * kicked_velocity(body)) : position;
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
  SCREE_HD double opened_by_then(const Slot& slot, const Vec3& n, double bend, double lead) const {
    if (lead > 0) return -n.dot(centre(slot.j, lead) - centre(slot.i, lead));
    return 0.125 * step * step * bend;
  }

  /// Acceleration of the gap by the turning of the normal: of balls on one another, and of a ball along the
  /// wall of a tube (m/s^2).
  SCREE_HD double bend_of(const Slot& slot, const Vec3& n) const {
    const MidBody<Real>& a = mid[slot.i];
    const MidBody<Real>& b = mid[slot.j];
    const bool ball_a = a.shape == Shape::sphere;
    const bool ball_b = b.shape == Shape::sphere;
    if (!ball_a && !ball_b) return 0;
    const bool both = ball_a && ball_b;
    const std::int32_t other = ball_a ? slot.j : slot.i;
    if (!both && (mid[other].shape != Shape::tube || slot.surface != tube_wall)) return 0;
    const Vec3 w = kicked_velocity(slot.j) - kicked_velocity(slot.i);
    Vec3 across = w - w.dot(n) * n;
    if (both) return across.squaredNorm() / (a.size + b.size);
    const Vec3 axis = bodies.orientation[other] * Vec3::UnitZ();
    across -= across.dot(axis) * axis;
    const double reach = bodies.size[other].x() - (ball_a ? a.size : b.size);
    return reach > 0 ? -across.squaredNorm() / reach : 0.0;
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

/// The contact of a slot of balls, at its time.
template <class Real>
SCREE_HD inline bool meet_balls(const FindStage<Real>& stage, const Slot& slot, double lead, Manifold& out) {
  const MidBody<Real>& a = stage.mid[slot.i];
  const MidBody<Real>& b = stage.mid[slot.j];
  const double margin = static_cast<double>(a.margin) + static_cast<double>(b.margin);
  const bool ball_a = a.shape == Shape::sphere;
  const auto ball = [&](std::int32_t body, double radius) {
    return Solid{stage.centre(body, lead), Quat::Identity(), Vec3(radius, 0, 0)};
  };
  out.part = 0;
  if (ball_a && b.shape == Shape::sphere)
    return sphere_sphere(ball(slot.i, a.size), ball(slot.j, b.size), margin, out);
  const std::int32_t wall = ball_a ? slot.j : slot.i;
  const Solid of_ball = ball_a ? ball(slot.i, a.size) : ball(slot.j, b.size);
  bool found = false;
  if (stage.mid[wall].shape == Shape::plane) {
    found = sphere_plane(of_ball, stage.solid(wall, lead), margin, out);
  } else if (stage.mid[wall].shape == Shape::box) {
    found = sphere_box(of_ball, stage.solid(wall, lead), margin, out);
  } else {
    Manifold all[3];
    const int count = sphere_tube(of_ball, stage.solid(wall, lead), margin, all);
    const Manifold* on = manifold_on(slot.surface, false, all, count);
    found = on != nullptr;
    if (found) out = *on;
  }
  if (found && !ball_a) out.normal = -out.normal;
  return found;
}

/// Contacts of balls, all as if they met. Those that may fly past are marked.
template <class Real>
struct FindBalls {
  struct Record {
    Vec3 normal;
    double gap;
    double arm_i, arm_j;  ///< along the normal
    double lead;
  };

  static constexpr int blocks_at_once = 3;

  FindStage<Real> stage;
  BallContacts<Real> contacts;
  View<BallMemory<Real>> memory;

  SCREE_HD bool find(std::int64_t place, Record& record) const {
    const Slot& slot = stage.places[place];
    if (slot.i == Slot::empty) return false;
    record.lead = stage.lead_of(slot);
    Manifold m;
    if (!meet_balls(stage, slot, record.lead, m)) {
      memory[place] = {};
      return false;
    }
    record.normal = m.normal;
    record.gap = m.points[0].gap;
    const auto arm = [&](std::int32_t body) {
      return stage.mid[body].is_free() ? m.normal.dot(m.points[0].position - stage.centre(body, record.lead))
                                       : 0.0;
    };
    record.arm_i = arm(slot.i);
    record.arm_j = arm(slot.j);
    return true;
  }

  SCREE_HD void store(std::int64_t to, std::int64_t place, const Record& record) const {
    using C = BallContacts<Real>;
    const Slot& slot = stage.places[place];
    const MidBody<Real>& a = stage.mid[slot.i];
    const MidBody<Real>& b = stage.mid[slot.j];
    const Vec3& n = record.normal;
    const double friction = stage.friction_of(slot);
    const double bend = stage.bend_of(slot, n);
    const double parting = n.dot(vec3(b.velocity) - vec3(a.velocity));
    // A look at the normal velocity tells of nearly all that they are not held apart (flight_of_contact).
    const double closing = n.dot(stage.kicked_velocity(slot.i) - stage.kicked_velocity(slot.j));
    const bool may_pass = record.gap > 0 && !memory[place].is_loaded() &&
                          (record.lead > 0 || closing * stage.step > tolerance::likely_closing * record.gap);
    const BallMasses masses = ball_masses(
        static_cast<double>(stage.inverse_mass(slot.i, slot.end_i)),
        static_cast<double>(stage.inverse_inertia(slot.i, slot.end_i)), record.arm_i * record.arm_i,
        static_cast<double>(stage.inverse_mass(slot.j, slot.end_j)),
        static_cast<double>(stage.inverse_inertia(slot.j, slot.end_j)), record.arm_j * record.arm_j);
    contacts.ends[to] = {slot.end_i, slot.end_j};
    contacts.slot[to] = static_cast<std::uint8_t>(place % 256);
    contacts.flags[to] =
        static_cast<std::uint8_t>((may_pass ? flag_may_pass : 0) | (record.lead > 0 ? flag_late : 0));
    const Fields<Real>& f = contacts.fields;
    const auto put = [&](int field, double value) { f.at(field, to) = static_cast<Real>(value); };
    const V3<Real> impulse = v3<Real>(stage.remembered(memory[place].impulse, n, friction));
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
    put(C::flown, record.gap + stage.opened_by_then(slot, n, bend, record.lead));
    put(C::pushed, 0);
    put(C::cap, tolerance::correction_cap * fmin(a.size, b.size));
  }
};

/// Those of a tile that may fly past.
template <class Real>
struct MarkPassing {
  struct Record {};

  BallContacts<Real> contacts;
  const std::int32_t* found;   ///< contacts of each tile
  View<std::uint8_t> in_tile;  ///< where each is, in its tile

  SCREE_HD bool find(std::int64_t c, Record&) const {
    return has_contact(found, c) && (contacts.flags[c] & flag_may_pass) != 0;
  }
  SCREE_HD void store(std::int64_t to, std::int64_t c, const Record&) const {
    in_tile[to] = static_cast<std::uint8_t>(c % 256);
  }
};

/// Decides on them: work of another kind than that on the many which touch, and so it is done apart.
template <class Real>
struct JudgePassing {
  FindStage<Real> stage;
  BallContacts<Real> contacts;
  const std::int32_t* found;  ///< of those that may, in each tile
  ConstView<std::uint8_t> in_tile;

  SCREE_HD void operator()(std::int64_t k) const {
    using C = BallContacts<Real>;
    if (!has_contact(found, k)) return;
    const std::int64_t c = k - k % 256 + in_tile[k];
    contacts.flags[c] &= static_cast<std::uint8_t>(~flag_may_pass);
    const Slot& slot = stage.places[k - k % 256 + contacts.slot[c]];
    Manifold m;
    if (!meet_balls(stage, slot, stage.lead_of(slot), m)) return;
    m.i = slot.i;
    m.j = slot.j;
    const double size = fmin(stage.mid[slot.i].size, stage.mid[slot.j].size);
    if (!flight_of_contact(stage.struck, m, m.points, size, false).flying) return;
    contacts.flags[c] |= flag_flying;
    const double free = m.normal.dot(stage.kicked_velocity(slot.j) - stage.kicked_velocity(slot.i));
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
    const Slot& slot = stage.places[first_place + k];
    if (slot.i == Slot::empty) return false;
    const MidBody<Real>& a = stage.mid[slot.i];
    const MidBody<Real>& b = stage.mid[slot.j];
    const double margin = static_cast<double>(a.margin) + static_cast<double>(b.margin);
    const double lead = stage.lead_of(slot);
    bool found = false;
    if (lead > 0 || !are_far(slot, margin)) {
      Manifold all[max_pair_manifolds];
      const int count = find_pair_contacts(a.shape, stage.solid(slot.i, lead), b.shape,
                                           stage.solid(slot.j, lead), margin, all);
      const bool tube = a.shape == Shape::tube || b.shape == Shape::tube;
      const bool corners = tube && (a.shape == Shape::box || b.shape == Shape::box);
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
    record.flight = flight_of_contact(stage.struck, m, m.points, fmin(a.size, b.size), loaded);
    return true;
  }

  SCREE_HD void store(std::int64_t to, std::int64_t k, const Record& record) const {
    using C = PointContacts<Real>;
    const Manifold& m = record.manifold;
    const double lead = record.flight.lead;
    const Slot& slot = stage.places[first_place + k];
    const double friction = stage.friction_of(slot);
    const double size = fmin(stage.mid[slot.i].size, stage.mid[slot.j].size);
    const double shell = m.count == 1 ? 0.0 : tolerance::closed_gap * size;
    const SolverBody i = solver_body(slot.i, slot.end_i);
    const SolverBody j = solver_body(slot.j, slot.end_j);
    PointMemory<Real> old = memory[k];
    PointMemory<Real>& now = memory[k];
    contacts.ends[to] = {slot.end_i, slot.end_j};
    contacts.slot[to] = static_cast<std::uint8_t>(k % 256);
    contacts.flags[to] = static_cast<std::uint8_t>((record.flight.flying ? flag_flying : 0) |
                                                   (record.flight.lead > 0 ? flag_late : 0));
    contacts.points[to] = m.count;
    contacts.fields.set(C::normal, to, v3<Real>(m.normal));
    contacts.fields.at(C::friction, to) = static_cast<Real>(friction);
    contacts.fields.at(C::cap, to) = static_cast<Real>(tolerance::correction_cap * size);
    now.count = m.count;
    const double bend = stage.bend_of(slot, m.normal);
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
      const double free = parting + m.normal.dot(stage.kick_of(slot.j) - stage.kick_of(slot.i));
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
      put(C::flown, point.gap + stage.opened_by_then(slot, m.normal, bend, lead));
      put(C::pushed, 0);
    }
  }

 private:
  /// Before the kick.
  SCREE_HD SolverBody solver_body(std::int32_t body, std::int32_t end) const {
    const double parts =
        body == end || !stage.mid[body].is_free()
            ? 1.0
            : static_cast<double>(stage.solver[end].inverse_mass) / stage.bodies.inverse_mass[body];
    return {
        stage.bodies.velocity[body], stage.bodies.spin[body], parts * stage.bodies.inverse_mass[body],
        parts * world_inverse_inertia(stage.bodies.orientation[body], stage.bodies.inverse_inertia[body])};
  }
  /// True if the spheres around two bodies are too far apart for a contact.
  SCREE_HD bool are_far(const Slot& slot, double margin) const {
    const Shape a = stage.mid[slot.i].shape, b = stage.mid[slot.j].shape;
    if (is_boundary(a) || is_boundary(b)) return false;
    const double reach = bounding_radius(a, stage.bodies.size[slot.i]) +
                         bounding_radius(b, stage.bodies.size[slot.j]) + margin;
    return (stage.mid[slot.j].position - stage.mid[slot.i].position).squaredNorm() >
           (1 + tolerance::far_rounding) * reach * reach;
  }
};

}  // namespace scree::resident
