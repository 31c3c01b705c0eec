// Position correction: parts overlapping bodies without touching their velocities.
#pragma once

#include "sim/dynamics/contact_set.hpp"
#include "sim/dynamics/state.hpp"

namespace scree {

class PositionCorrector {
 public:
  /// Sweeps of nonlinear Gauss-Seidel on the gaps predicted for the end of the substep, until the deepest
  /// overlap is next to none, or the bound is hit: each overlapping point is parted by a share of its
  /// overlap, mass weighted, with rotation. `bodies` are at the end of the substep, the rows and batches of
  /// `set` at its midpoint. Velocities and spins stay; what that changes in energy and angular momentum is
  /// returned.
  Ledger correct(double step, const ResponseParameters& parameters, BodyView bodies,
                 const Array<SolverBody, Host>& solver, ContactSet& set);

  /// Deepest overlap that the last call found (of the smaller smallest_size).
  double overlap() const { return overlap_; }

 private:
  struct Stage;
  struct FlyBalls;
  struct FlyPoints;
  struct LoadBody;
  struct Reset;
  struct PartBalls;
  struct PartPoints;
  struct LoadDepth;
  struct Apply;
  Array<lanes::Body, Host> displacement_;  // and that of nobody
  Array<lanes::InertiaRoot, Host> roots_;  // likewise
  double overlap_ = 0;
  Array<double, Host> deepest_;  // overlap in the last sweep, in units of the cap; balls first
};

}  // namespace scree
