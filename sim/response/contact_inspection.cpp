#include "sim/response/contact_inspection.hpp"

#include "sim/laws/rotation.hpp"

namespace scree::solver {

template <class Real>
ContactProblem problem_of(Inspection<Real>& seen, const BodyTable& bodies) {
  ContactProblem problem;
  if (seen.step == 0) return problem;
  const auto number_of = [&bodies](std::int32_t place) {
    return static_cast<std::int32_t>(bodies.id[static_cast<std::size_t>(place)]);
  };
  problem.bodies.resize(bodies.position.size());
  for (std::size_t k = 0; k < bodies.position.size(); ++k) {
    // Rounding makes the two triangles of the inertia differ in their last bits, so one is used for both.
    const Mat3 inertia = world_inverse_inertia(bodies.orientation[k], bodies.inverse_inertia[k]);
    problem.bodies[index_of(bodies.id[k])] = {bodies.inverse_mass[k],
                                              Mat3(inertia.selfadjointView<Eigen::Lower>()),
                                              vec3(seen.free[static_cast<std::int64_t>(k)].velocity),
                                              vec3(seen.free[static_cast<std::int64_t>(k)].spin)};
  }
  // The points of walls that turn follow after the bodies.
  const auto first = static_cast<std::int32_t>(seen.first_wall_point - std::ssize(bodies.position));
  for (std::int64_t k = seen.first_wall_point; k < seen.first_part; ++k)
    problem.bodies.push_back({0, Mat3::Zero(), vec3(seen.free[k].velocity), Vec3::Zero()});
  const auto number = [&](std::int32_t k) { return k >= seen.first_wall_point ? k - first : number_of(k); };
  for_each_contact(seen, [&](const SeenContact& c) {
    problem.contacts.push_back({number(c.i), number(c.j), static_cast<std::int64_t>(problem.points.size()),
                                c.count, c.normal, c.friction, c.balls});
    for (int k = 0; k < c.count; ++k)
      problem.points.push_back(
          {c.points[k].arm_i, c.points[k].arm_j, c.points[k].target, c.points[k].impulse});
  });
  return problem;
}

template <class Real>
std::vector<ContactForce> forces_of(Inspection<Real>& seen, const BodyTable& bodies) {
  std::vector<ContactForce> forces;
  if (seen.step == 0) return forces;
  for_each_contact(seen, [&](const SeenContact& c) {
    const Vec3 impulse = c.impulse();
    if (impulse.isZero(0)) return;
    // The point is found from a free body, since the centre of a plane may be far away.
    const auto i = static_cast<std::size_t>(c.slot.i), j = static_cast<std::size_t>(c.slot.j);
    const bool from_j = bodies.mobility[j] == Mobility::free;
    Vec3 arm = Vec3::Zero();
    for (int k = 0; k < c.count; ++k) arm += (from_j ? c.points[k].arm_j : c.points[k].arm_i) / c.count;
    forces.push_back({static_cast<std::int32_t>(bodies.id[i]), static_cast<std::int32_t>(bodies.id[j]),
                      impulse / seen.step, bodies.position[from_j ? j : i] + arm});
  });
  return forces;
}

template ContactProblem problem_of(Inspection<double>&, const BodyTable&);
template ContactProblem problem_of(Inspection<float>&, const BodyTable&);
template std::vector<ContactForce> forces_of(Inspection<double>&, const BodyTable&);
template std::vector<ContactForce> forces_of(Inspection<float>&, const BodyTable&);

}  // namespace scree::solver
