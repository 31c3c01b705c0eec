// The search for contacts of several points: finds which of the slots that are not of balls have a contact,
// and computes what the sweeps need to know of it.
#pragma once

#include "narrowphase/any_contacts.hpp"
#include "narrowphase/far_apart.hpp"
#include "sim/contacts/find_stage.hpp"
#include "sim/laws/rotation.hpp"

namespace scree::solver {

/// Whether the spheres around two bodies are too far apart for a contact.
template <class Real>
SCREE_HD inline bool are_far(const FindStage<Real>& stage, const SlotBodies<Real>& at) {
  if (is_boundary(at.a.shape) || is_boundary(at.b.shape)) return false;
  const double reach = bounding_radius(at.a.shape, stage.bodies.size[at.slot.i]) +
                       bounding_radius(at.b.shape, stage.bodies.size[at.slot.j]) + at.margin();
  return are_far_apart(stage.bodies.period.nearest(at.b.position - at.a.position), reach);
}

/// Returns body j of a slot, at its periodic image that is nearest to body i.
template <class Real>
SCREE_HD inline Solid solid_near(const FindStage<Real>& stage, const SlotBodies<Real>& at, double delay) {
  Solid b = stage.solid(at.slot.j, delay);
  stage.bodies.period.bring_near(stage.solid(at.slot.i, delay).position, b.position);
  return b;
}

/// Finds the contact of a slot of any two shapes. This function is needed rarely and is not inlined, so that
/// it takes no registers from the common code.
template <class Real>
[[gnu::noinline]] SCREE_HD bool meet_any(const FindStage<Real>& stage, const SlotBodies<Real>& at,
                                         double delay, Manifold& out) {
  Manifold all[max_pair_manifolds];
  const Solid a = stage.solid(at.slot.i, delay);
  Solid b = stage.solid(at.slot.j, delay);
  stage.bodies.period.bring_near(a.position, b.position);
  const int count = find_any_contacts({at.a.shape, a}, {at.b.shape, b}, stage.shapes_of(at.slot.i, at.slot.j),
                                      {.margin = at.margin()}, all);
  const auto is_of = [&](Shape shape) { return at.a.shape == shape || at.b.shape == shape; };
  const bool corners = is_of(Shape::tube) && is_of(Shape::box);
  const Manifold* on = manifold_on(at.slot.surface, corners, all, count);
  if (on != nullptr) out = *on;
  return on != nullptr;
}

/// Finds the contact of a slot that is not of balls, with the normal of the narrow phase.
template <class Real>
SCREE_HD inline bool find_points(const FindStage<Real>& stage, const SlotBodies<Real>& at, double delay,
                                 Manifold& out) {
  if (delay == 0 && are_far(stage, at)) return false;
  SCREE_ON_HOST(
      if (stage.libccd != nullptr && stage.libccd->decides(at.a.shape, at.b.shape)) return stage.libccd->find(
          {at.a.shape, stage.solid(at.slot.i, delay)}, {at.b.shape, solid_near(stage, at, delay)},
          stage.shapes_of(at.slot.i, at.slot.j), at.margin(), &out) > 0;)
  const bool box_a = at.a.shape == Shape::box;
  const bool box_b = at.b.shape == Shape::box;
  const bool plane = at.a.shape == Shape::plane || at.b.shape == Shape::plane;
  if (!(box_a && box_b) && !((box_a || box_b) && plane)) return meet_any(stage, at, delay, out);
  const Solid a = stage.solid(at.slot.i, delay);
  Solid b = stage.solid(at.slot.j, delay);
  stage.bodies.period.bring_near(a.position, b.position);
  out.part = 0;
  if (!plane) return box_box(a, b, at.margin(), out);
  const bool found = box_plane(box_a ? a : b, box_a ? b : a, at.margin(), out);
  if (found && !box_a) out.normal = -out.normal;
  return found;
}

/// Finds the contact of a slot that is not of balls. A contact at an edge may take the normal of a face.
template <class Real>
SCREE_HD inline bool meet_points(const FindStage<Real>& stage, const SlotBodies<Real>& at, double delay,
                                 Manifold& out) {
  if (!find_points(stage, at, delay, out)) return false;
  if (out.at_edge) take_normal_of_face(stage.struck, at.slot.i, at.slot.j, out.count, out.points, out.normal);
  return true;
}

/// Finds and makes contacts that are not of balls alone, as if all their bodies met and stayed together.
/// Contacts whose bodies may fly past each other or bounce are added to `approaching`.
template <class Real>
struct FindPoints {
  using Record = FoundManifold;

