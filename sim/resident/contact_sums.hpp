// What is asked of contacts beside what they have moved: how many points they have, how their loads are
// spread, which candidates are loaded, and what they gave to one body.
#pragma once

#include "sim/dynamics/direct.hpp"
#include "sim/dynamics/flight_stage.hpp"
#include "sim/resident/books.hpp"
#include "sim/resident/layout.hpp"
#include "sim/resident/slots.hpp"

#include <cstdint>

namespace scree::resident {

template <class Real>
struct CountPoints {
  PointContacts<Real> contacts;
  SCREE_HD std::int64_t operator()(std::int64_t c) const { return contacts.points[c]; }
};

/// What is known of pairs in another list.
struct LookUpLoads {
  ConstView<Pair> pairs;
  ListedPairs known;
  ConstView<LoadedParts> loads;
  View<LoadedParts> out;
  SCREE_HD void operator()(std::int64_t k) const {
    const std::int64_t at = known.find(pairs[k]);
    out[k] = at < 0 ? LoadedParts{} : loads[at];
  }
};

template <class Real>
struct BallLoad {
  BallContacts<Real> contacts;
  SCREE_HD LoadSpread operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    const Vec3 impulse = vec3(contacts.fields.vector(C::impulse, c));
    return LoadSpread::of(impulse.squaredNorm() / contacts.fields.at(C::normal_mass, c));
  }
};
template <class Real>
struct PointLoad {
  PointContacts<Real> contacts;
  SCREE_HD LoadSpread operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    double load = 0;
    for (int k = 0; k < contacts.points[c]; ++k) {
      const Vec3 impulse = vec3(contacts.point_fields.vector(C::at_point(k, C::impulse), c));
      load += impulse.squaredNorm() / contacts.point_fields.at(C::at_point(k, C::normal_mass), c);
    }
    return LoadSpread::of(load);
  }
};

struct ImpulseSum {
  Vec3 impulse = Vec3::Zero();
  SCREE_HD friend ImpulseSum operator+(const ImpulseSum& a, const ImpulseSum& b) {
    return {a.impulse + b.impulse};
  }
};

/// What a contact gave to a body, if it is one of its two.
template <class Real>
struct BallImpulseOn {
  std::int32_t body;
  BallContacts<Real> contacts;
  ConstView<Slot> places;
  SCREE_HD ImpulseSum operator()(std::int64_t c) const {
    const Slot& slot = places[c - c % 256 + contacts.slot[c]];
    if (slot.i != body && slot.j != body) return {};
    const Vec3 impulse = vec3(contacts.fields.vector(BallContacts<Real>::impulse, c));
    return {slot.j == body ? impulse : Vec3(-impulse)};
  }
};
template <class Real>
struct PointImpulseOn {
  std::int32_t body;
  PointContacts<Real> contacts;
  ConstView<Slot> places;
  SCREE_HD ImpulseSum operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    const Slot& slot = places[c - c % 256 + contacts.slot[c]];
    if (slot.i != body && slot.j != body) return {};
    Vec3 impulse = Vec3::Zero();
    for (int k = 0; k < contacts.points[c]; ++k)
      impulse += vec3(contacts.point_fields.vector(C::at_point(k, C::impulse), c));
    return {slot.j == body ? impulse : Vec3(-impulse)};
  }
};

/// What a slot remembers is what was loaded, when candidates are made anew.
template <class Real>
struct MarkBallLoads {
  BookStage<Real> stage;
  ConstView<BallMemory<Real>> memory;
  SCREE_HD void operator()(std::int64_t place) const {
    const Slot& slot = stage.places[place];
    if (slot.i != Slot::empty && memory[place].is_loaded()) stage.mark_loaded(slot, stage.part_of(slot));
  }
};
template <class Real>
struct MarkPointLoads {
  BookStage<Real> stage;
  std::int64_t first_place;
  ConstView<PointMemory<Real>> memory;
  SCREE_HD void operator()(std::int64_t place) const {
    const Slot& slot = stage.places[first_place + place];
    if (slot.i != Slot::empty && memory[place].is_loaded()) stage.mark_loaded(slot, stage.part_of(slot));
  }
};

}  // namespace scree::resident
