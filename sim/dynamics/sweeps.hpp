// Sweeps over coloured contacts: sequential impulses with conjugate directions.
#pragma once

#include "sim/dynamics/coloring.hpp"
#include "sim/dynamics/solve_stage.hpp"

namespace scree {

/// How often contacts are swept at most.
struct SweepPlan {
  int sweeps;
  int block_sweeps;  ///< over the points of a contact at each visit
  bool direct;       ///< islands on which sweeps creep are for the direct solver
};

/// For so many contact points: few are solved to the tolerance whatever it takes, since they cost nothing; of
/// many, a heap, the sweeps are bounded, since it moves on before it converges, and visit each point once,
/// since news travels one contact per sweep however well each is solved (docs/decisions/0005).
SCREE_HD inline SweepPlan automatic_sweeps(std::int64_t points) {
  constexpr std::int64_t heap = 2500;      // points
  constexpr std::int64_t visits = 400000;  // of points in a substep
  constexpr int fewest = 20, most = 10000;
  if (points >= heap) return {fewest, 1, false};
  constexpr int block = 4;
  const std::int64_t sweeps = visits / (block * (points > 0 ? points : 1));
  return {static_cast<int>(sweeps < most ? sweeps : most), block, true};
}

/// Sequential impulses over coloured contacts, accelerated by the nonsmooth nonlinear conjugate gradient
/// method (Silcowitz, Niebe, Erleben 2010, "A nonsmooth nonlinear conjugate gradient method for interactive
/// contact force problems", algorithm 1): a sweep's change of the impulses is taken as minus a gradient, and
/// Fletcher-Reeves directions on it overcome the slow modes (tall stacks, heavy on light) on which plain
/// sweeps creep.
class Sweeps {
 public:
  /// Of one substep. `count`: goes up with each sweep.
  Sweeps(const SolveStage& stage, const Coloring& coloring, int block_sweeps, double tolerance,
         std::int64_t& count)
      : stage_(stage),
        coloring_(coloring),
        block_sweeps_(block_sweeps),
        tolerance_(tolerance),
        count_(count) {}

  /// Sets the velocities to what the impulses give, and starts the directions anew.
  void start();

  void set_velocities();

  /// From a start on, until they converge, but at most so often. The last sweep stands as it is, so that
  /// every impulse ends inside its cone.
  bool run(int most);

 private:
  const SolveStage& stage_;
  const Coloring& coloring_;
  int block_sweeps_;
  double tolerance_;
  std::int64_t& count_;
};

}  // namespace scree
