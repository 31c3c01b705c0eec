// The contacts of a substep on Host in double precision, for inspection and for the direct solver.
#pragma once

#include "core/bodies.hpp"
#include "sim/contacts/contact_store.hpp"
#include "sim/contacts/rolling_visits.hpp"
#include "sim/contacts/slots.hpp"
#include "sim/contacts/sweeps.hpp"
#include "sim/observe/inspection.hpp"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace scree::solver {

/// Copies on Host of the arrays that an Inspection needs from Device.
template <class Real>
struct ContactsFromDevice {
  std::vector<Slot> places;
  std::vector<BodyNumber> number;
  std::vector<BodyRecord<Real>> free;
  ContactStore<Host, Real> store;
  Array<Real, Host> ball_rolling, point_rolling;
};

/// A view of the contacts on Host: of the solver's own arrays, or of copies of those on Device.
template <class Real>
struct Inspection {
  ConstView<Slot> places;
  ConstView<BodyNumber> number;      ///< number of each body, by place
  ConstView<BodyRecord<Real>> free;  ///< bodies of the solver with their velocities without contacts
  ContactStore<Host, Real>* contacts = nullptr;
  RollingFields<Real> ball_rolling, point_rolling;
  bool rolls = false;
  std::int64_t first_wall_point = 0;                      ///< index of the first wall point in `free`
  std::int64_t first_part = 0;                            ///< index after the last wall point in `free`
  double step = 0;                                        ///< length of the substep (s)
  std::int64_t first_place = 0;                           ///< place of the first slot that is not of balls
  std::shared_ptr<ContactsFromDevice<Real>> from_device;  ///< null where the contacts are on Host
};

struct SeenPoint {
  Vec3 arm_i, arm_j;
  double target;
  Vec3 impulse;
};

struct SeenContact {
  Slot slot;
  std::int32_t i, j;   ///< indices of bodies of the solver: bodies, or points of walls that turn
  std::int64_t place;  ///< place of the contact among those of its kind
  Vec3 normal;
  double friction;
  double rolling_reach;  ///< largest couple against rolling, per normal impulse (m)
  Vec3 couple;           ///< couple on j (N m s)
  bool balls;
  std::int32_t count;  ///< number of its points
  SeenPoint points[Manifold::max_points];
  Mat3 inertia_i, inertia_j;  ///< inverse inertias, world frame; zero for balls

  Vec3 impulse() const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < count; ++k) sum += points[k].impulse;
    return sum;
  }
};

/// A contact that has no points yet and does not roll.
inline SeenContact no_contact() {
  SeenContact contact{};
  contact.couple.setZero();
  contact.inertia_i.setZero();
  contact.inertia_j.setZero();
  return contact;
}

template <class Real>
void set_rolling(bool rolls, const RollingFields<Real>& rolling, std::int64_t c, SeenContact& contact) {
  using R = RollingFields<Real>;
  if (!rolls) return;
  contact.rolling_reach = static_cast<double>(rolling.fields.at(R::reach, c));
  contact.couple = vec3(rolling.fields.vector(R::couple, c));
}

/// Returns contact c of those of balls.
template <class Real>
SeenContact ball_contact(Inspection<Real>& seen, const BallContacts<Real>& balls, std::int64_t c) {
  using B = BallContacts<Real>;
  const auto number = [](Real value) { return static_cast<double>(value); };
  const auto whole = [&](std::int32_t body, std::int32_t end) {
    return end >= seen.first_wall_point && end < seen.first_part ? end : body;
  };
  const auto& f = balls.fields;
  SeenContact contact = no_contact();
  contact.balls = true;
  contact.slot = seen.places[balls.slot[c]];
  contact.i = whole(contact.slot.i, contact.slot.end_i);
  contact.j = whole(contact.slot.j, contact.slot.end_j);
  contact.place = c;
  contact.normal = vec3(f.vector(B::normal, c));
  contact.friction = number(f.at(B::friction, c));
  contact.count = 1;
  contact.points[0] = {number(f.at(B::arm_i, c)) * contact.normal, number(f.at(B::arm_j, c)) * contact.normal,
                       number(f.at(B::target, c)), vec3(f.vector(B::impulse, c))};
  set_rolling(seen.rolls, seen.ball_rolling, c, contact);
  return contact;
}

/// Returns the inverse inertia of a body at contact c of those of points; its six numbers begin with field
/// `first`. A part of a hub (`end`) has less mass than the body, which is the one returned.
template <class Real>
Mat3 inertia_at(Inspection<Real>& seen, const PointContacts<Real>& points, std::int64_t c, std::int32_t body,
                std::int32_t end, int first) {
  const auto at = [&](int e) { return static_cast<double>(points.fields.at(first + e, c)); };
  Mat3 inertia;
  inertia << at(0), at(3), at(4), at(3), at(1), at(5), at(4), at(5), at(2);
  if (body == end || inertia.isZero(0)) return inertia;
  const auto inverse_mass = [&](std::int32_t k) { return static_cast<double>(seen.free[k].inverse_mass); };
  return Mat3(inverse_mass(body) / inverse_mass(end) * inertia);
}

/// Returns contact c of those that may have several points.
template <class Real>
SeenContact point_contact(Inspection<Real>& seen, const PointContacts<Real>& points, std::int64_t c) {
  using P = PointContacts<Real>;
  const auto number = [](Real value) { return static_cast<double>(value); };
  const auto& f = points.point_fields;
  SeenContact contact = no_contact();
  contact.slot = seen.places[seen.first_place + points.slot[c]];
  contact.i = contact.slot.i;
  contact.j = contact.slot.j;
  contact.place = c;
  contact.normal = vec3(points.fields.vector(P::normal, c));
  contact.friction = number(points.fields.at(P::friction, c));
  contact.count = points.points[c];
  for (int k = 0; k < contact.count; ++k) {
    contact.points[k] = {
        vec3(f.vector(P::at_point(k, P::arm_i), c)), vec3(f.vector(P::at_point(k, P::arm_j), c)),
        number(f.at(P::at_point(k, P::target), c)), vec3(f.vector(P::at_point(k, P::impulse), c))};
  }
  contact.inertia_i = inertia_at(seen, points, c, contact.slot.i, contact.slot.end_i, P::inertia_i);
  contact.inertia_j = inertia_at(seen, points, c, contact.slot.j, contact.slot.end_j, P::inertia_j);
  set_rolling(seen.rolls, seen.point_rolling, c, contact);
  return contact;
}

/// Calls visit(contact) for each contact in the order of their places, first for those of balls.
template <class Real, class Visit>
void for_each_contact(Inspection<Real>& seen, Visit visit) {
  const BallContacts<Real> balls = seen.contacts->balls();
  for (std::int64_t c = 0; c < balls.slot.size(); ++c) {
    if (balls.slot[c] == Slot::empty) continue;
    const SeenContact contact = ball_contact(seen, balls, c);
    visit(contact);
  }
  const PointContacts<Real> points = seen.contacts->points();
  for (std::int64_t c = 0; c < points.slot.size(); ++c) {
    if (points.slot[c] == Slot::empty) continue;
    const SeenContact contact = point_contact(seen, points, c);
    visit(contact);
  }
}

/// Returns the contact problem of the substep. `bodies` are in the same order as the solver's.
template <class Real>
ContactProblem problem_of(Inspection<Real>& seen, const BodyTable& bodies);

/// Returns the forces of the contacts that carried one.
template <class Real>
std::vector<ContactForce> forces_of(Inspection<Real>& seen, const BodyTable& bodies);

}  // namespace scree::solver
