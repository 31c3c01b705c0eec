// The data from which contacts are made (slots and their bodies at the midpoint), and what the search for
// contacts of both kinds has in common.
#pragma once

#include "core/space_atomic.hpp"
#include "core/tolerances.hpp"
#include "narrowphase/any_contacts.hpp"
#include "narrowphase/contact.hpp"
#include "narrowphase/libccd_contacts.hpp"
#include "narrowphase/tube.hpp"
#include "sim/contacts/contact_flight.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/laws/contact_laws.hpp"
#include "sim/laws/contact_row.hpp"
#include "sim/laws/response_parameters.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace scree::solver {

/// A slot and its two bodies. They are loaded as whole records, which takes fewer accesses to memory than
/// field by field.
template <class Real>
struct SlotBodies {
  Slot slot;
  MidBody<Real> a, b;
  SCREE_HD double margin() const { return static_cast<double>(a.margin) + static_cast<double>(b.margin); }
  SCREE_HD double size() const { return fmin(a.size, b.size); }
};

/// The data from which contacts are made, and functions of them.
template <class Real>
struct FindStage {
  ConstView<Slot> places;
  ConstView<MidBody<Real>> mid;
  ConstBodyView bodies;                ///< at the midpoint, before the kick
  ConstView<BodyRecord<Real>> solver;  ///< the bodies of the solver, after the kick
  ContactLaws laws;
  ResponseParameters parameters;
  double step;                       ///< s
  double scale;                      ///< factor for remembered impulses
  double noise;                      ///< largest separating speed that counts as none (m/s)
  StruckFlights struck;              ///< the bodies after their impacts
  bool any_late_impact;              ///< whether any body was struck after the midpoint
  LibccdContacts* libccd = nullptr;  ///< on Host alone; null if libccd is not used

