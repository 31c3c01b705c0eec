// Sums over contacts other than their energy accounts: the number of points, the spread of their loads, the
// candidates that are loaded, and the impulses on bodies that are not free.
#pragma once

#include "sim/contacts/contact_accounts.hpp"
#include "sim/contacts/layout.hpp"
#include "sim/contacts/slots.hpp"
#include "sim/impacts/flight_stage.hpp"
#include "sim/response/direct.hpp"
#include "sim/response/wall_sums.hpp"

#include <cstdint>

namespace scree::solver {

template <class Real>
struct CountPoints {
  PointContacts<Real> contacts;
  SCREE_HD std::int64_t operator()(std::int64_t c) const { return contacts.points[c]; }
};

/// Finds the loaded parts of a pair from its index among the candidates; a negative index has none.
struct LoadsOfPairs {
  ConstView<std::int64_t> index;
  ConstView<LoadedParts> loads;
  View<LoadedParts> out;
  SCREE_HD void operator()(std::int64_t k) const { out[k] = index[k] < 0 ? LoadedParts{} : loads[index[k]]; }
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

/// Data for the impulses of contacts on bodies that are not free.
template <class Real>
struct WallContacts {
  ConstView<std::int32_t> entry_of;  ///< WallSums::entry_of_place()
  View<WallImpulse> impulses;        ///< impulse of each entry
  std::int64_t first_place;          ///< place of the first slot of this kind of contacts
  ConstView<Slot> places;
  ConstView<MidBody<Real>> mid;
  FlightStage flight;

  SCREE_HD bool is_on_j(const Slot& slot) const { return !mid[slot.j].is_free(); }
  /// Returns the centre of a body at the time for which the contact was found.
  SCREE_HD Vec3 centre(std::int32_t body, const Slot& slot, bool is_late) const {
    if (!is_late) return mid[body].position;
    const double delay = fmax(flight.clock[slot.i], flight.clock[slot.j]) - 0.5 * flight.terms.step;
    const Vec3 kick = mid[body].is_free() ? Vec3(flight.terms.step * flight.parameters.acceleration_of(body))
                                          : Vec3(Vec3::Zero());
    return mid[body].position + delay * (vec3(mid[body].velocity) + kick);
  }
};

template <class Real>
struct PutBallOnWall {
  WallContacts<Real> among;
  BallContacts<Real> contacts;

  SCREE_HD void operator()(std::int64_t c) const {
    using C = BallContacts<Real>;
    const std::int64_t place = among.first_place + contacts.slot[c];
    const std::int32_t entry = among.entry_of[place];
    if (entry < 0) return;
    const auto& f = contacts.fields;
    const Slot& slot = among.places[place];
    const bool on_j = among.is_on_j(slot);
    const std::int32_t wall = on_j ? slot.j : slot.i, ball = on_j ? slot.i : slot.j;
    const bool is_late = (contacts.flags[c] & flag_late_impact) != 0;
    const double arm = static_cast<double>(f.at(on_j ? C::arm_i : C::arm_j, c));
    const Vec3 point = among.centre(ball, slot, is_late) + arm * vec3(f.vector(C::normal, c));
    const Vec3 impulse = (on_j ? 1.0 : -1.0) * vec3(f.vector(C::impulse, c));
    const Vec3 lever = among.flight.bodies.period.nearest(point - among.centre(wall, slot, is_late));
    among.impulses[entry] = {impulse, lever.cross(impulse)};
  }
};

template <class Real>
struct PutPointsOnWall {
  WallContacts<Real> among;
  PointContacts<Real> contacts;

  SCREE_HD void operator()(std::int64_t c) const {
    using C = PointContacts<Real>;
    const std::int64_t place = among.first_place + contacts.slot[c];
    const std::int32_t entry = among.entry_of[place];
    if (entry < 0) return;
    const bool on_j = among.is_on_j(among.places[place]);
    WallImpulse sum;
    for (int k = 0; k < contacts.points[c]; ++k) {
      const Vec3 impulse =
          (on_j ? 1.0 : -1.0) * vec3(contacts.point_fields.vector(C::at_point(k, C::impulse), c));
      const auto at = point_at<Scalar<Real>>(contacts, c, k);
      sum = sum + WallImpulse{impulse, vec3(on_j ? at.arm_j : at.arm_i).cross(impulse)};
    }
    among.impulses[entry] = sum;
  }
};

/// Marks the loaded parts of new candidates: those whose slots remember an impulse.
template <class Real>
struct MarkBallLoads {
  AccountStage<Real> stage;
  ConstView<BallMemory<Real>> memory;
  SCREE_HD void operator()(std::int64_t place) const {
    const Slot& slot = stage.places[place];
    if (slot.i != Slot::empty && memory[place].is_loaded())
      stage.mark_loaded(slot.candidate, stage.part_of(slot));
  }
};
template <class Real>
struct MarkPointLoads {
  AccountStage<Real> stage;
  std::int64_t first_place;
  ConstView<PointMemory<Real>> memory;
  SCREE_HD void operator()(std::int64_t place) const {
    const Slot& slot = stage.places[first_place + place];
    if (slot.i != Slot::empty && memory[place].is_loaded())
      stage.mark_loaded(slot.candidate, stage.part_of(slot));
  }
};

}  // namespace scree::solver