  static constexpr int blocks_at_once = 1;

  FindStage<Real> stage;
  std::int64_t first_place;  ///< place of the first slot that is not of balls
  PointContacts<Real> contacts;
  View<PointMemory<Real>> memory;
  ConstView<LoadedParts> loads;  ///< one element for each candidate
  ApproachList approaching;
  View<Record> records;  ///< the contact found at each slot

  /// The number of kinds of slots whose work differs most: those with a sphere, those of two boxes, and
  /// others.
  static constexpr int kinds = 3;
  SCREE_HD int kind(std::int64_t k) const {
    const Slot slot = stage.places[first_place + k];
    if (slot.i == Slot::empty) return -1;
    const SlotBodies<Real> at = stage.load(slot);
    if (stage.delay_of(slot) == 0 && are_far(stage, at)) {
      memory[k].count = 0;
      return -1;
    }
    if (at.a.shape == Shape::sphere || at.b.shape == Shape::sphere) return 0;
    return at.a.shape == Shape::box && at.b.shape == Shape::box ? 1 : 2;
  }

  bool is_end(std::int64_t k) const { return stage.places[first_place + k].i == Slot::empty; }
  SCREE_HD bool find(std::int64_t k, Record& record) const {
    const Slot slot = stage.places[first_place + k];
    if (slot.i == Slot::empty) return false;
    record.delay = stage.delay_of(slot);
    const SlotBodies<Real> at = stage.load(slot);
    SCREE_ON_HOST(if (stage.libccd != nullptr) crosscheck(at, record.delay);)
    if (meet_points(stage, at, record.delay, record.manifold)) return true;
    memory[k].count = 0;
    return false;
  }

  SCREE_HD void keep(std::int64_t k, const Record& record) const { records[k] = record; }
  /// Makes contact `to` from a slot that has a contact.
  SCREE_HD void make(std::int64_t to, std::int64_t k) const {
    using C = PointContacts<Real>;
    const Record& record = records[k];
    const Manifold& m = record.manifold;
    const double delay = record.delay;
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
    contacts.flags[to] = static_cast<std::uint8_t>(delay > 0 ? flag_late_impact : 0);
    contacts.points[to] = m.count;
    contacts.fields.set(C::normal, to, v3<Real>(m.normal));
    contacts.fields.at(C::friction, to) = static_cast<Real>(friction);
    contacts.fields.at(C::cap, to) = static_cast<Real>(tolerance::correction_cap * pair.size());
    put_inertia(C::inertia_i, to, i.inverse_inertia);
    put_inertia(C::inertia_j, to, j.inverse_inertia);
    now.count = m.count;
    const double curvature = stage.curvature_of(pair, m.normal);
    bool approaches = false;
    for (int p = 0; p < m.count; ++p) {
      const ContactPoint& point = m.points[p];
      RowCoupling coupling;
      const ContactRow row =
          make_row(m.normal, stage.arm(pair.a, slot.i, delay, point.position),
                   stage.arm(pair.b, slot.j, delay, point.position), point.gap, i, j, coupling);
      now.feature[p] = point.feature;
      V3<Real> last{};
      for (int q = 0; q < old.count; ++q)
        if (old.feature[q] == point.feature) last = old.impulse[q];
      const V3<Real> impulse = v3<Real>(stage.remembered(last, m.normal, friction));
      const double separating = m.normal.dot(row.relative_velocity(i, j));
      const double closing = -(separating + m.normal.dot(kick));
      approaches = approaches || stage.may_be_held_apart(point.gap, closing, delay);
      const auto at = [p](auto field) { return C::at_point(p, field); };
      const auto& f = contacts.point_fields;
      const auto put = [&](auto field, double value) { f.at(at(field), to) = static_cast<Real>(value); };
      f.set(at(C::arm_i), to, v3<Real>(row.arm_i));
      f.set(at(C::arm_j), to, v3<Real>(row.arm_j));
      const Mat3& w = coupling.stick;
      const double stick[] = {w(0, 0), w(1, 1), w(2, 2), w(0, 1), w(0, 2), w(1, 2)};
      for (int e = 0; e < 6; ++e) f.at(at(C::stick) + e, to) = static_cast<Real>(stick[e]);
      f.set(at(C::coupling), to, v3<Real>(coupling.normal));
      put(C::target, stage.target_of(point.gap, shell, curvature, separating, delay));
      put(C::normal_mass, row.normal_mass);
      put(C::tangent_mass, row.tangent_mass);
      f.set(at(C::impulse), to, impulse);
      f.set(at(C::last), to, impulse);
      const auto put_gap = [&](typename C::GapField field, double value) {
        contacts.gaps.at(C::at_point(p, field), to) = static_cast<Real>(value);
      };
      put_gap(C::gap, point.gap);
      put_gap(C::predicted_gap, point.gap + stage.opened_by_then(pair, m.normal, curvature, delay));
      put_gap(C::pushed, 0);
      put_gap(C::pushed_before, 0);
    }
    if (approaches && !loads[slot.candidate].is_loaded(m.part)) approaching.add(to);
  }

