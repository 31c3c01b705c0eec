// What the contacts of a substep have moved, once their impulses are found: for the ledger, for the
// observation, and for the position correction that follows.
#pragma once

#include "core/space_atomic.hpp"
#include "core/tolerances.hpp"
#include "sim/dynamics/state.hpp"
#include "sim/observation.hpp"
#include "sim/resident/layout.hpp"
#include "sim/resident/sweeps.hpp"

#include <cmath>
#include <cstdint>

namespace scree::resident {

/// Sums over contacts.
struct Books {
  double restitution = 0;  ///< dissipated (J)
  double friction = 0;
  double work = 0;           ///< of bodies that are not free (J)
  double gaps = 0;           ///< sum of |gap| of loaded points (m)
  std::int64_t loaded = 0;   ///< points that carry an impulse
  std::int64_t ends = 0;     ///< free bodies at loaded contacts
  std::int64_t gaining = 0;  ///< contacts that gain energy
  double deepest = 0;        ///< overlap at the end, of the cap
  double gap_power = 0;      ///< of normal impulses on what they leave undone: 0 when all are found (J)
  double kick_power = 0;     ///< of impulses on what they have changed (J)

  SCREE_HD friend Books operator+(const Books& a, const Books& b) {
    return {a.restitution + b.restitution,
            a.friction + b.friction,
            a.work + b.work,
            a.gaps + b.gaps,
            a.loaded + b.loaded,
            a.ends + b.ends,
            a.gaining + b.gaining,
            a.deepest > b.deepest ? a.deepest : b.deepest,
            a.gap_power + b.gap_power,
            a.kick_power + b.kick_power};
  }
};

/// Velocities of a body at a contact.
struct EndVelocities {
  Vec3 before, before_spin;  ///< the kick
  Vec3 free, free_spin;      ///< after the kick, without contacts
  Vec3 after, after_spin;    ///< with them
};

/// What all contacts have in common.
template <class Real>
struct BookStage {
  ConstView<Slot> places;
  ConstBodyView bodies;
  ConstView<BodyRecord<Real>> free;
  ConstView<BodyRecord<Real>> solver;
  ResponseParameters parameters;
  double step;
  View<std::uint32_t> loads;  ///< bytes of candidates: a bit for each part that is loaded

  SCREE_HD EndVelocities velocities(std::int32_t body, std::int32_t end) const {
    EndVelocities v;
    const BodyRecord<Real>& f = free[end];
    const BodyRecord<Real>& a = solver[end];
    v.free = vec3(f.velocity);
    v.free_spin = vec3(f.spin);
    v.after = vec3(a.velocity);
    v.after_spin = vec3(a.spin);
    v.before = a.inverse_mass > 0 ? Vec3(v.free - step * parameters.acceleration_of(body)) : v.free;
    v.before_spin = parameters.torque.size() > 0 ? bodies.spin[body] : v.free_spin;
    return v;
  }
  /// Manifold::part of a slot's surface: the corners of a box all touch the one wall.
  SCREE_HD int part_of(const Slot& slot) const {
    const Shape a = bodies.shape[slot.i], b = bodies.shape[slot.j];
    const bool corners = (a == Shape::tube && b == Shape::box) || (a == Shape::box && b == Shape::tube);
    constexpr int box_corners = 8;
    if (!corners) return slot.surface;
    return slot.surface < box_corners ? 0 : slot.surface - box_corners + 1;
  }
  SCREE_HD void mark_loaded(const Slot& slot, int part) const {
    const auto candidate = static_cast<std::uint32_t>(slot.candidate);
    set_bits(&loads[candidate / 4], 1u << (8 * (candidate % 4) + static_cast<std::uint32_t>(part)));
  }

  /// Adds what an impulse p on j, and reversed on i, has moved: account(), at the arms given.
  SCREE_HD void book(const Vec3& p, const Vec3& n, const Vec3& arm_i, const Vec3& arm_j, double target,
                     const EndVelocities& i, const EndVelocities& j, bool free_i, bool free_j, Moved& moved,
                     Books& books) const {
    const auto at = [](const Vec3& v, const Vec3& w, const Vec3& arm) { return Vec3(v + w.cross(arm)); };
    const Vec3 before = at(j.before, j.before_spin, arm_j) - at(i.before, i.before_spin, arm_i);
    const Vec3 free_u = at(j.free, j.free_spin, arm_j) - at(i.free, i.free_spin, arm_i);
    const Vec3 after = at(j.after, j.after_spin, arm_j) - at(i.after, i.after_spin, arm_i);
    const Vec3 mean = 0.5 * (before + after);
    const double normal_part = p.dot(n) * mean.dot(n);
    books.restitution -= normal_part;
    books.friction -= p.dot(mean) - normal_part;
    if (!free_i) books.work += p.dot(at(i.after, i.after_spin, arm_i));
    if (!free_j) books.work -= p.dot(at(j.after, j.after_spin, arm_j));
    moved.linear += 0.5 * p.dot(before + free_u);
    const double changed = p.dot(after - free_u);
    moved.square += 0.5 * changed;
    books.gap_power += p.dot(n) * (after.dot(n) - target);
    books.kick_power += changed;
  }
};

/// What flies past is nearer to the other's tangent plane than to the other: its gap does not count.
SCREE_HD inline bool passes(std::uint8_t flags, bool loaded) { return (flags & flag_flying) != 0 && !loaded; }

/// Of contacts of balls. Sets their gaps at the end, and remembers their impulses.
template <class Real>
struct BookBalls {
  static constexpr int blocks_at_once = 2;

