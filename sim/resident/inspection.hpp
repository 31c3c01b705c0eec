// The contacts of a substep as they are shown: on Host, body by body.
#pragma once

#include "core/bodies.hpp"
#include "sim/inspection.hpp"
#include "sim/resident/contact_store.hpp"
#include "sim/resident/sweeps.hpp"

#include <cstdint>
#include <vector>

namespace scree::resident {

/// Contacts, where they have been brought to Host.
template <class Real>
struct Inspection {
  std::vector<Slot> places;
  std::vector<BodyRecord<Real>> free;  ///< bodies of the solver as they would be without contacts
  ContactStore<Host, Real> contacts;
  std::int64_t first_wall_point = 0;  ///< among the bodies of the solver
  double step = 0;                    ///< length of the substep (s)
};

struct SeenPoint {
  Vec3 arm_i, arm_j;
  double target;
  Vec3 impulse;
};

struct SeenContact {
  Slot slot;
  std::int32_t i, j;   ///< bodies, or points of walls that turn
  std::int64_t place;  ///< among those of its kind
  Vec3 normal;
  double friction;
  bool balls;
  std::vector<SeenPoint> points;
  Mat3 inertia_i, inertia_j;  ///< inverse, world frame, unless it is of balls
};

/// visit(contact) for all of them, in the order of their places, those of balls first.
template <class Real, class Visit>
void for_each_contact(Inspection<Real>& seen, Visit visit) {
  using B = BallContacts<Real>;
  using P = PointContacts<Real>;
  const auto number = [](Real value) { return static_cast<double>(value); };
  const B balls = seen.contacts.balls();
  const auto slot_of = [&](std::int64_t first, std::int64_t c, std::uint8_t slot) {
    return seen.places[static_cast<std::size_t>(first + c - c % 256 + slot)];
  };
  const auto whole = [&](std::int32_t body, std::int32_t end) {
    return end >= seen.first_wall_point ? end : body;
  };
  for (std::int64_t c = 0; c < seen.contacts.ball_places(); ++c) {
    if (!has_contact(seen.contacts.ball_tiles().data(), c)) continue;
    const auto& f = balls.fields;
    const Vec3 normal = vec3(f.vector(B::normal, c));
    const Slot slot = slot_of(0, c, balls.slot[c]);
    visit(SeenContact{slot,
                      whole(slot.i, slot.end_i),
                      whole(slot.j, slot.end_j),
                      c,
                      normal,
                      number(f.at(B::friction, c)),
                      true,
                      {{number(f.at(B::arm_i, c)) * normal, number(f.at(B::arm_j, c)) * normal,
                        number(f.at(B::target, c)), vec3(f.vector(B::impulse, c))}},
                      Mat3::Zero(),
                      Mat3::Zero()});
  }
  const P points = seen.contacts.points();
  for (std::int64_t c = 0; c < seen.contacts.point_places(); ++c) {
    if (!has_contact(seen.contacts.point_tiles().data(), c)) continue;
    const Slot slot = slot_of(seen.contacts.ball_places(), c, points.slot[c]);
    SeenContact contact{slot,
                        slot.i,
                        slot.j,
                        c,
                        vec3(points.fields.vector(P::normal, c)),
                        number(points.fields.at(P::friction, c)),
                        false,
                        {},
                        Mat3::Zero(),
                        Mat3::Zero()};
    const auto& f = points.point_fields;
    for (int k = 0; k < points.points[c]; ++k) {
      contact.points.push_back(
          {vec3(f.vector(P::at_point(k, P::arm_i), c)), vec3(f.vector(P::at_point(k, P::arm_j), c)),
           number(f.at(P::at_point(k, P::target), c)), vec3(f.vector(P::at_point(k, P::impulse), c))});
    }
    const auto whole_inertia = [&](std::int32_t body, std::int32_t end, int first) {
      const auto at = [&](int e) { return number(points.fields.at(first + e, c)); };
      Mat3 inertia;
      inertia << at(0), at(3), at(4), at(3), at(1), at(5), at(4), at(5), at(2);
      if (body == end || inertia.isZero(0)) return inertia;
      const auto inverse_mass = [&](std::int32_t k) {
        return number(seen.free[static_cast<std::size_t>(k)].inverse_mass);
      };
      return Mat3(inverse_mass(body) / inverse_mass(end) * inertia);
    };
    contact.inertia_i = whole_inertia(slot.i, slot.end_i, P::inertia_i);
    contact.inertia_j = whole_inertia(slot.j, slot.end_j, P::inertia_j);
    visit(contact);
  }
}

/// `bodies` lie as they do in the space.
template <class Real>
ContactProblem problem_of(Inspection<Real>& seen, const BodyTable& bodies);

/// Of those that carried a force.
template <class Real>
std::vector<ContactForce> forces_of(Inspection<Real>& seen, const BodyTable& bodies);

}  // namespace scree::resident
