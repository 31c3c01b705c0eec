#include "sim/contact_problem.hpp"

namespace scree {

ContactProblem contact_problem_of(const ContactSet& set, ConstView<SolverBody> solver,
                                  ConstView<Vec3> velocity, ConstView<Vec3> spin) {
  ContactProblem problem;
  for (std::int64_t k = 0; k < solver.size(); ++k) {
    problem.bodies.push_back({solver[k].inverse_mass, solver[k].inverse_inertia, velocity[k], spin[k]});
  }
  for (const Contact& c : set.contacts.view()) {
    problem.contacts.push_back({c.i, c.j, c.first_row, c.count, c.normal, c.friction, c.balls});
  }
  for (const ContactRow& row : set.rows.view()) {
    problem.points.push_back({row.arm_i, row.arm_j, row.target, row.impulse});
  }
  return problem;
}

}  // namespace scree
