#include "sim/resident/inspection.hpp"

#include "sim/dynamics/rotation.hpp"
#include "sim/resident/sweeps.hpp"

namespace scree::resident {

namespace {

struct SeenPoint {
  Vec3 arm_i, arm_j;
  double target;
  Vec3 impulse;
};

struct SeenContact {
  Slot slot;
  Vec3 normal;
  double friction;
  bool balls;
  std::vector<SeenPoint> points;
};

/// visit(contact) for all of them.
template <class Real, class Visit>
void for_each_contact(Inspection<Real>& seen, Visit visit) {
  using B = BallContacts<Real>;
  using P = PointContacts<Real>;
  const auto number = [](Real value) { return static_cast<double>(value); };
  const B balls = seen.contacts.balls();
  const auto slot_of = [&](std::int64_t first, std::int64_t c, std::uint8_t slot) {
    return seen.places[static_cast<std::size_t>(first + c - c % 256 + slot)];
  };
  for (std::int64_t c = 0; c < seen.contacts.ball_places(); ++c) {
    if (!has_contact(seen.contacts.ball_tiles().data(), c)) continue;
    const Fields<Real>& f = balls.fields;
    const Vec3 normal = vec3(f.vector(B::normal, c));
    visit(SeenContact{slot_of(0, c, balls.slot[c]),
                      normal,
                      number(f.at(B::friction, c)),
                      true,
                      {{number(f.at(B::arm_i, c)) * normal, number(f.at(B::arm_j, c)) * normal,
                        number(f.at(B::target, c)), vec3(f.vector(B::impulse, c))}}});
  }
  const P points = seen.contacts.points();
  for (std::int64_t c = 0; c < seen.contacts.point_places(); ++c) {
    if (!has_contact(seen.contacts.point_tiles().data(), c)) continue;
    SeenContact contact{slot_of(seen.contacts.ball_places(), c, points.slot[c]),
                        vec3(points.fields.vector(P::normal, c)),
                        number(points.fields.at(P::friction, c)),
                        false,
                        {}};
    const Fields<Real>& f = points.point_fields;
    for (int k = 0; k < points.points[c]; ++k) {
      contact.points.push_back(
          {vec3(f.vector(P::at_point(k, P::arm_i), c)), vec3(f.vector(P::at_point(k, P::arm_j), c)),
           number(f.at(P::at_point(k, P::target), c)), vec3(f.vector(P::at_point(k, P::impulse), c))});
    }
    visit(contact);
  }
}

}  // namespace

template <class Real>
ContactProblem problem_of(Inspection<Real>& seen, const BodyTable& bodies) {
  ContactProblem problem;
  if (seen.step == 0) return problem;
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    problem.bodies.push_back({bodies.inverse_mass[k],
                              world_inverse_inertia(bodies.orientation[k], bodies.inverse_inertia[k]),
                              vec3(seen.free[k].velocity), vec3(seen.free[k].spin)});
  }
  for_each_contact(seen, [&](const SeenContact& c) {
    problem.contacts.push_back({c.slot.i, c.slot.j, static_cast<std::int64_t>(problem.points.size()),
                                static_cast<std::int32_t>(c.points.size()), c.normal, c.friction, c.balls});
    for (const SeenPoint& p : c.points) problem.points.push_back({p.arm_i, p.arm_j, p.target, p.impulse});
  });
  return problem;
}

template <class Real>
std::vector<ContactForce> forces_of(Inspection<Real>& seen, const BodyTable& bodies) {
  std::vector<ContactForce> forces;
  for_each_contact(seen, [&](const SeenContact& c) {
    Vec3 impulse = Vec3::Zero();
    for (const SeenPoint& p : c.points) impulse += p.impulse;
    if (impulse.isZero(0)) return;
    // From the body that moves freely: the centre of a plane is nowhere near.
    const auto i = static_cast<std::size_t>(c.slot.i), j = static_cast<std::size_t>(c.slot.j);
    const bool from_j = bodies.mobility[j] == Mobility::free;
    Vec3 arm = Vec3::Zero();
    for (const SeenPoint& p : c.points)
      arm += (from_j ? p.arm_j : p.arm_i) / static_cast<double>(c.points.size());
    forces.push_back({c.slot.i, c.slot.j, impulse / seen.step, bodies.position[from_j ? j : i] + arm});
  });
  return forces;
}

template ContactProblem problem_of(Inspection<double>&, const BodyTable&);
template ContactProblem problem_of(Inspection<float>&, const BodyTable&);
template std::vector<ContactForce> forces_of(Inspection<double>&, const BodyTable&);
template std::vector<ContactForce> forces_of(Inspection<float>&, const BodyTable&);

}  // namespace scree::resident
