// The contact problem of a substep as plain data, for whoever wants to look at it or solve it again.
#pragma once

#include "sim/dynamics/contact_set.hpp"
#include "sim/inspection.hpp"

namespace scree {

/// Of contacts with their rows, as the response leaves them. `solver`: the bodies, whose velocities do not
/// matter; `velocity` and `spin`: of each without the contacts (m/s, rad/s).
ContactProblem contact_problem_of(const ContactSet& set, ConstView<SolverBody> solver,
                                  ConstView<Vec3> velocity, ConstView<Vec3> spin);

}  // namespace scree