  BookStage<Real> stage;
  BallContacts<Real> contacts;
  View<BallMemory<Real>> memory;

  SCREE_HD Books operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    const std::int64_t place = c - c % 256 + contacts.slot[c];
    const Ends ends = contacts.ends[c];
    const Fields<Real>& f = contacts.fields;
    const V3<Real> n = f.vector(C::normal, c);
    const V3<Real> impulse = f.vector(C::impulse, c);
    Books books;
    memory[place] = {impulse};
    const bool loaded = memory[place].is_loaded();
    if (loaded) {
      const Slot& slot = stage.places[place];
      const EndVelocities i = stage.velocities(slot.i, ends.i);
      const EndVelocities j = stage.velocities(slot.j, ends.j);
      const bool free_i = stage.solver[ends.i].inverse_mass > 0;
      const bool free_j = stage.solver[ends.j].inverse_mass > 0;
      Moved moved;
      stage.book(vec3(impulse), vec3(n), static_cast<double>(f.at(C::arm_i, c)) * vec3(n),
                 static_cast<double>(f.at(C::arm_j, c)) * vec3(n), static_cast<double>(f.at(C::target, c)), i,
                 j, free_i, free_j, moved, books);
      books.gaining = moved.gains(tolerance::response_gain) ? 1 : 0;
      books.gaps = fabs(static_cast<double>(f.at(C::gap, c)));
      books.loaded = 1;
      books.ends = static_cast<int>(free_i) + static_cast<int>(free_j);
      if (stage.loads.size() > 0) stage.mark_loaded(slot, slot.surface);
    }
    Real& flown = f.at(C::flown, c);
    if (contacts.flags[c] == 0) {
      const V3<Real> u = stage.solver[ends.j].velocity - stage.solver[ends.i].velocity;
      flown += static_cast<Real>(0.5 * stage.step) * dot(n, u);
      books.deepest = fmax(0.0, static_cast<double>(-flown / f.at(C::cap, c)));
    } else if (passes(contacts.flags[c], loaded)) {
      flown = static_cast<Real>(HUGE_VAL);
    }
    return books;
  }
};

/// Of the others.
template <class Real>
struct BookPoints {
  BookStage<Real> stage;
  std::int64_t first_place;
  PointContacts<Real> contacts;
  View<PointMemory<Real>> memory;

  SCREE_HD Books operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    const std::int64_t place = c - c % 256 + contacts.slot[c];
    const Slot& slot = stage.places[first_place + place];
    const Ends ends = contacts.ends[c];
    const EndVelocities i = stage.velocities(slot.i, ends.i);
    const EndVelocities j = stage.velocities(slot.j, ends.j);
    const Vec3 n = vec3(contacts.fields.vector(C::normal, c));
    const bool free_i = stage.solver[ends.i].inverse_mass > 0;
    const bool free_j = stage.solver[ends.j].inverse_mass > 0;
    const double cap = static_cast<double>(contacts.fields.at(C::cap, c));
    const Fields<Real>& f = contacts.point_fields;
    Books books;
    Moved moved;
    for (int k = 0; k < contacts.points[c]; ++k) {
      const Vec3 arm_i = vec3(f.vector(C::at_point(k, C::arm_i), c));
      const Vec3 arm_j = vec3(f.vector(C::at_point(k, C::arm_j), c));
      const V3<Real> impulse = f.vector(C::at_point(k, C::impulse), c);
      memory[place].impulse[k] = impulse;
      if (impulse.x != 0 || impulse.y != 0 || impulse.z != 0) {
        stage.book(vec3(impulse), n, arm_i, arm_j, static_cast<double>(f.at(C::at_point(k, C::target), c)), i,
                   j, free_i, free_j, moved, books);
        books.gaps += fabs(static_cast<double>(f.at(C::at_point(k, C::gap), c)));
        ++books.loaded;
      }
      Real& flown = f.at(C::at_point(k, C::flown), c);
      if (passes(contacts.flags[c], impulse.x != 0 || impulse.y != 0 || impulse.z != 0))
        flown = static_cast<Real>(HUGE_VAL);
      if (contacts.flags[c] != 0) continue;
      const Vec3 u = j.after + j.after_spin.cross(arm_j) - i.after - i.after_spin.cross(arm_i);
      flown += static_cast<Real>(0.5 * stage.step * n.dot(u));
      books.deepest = fmax(books.deepest, static_cast<double>(-flown) / cap);
    }
    if (books.loaded == 0) return books;
    books.ends = static_cast<int>(free_i) + static_cast<int>(free_j);
    books.gaining = moved.gains(tolerance::response_gain) ? 1 : 0;
    if (stage.loads.size() > 0) stage.mark_loaded(slot, stage.part_of(slot));
    return books;
  }
};

}  // namespace scree::resident
