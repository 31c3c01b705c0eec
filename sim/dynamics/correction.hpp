// Position correction: parts overlapping bodies without touching their velocities.
#pragma once

#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/state.hpp"

namespace scree {

class PositionCorrector {
 public:
  /// A few sweeps of nonlinear Gauss-Seidel on the gaps predicted for the end of the substep: each
  /// overlapping point is parted by a share of its overlap, mass weighted, with rotation. `bodies` are at the
  /// end of the substep, the rows of `set` at its midpoint. Velocities and spins stay; what that changes in
  /// energy and angular momentum is returned.
  Ledger correct(double step, const ResponseParameters& parameters, BodyView bodies,
                 const Array<SolverBody, Host>& solver, ContactSet& set);

 private:
  /// Displacement of one body: of its centre (m), and its turn (rad).
  struct Displacement {
    Vec3 linear = Vec3::Zero();
    Vec3 angular = Vec3::Zero();
  };
  struct Stage;
  struct Fly;
  struct Sweep;
  struct Apply;
  Array<double, Host> flown_gap_;
  Array<Displacement, Host> displacement_;
};

}  // namespace scree
