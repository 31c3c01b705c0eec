// Position correction: parts overlapping bodies without touching their velocities.
#pragma once

#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/state.hpp"

namespace scree {

class PositionCorrector {
 public:
  /// A few sweeps of nonlinear Gauss-Seidel on the gaps predicted for the end of the substep: each
  /// overlapping point is parted by a share of its overlap, mass weighted, with rotation. `bodies` are at the
  /// end of the substep, the rows and batches of `set` at its midpoint. Velocities and spins stay; what that
  /// changes in energy and angular momentum is returned.
  Ledger correct(double step, const ResponseParameters& parameters, BodyView bodies,
                 const Array<SolverBody, Host>& solver, const ContactSet& set);

 private:
  struct Stage;
  struct Fly;
  struct FlyBalls;
  struct FlyPoints;
  struct Reset;
  struct PartBalls;
  struct PartPoints;
  struct Apply;
  Array<lanes::Body, Host> displacement_;  // and that of nobody
  // Of each batch, or of its points.
  Array<lanes::Lane, Host> ball_gaps_, largest_of_balls_;
  Array<lanes::Lane, Host> point_gaps_, largest_of_points_;
};

}  // namespace scree