  SCREE_HD SlotBodies<Real> load(const Slot& slot) const { return {slot, mid[slot.i], mid[slot.j]}; }
  SCREE_HD const PairLaw& law_of(const SlotBodies<Real>& at) const {
    return laws.table[at.a.material * laws.materials + at.b.material];
  }
  SCREE_HD PairShapes shapes_of(std::int32_t i, std::int32_t j) const {
    return {laws.shape_data(i), laws.shape_data(j)};
  }
  SCREE_HD double friction_of(const SlotBodies<Real>& at) const {
    return parameters.friction ? law_of(at).friction : 0.0;
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
  /// Returns the velocity of j relative to i, before the kick. The next function returns it after the kick.
  SCREE_HD static Vec3 relative_velocity(const SlotBodies<Real>& at) {
    return vec3(at.b.velocity) - vec3(at.a.velocity);
  }
  SCREE_HD Vec3 kicked_relative_velocity(const SlotBodies<Real>& at) const {
    return kicked_velocity(at.b, at.slot.j) - kicked_velocity(at.a, at.slot.i);
  }
  /// Whether an end of a slot is a point of a turning wall: a body that is not free and that has an end of
  /// its own for this slot.
  SCREE_HD static bool is_wall_point(const MidBody<Real>& body, std::int32_t k, std::int32_t end) {
    return !body.is_free() && end != k;
  }
  /// Returns the velocity of a wall at a point, `delay` after the midpoint (m/s). This function is needed
  /// rarely and is not inlined, so that it takes no registers from the common code.
  [[gnu::noinline]] SCREE_HD V3<Real> wall_velocity(std::int32_t wall, const Vec3& point,
                                                    double delay) const {
    const Vec3 centre = bodies.position[wall] + delay * bodies.velocity[wall];
    return v3<Real>(bodies.velocity[wall] + bodies.spin[wall].cross(bodies.period.nearest(point - centre)));
  }
  /// Replaces the velocity of a turning wall by that of its point in this contact.
  SCREE_HD void take_wall_points(SlotBodies<Real>& at) const {
    if (is_wall_point(at.a, at.slot.i, at.slot.end_i)) at.a.velocity = solver[at.slot.end_i].velocity;
    if (is_wall_point(at.b, at.slot.j, at.slot.end_j)) at.b.velocity = solver[at.slot.end_j].velocity;
  }
  /// Returns the time after the midpoint at which the contact of a slot is found (s); it is 0 for nearly all
  /// slots.
  SCREE_HD double delay_of(const Slot& slot) const {
    return any_late_impact ? late_delay_of(slot.i, slot.j) : 0.0;
  }
  SCREE_HD Solid solid(std::int32_t body, double delay) const {
    if (delay > 0) return solid_after_midpoint(body, delay);
    return {bodies.position[body], bodies.orientation[body], bodies.size[body]};
  }
  /// Returns the centre of a body, `delay` after the midpoint (m).
  SCREE_HD Vec3 centre(const MidBody<Real>& body, std::int32_t k, double delay) const {
    return delay > 0 ? Vec3(body.position + delay * kicked_velocity(body, k)) : body.position;
  }
  /// Returns the lever arm from this centre to a contact point (m).
  SCREE_HD Vec3 arm(const MidBody<Real>& body, std::int32_t k, double delay, const Vec3& point) const {
    return bodies.period.nearest(point - centre(body, k, delay));
  }
  SCREE_HD Vec3 remembered(const V3<Real>& impulse, const Vec3& normal, double friction) const {
    if (!parameters.warm_start) return Vec3::Zero();
    return project_on_cone(scale * vec3(impulse), normal, friction);
  }

  /// Returns the target of the normal velocity of a point (m/s): its gap may close by the next midpoint, and
  /// no more, so that nothing overlaps there. `shell`: the gap that counts as closed (m). A contact that was
  /// separating before the kick (at the speed `separating`, m/s) would gain energy if it were held. It may
  /// close as fast as it was separating.
  SCREE_HD double target_of(double gap, double shell, double curvature, double separating,
                            double delay) const {
    const double closing = gap > shell ? -(gap - shell) / (step - delay) : 0.0;
    return fmin(closing - 0.5 * step * curvature, noise - separating);
  }
  /// Whether the row of a point may hold its bodies apart, judged by the normal velocity of the point alone.
  /// This excludes nearly all contacts; flight_of_contact() decides about the others.
  SCREE_HD bool may_be_held_apart(double gap, double closing, double delay) const {
    if (gap <= 0) return closing > 0;
    return delay > 0 || closing * step > tolerance::likely_closing * gap;
  }
  /// Returns the target of a contact whose bodies fly past each other, so that it does not hold them at all.
  /// `free`: the normal velocity without contacts; `speed`: the sum of the two bodies' speeds at the point,
  /// whose rounding must not cause an impulse (m/s).
  SCREE_HD static double target_in_flight(double target, double free, double speed) {
    constexpr double rounding = tolerance::flight_roundings * std::numeric_limits<Real>::epsilon();
    return fmin(target, free - tolerance::flight_margin * fabs(free) - rounding * speed);
  }

  /// Returns the target of a contact of two bodies that both bear load and approach. If their gap would close
  /// within the substep, so that the contact would push anyway, they bounce together with all their contacts
  /// (u+ = -e u-; Moreau 1999). `before` and `free`: the normal velocities before the kick and after it
  /// (m/s).
  SCREE_HD double target_of_bounce(const Slot& slot, double target, double gap, double before, double free,
                                   double delay) const {
    const FlightStage& flight = struck.stage;
    const bool bounces = -before > flight.slowest_bounce(slot.i, slot.j) && -free * (step - delay) > gap;
    return bounces ? -laws.between(slot.i, slot.j).restitution * before : target;
  }

  /// Returns what the gap at the end of the substep has beyond the gap of the contact and the opening by the
  /// velocities after the response (m). For a contact at the midpoint this is the effect of the curvature.
  /// The gap of a contact found later is predicted from where the centres are at the end, so their present
  /// distance along the normal is subtracted here.
  SCREE_HD double opened_by_then(const SlotBodies<Real>& at, const Vec3& n, double curvature,
                                 double delay) const {
    if (delay > 0)
      return -n.dot(bodies.period.nearest(centre(at.b, at.slot.j, delay) - centre(at.a, at.slot.i, delay)));
    return 0.125 * step * step * curvature;
  }

  /// Returns the acceleration of the gap by the turning of the normal (m/s^2). It is not 0 for two balls, and
  /// for a ball along the wall of a tube.
  SCREE_HD double curvature_of(const SlotBodies<Real>& at, const Vec3& n) const {
    const bool ball_a = at.a.shape == Shape::sphere;
    const bool ball_b = at.b.shape == Shape::sphere;
    if (!ball_a && !ball_b) return 0;
    const Vec3 w = kicked_relative_velocity(at);
    const Vec3 across = w - w.dot(n) * n;
    if (ball_a && ball_b) return across.squaredNorm() / (at.a.size + at.b.size);
    if ((ball_a ? at.b : at.a).shape != Shape::tube || at.slot.surface != tube_wall) return 0;
    return curvature_along_tube(across, ball_a ? at.slot.j : at.slot.i, at.size());
  }

 private:
  struct Inverses {
    double mass, inertia;
  };
  SCREE_HD Inverses inverses_of(const MidBody<Real>& body, std::int32_t k, std::int32_t end) const {
    if (k == end) return {static_cast<double>(body.inverse_mass), static_cast<double>(body.inverse_inertia)};
    return {static_cast<double>(solver[end].inverse_mass), static_cast<double>(solver[end].inverse_inertia)};
  }
  // The following functions are needed rarely and are not inlined, so that they take no registers from the
  // common code.
  [[gnu::noinline]] SCREE_HD double late_delay_of(std::int32_t i, std::int32_t j) const {
    return fmax(0.0, struck.time_of(i, j) - 0.5 * step);
  }
  [[gnu::noinline]] SCREE_HD Solid solid_after_midpoint(std::int32_t body, double delay) const {
    return struck.at(body, 0.5 * step + delay).solid;
  }
  [[gnu::noinline]] SCREE_HD double curvature_along_tube(const Vec3& across, std::int32_t tube,
                                                         double size) const {
    const Vec3 axis = bodies.orientation[tube] * Vec3::UnitZ();
    const double reach = bodies.size[tube].x() - size;
    return reach > 0 ? -(across - across.dot(axis) * axis).squaredNorm() / reach : 0.0;
  }
};

/// Returns the manifold of a pair that belongs to the surface of a slot, from those that the pair's test has
/// found; null if there is none. `corners`: the pair is a box in a tube, and each corner of the box has a
/// surface of its own on the wall.
SCREE_HD inline const Manifold* manifold_on(int surface, bool corners, const Manifold* found, int count) {
  constexpr int box_corners = 8;
  for (int m = 0; m < count; ++m) {
    int of = found[m].part;
    if (corners) {
      if (of == tube_wall) {
        // The feature names the vertex of the box, with one bit for its side along each axis.
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

/// The contact found at a slot that is not of balls.
struct FoundManifold {
  Manifold manifold;
  double delay;
};

/// The list of contacts whose bodies approach and bore no load, in any order.
struct ApproachList {
  View<std::int32_t> contacts;
  std::uint64_t* count;
  SCREE_HD void add(std::int64_t c) const {
    contacts[static_cast<std::int64_t>(count_up(count))] = static_cast<std::int32_t>(c);
  }
};

/// Finds the slots that have a contact, by FindBalls or FindPoints. Their keep() may store what was found,
/// for make().
template <class Find>
struct FindSlots {
  using Record = typename Find::Record;
  static constexpr int blocks_at_once = Find::blocks_at_once;
  static constexpr int kinds = Find::kinds;

  Find all;
  std::int32_t* found;

  bool is_end(std::int64_t place) const { return all.is_end(place); }
  SCREE_HD int kind(std::int64_t place) const { return all.kind(place); }
  SCREE_HD bool find(std::int64_t place, Record& record) const { return all.find(place, record); }
  SCREE_HD void store(std::int64_t to, std::int64_t slot, const Record& record) const {
    place(to, slot);
    keep(slot, record);
  }
  SCREE_HD void place(std::int64_t to, std::int64_t slot) const {
    found[to] = static_cast<std::int32_t>(slot);
  }
  SCREE_HD void keep(std::int64_t slot, const Record& record) const { all.keep(slot, record); }
};

/// Makes the contacts of the slots that have been found.
template <class Find>
struct MakeContacts {
  static constexpr int blocks_at_once = Find::blocks_at_once;

  Find all;
  SCREE_HD void operator()(std::int64_t c) const {
    if (const std::int32_t place = all.contacts.slot[c]; place != Slot::empty) all.make(c, place);
  }
};

/// Decides for a listed contact whether its bodies fly past each other or bounce. This work differs from that
/// on the many contacts that touch, so it is done in a pass of its own.
template <class Judge>
struct JudgeApproach {
  ApproachList approaching;
  Judge judge;
  SCREE_HD void operator()(std::int64_t k) const { judge(approaching.contacts[k]); }
};

}  // namespace scree::solver