 private:
  /// Compares the answer of libccd, if the pair of the slot is one of those to be checked.
  void crosscheck(const SlotBodies<Real>& at, double delay) const {
    const auto number = [&](std::int32_t k) { return static_cast<std::int32_t>(stage.bodies.id[k]); };
    const Slot& slot = at.slot;
    if (stage.libccd->checks(at.a.shape, at.b.shape, number(slot.i), number(slot.j)))
      stage.libccd->check({at.a.shape, stage.solid(slot.i, delay)},
                          {at.b.shape, solid_near(stage, at, delay)}, stage.shapes_of(slot.i, slot.j));
  }
  SCREE_HD void put_inertia(int first, std::int64_t to, const Mat3& m) const {
    const double elements[] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
    for (int e = 0; e < 6; ++e) contacts.fields.at(first + e, to) = static_cast<Real>(elements[e]);
  }
  /// Returns a body as the solver has it, at its velocities before the kick. A part of a hub has the inverse
  /// mass and inertia of its share.
  SCREE_HD SolverBody solver_body(const MidBody<Real>& body, std::int32_t k, std::int32_t end) const {
    const ConstBodyView& bodies = stage.bodies;
    const double parts = k == end || !body.is_free()
                             ? 1.0
                             : static_cast<double>(stage.solver[end].inverse_mass) / bodies.inverse_mass[k];
    return {bodies.velocity[k], bodies.spin[k], parts * bodies.inverse_mass[k],
            parts * world_inverse_inertia(bodies.orientation[k], bodies.inverse_inertia[k])};
  }
};

/// Decides for a contact of several points whether its bodies fly past each other or bounce, and sets the
/// targets of its points.
template <class Real>
struct JudgePoints {
  FindStage<Real> stage;
  std::int64_t first_place;
  PointContacts<Real> contacts;
  ConstView<FoundManifold> records;  ///< contact that FindPoints has found at each slot

  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    const std::int32_t place = contacts.slot[c];
    const Slot slot = stage.places[first_place + place];
    const SlotBodies<Real> at = stage.load(slot);
    const double delay = records[place].delay;
    Manifold m = records[place].manifold;
    m.i = slot.i;
    m.j = slot.j;
    const bool flying = flight_of_contact(stage.struck, m, m.points, at.size(), false).flying;
    if (!flying && !stage.struck.stage.both_bore_load(slot.i, slot.j)) return;
    if (flying) contacts.flags[c] |= flag_flying;
    const auto velocity_at = [&](const MidBody<Real>& at_mid, std::int32_t body, const Vec3& point) {
      return Vec3(stage.bodies.velocity[body] +
                  stage.bodies.spin[body].cross(stage.arm(at_mid, body, delay, point)));
    };
    const Vec3 kick_i = stage.kick_of(at.a, slot.i), kick_j = stage.kick_of(at.b, slot.j);
    for (int p = 0; p < m.count; ++p) {
      const Vec3& point = m.points[p].position;
      const Vec3 before_i = velocity_at(at.a, slot.i, point);
      const Vec3 before_j = velocity_at(at.b, slot.j, point);
      const double before = m.normal.dot(before_j - before_i);
      const double free = before + m.normal.dot(kick_j - kick_i);
      Real& target = contacts.point_fields.at(C::at_point(p, C::target), c);
      const auto otherwise = static_cast<double>(target);
      target = static_cast<Real>(
          flying ? stage.target_in_flight(otherwise, free,
                                          (before_i + kick_i).norm() + (before_j + kick_j).norm())
                 : stage.target_of_bounce(slot, otherwise, m.points[p].gap, before, free, delay));
    }
  }
};

}  // namespace scree::solver
