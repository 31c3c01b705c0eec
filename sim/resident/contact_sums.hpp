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

/// What a contact gave to a body that is not free.
struct WallImpulse {
  std::int32_t body;     ///< its place
  Vec3 impulse, moment;  ///< about its centre (N s, N m s)
};

/// Contacts with bodies that somebody asks about, and what they gave to these.
template <class Real>
struct AskedContacts {
  ConstView<std::uint8_t> asked;  ///< of each body
  ConstView<Slot> places;         ///< of contacts of this kind
  ConstView<MidBody<Real>> mid;
  FlightStage flight;

  SCREE_HD bool is_asked(const Slot& slot) const { return asked[slot.i] != 0 || asked[slot.j] != 0; }
  SCREE_HD const Slot& slot_of(std::int64_t c, std::uint8_t slot) const { return places[c - c % 256 + slot]; }
  /// Where the centre of a body is when a contact is seen.
  SCREE_HD Vec3 centre(std::int32_t body, const Slot& slot, bool late) const {
    if (!late) return mid[body].position;
    const double lead = fmax(flight.clock[slot.i], flight.clock[slot.j]) - 0.5 * flight.terms.step;
    const Vec3 kick = mid[body].is_free() ? Vec3(flight.terms.step * flight.parameters.acceleration_of(body))
                                          : Vec3(Vec3::Zero());
    return mid[body].position + lead * (vec3(mid[body].velocity) + kick);
  }
};

/// The place of a contact of balls that is asked about and loaded, else none.
template <class Real>
struct AskedBalls {
  static constexpr std::uint32_t none = 0xffffffffu;
  AskedContacts<Real> among;
  BallContacts<Real> contacts;
  ConstView<std::int32_t> list;

  SCREE_HD std::uint32_t operator()(std::int64_t k) const {
    const std::int32_t c = list[k];
    const bool loaded = !is_zero(contacts.fields.vector(BallContacts<Real>::impulse, c));
    return loaded && among.is_asked(among.slot_of(c, contacts.slot[c])) ? static_cast<std::uint32_t>(c)
                                                                        : none;
  }
  SCREE_HD WallImpulse of(std::int64_t c) const {
    using C = BallContacts<Real>;
    const auto& f = contacts.fields;
    const Slot& slot = among.slot_of(c, contacts.slot[c]);
    const bool on_j = among.asked[slot.j] != 0;
    const std::int32_t wall = on_j ? slot.j : slot.i, ball = on_j ? slot.i : slot.j;
    const bool late = (contacts.flags[c] & flag_late) != 0;
    const double arm = static_cast<double>(f.at(on_j ? C::arm_i : C::arm_j, c));
    const Vec3 point = among.centre(ball, slot, late) + arm * vec3(f.vector(C::normal, c));
    const Vec3 impulse = (on_j ? 1.0 : -1.0) * vec3(f.vector(C::impulse, c));
    const Vec3 lever = among.flight.bodies.period.nearest(point - among.centre(wall, slot, late));
    return {wall, impulse, lever.cross(impulse)};
  }
};

/// The same of other contacts.
template <class Real>
struct AskedPoints {
  static constexpr std::uint32_t none = 0xffffffffu;
  AskedContacts<Real> among;
  PointContacts<Real> contacts;
  ConstView<std::int32_t> list;

  SCREE_HD std::uint32_t operator()(std::int64_t k) const {
    const std::int32_t c = list[k];
    return among.is_asked(among.slot_of(c, contacts.slot[c])) ? static_cast<std::uint32_t>(c) : none;
  }
  SCREE_HD WallImpulse of(std::int64_t c) const {
    using C = PointContacts<Real>;
    const Slot& slot = among.slot_of(c, contacts.slot[c]);
    const bool on_j = among.asked[slot.j] != 0;
    WallImpulse sum{on_j ? slot.j : slot.i, Vec3::Zero(), Vec3::Zero()};
    for (int k = 0; k < contacts.points[c]; ++k) {
      const Vec3 impulse =
          (on_j ? 1.0 : -1.0) * vec3(contacts.point_fields.vector(C::at_point(k, C::impulse), c));
      const auto at = point_at<Scalar<Real>>(contacts, c, k);
      sum.impulse += impulse;
      sum.moment += vec3(on_j ? at.arm_j : at.arm_i).cross(impulse);
    }
    return sum;
  }
};

template <class Asked>
struct PutWallImpulse {
  Asked asked;
  ConstView<std::uint32_t> contacts;
  View<WallImpulse> out;
  SCREE_HD void operator()(std::int64_t k) const { out[k] = asked.of(contacts[k]); }
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
