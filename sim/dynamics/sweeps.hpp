// Sweeps over coloured contacts: sequential impulses with conjugate directions.
#pragma once

#include "sim/dynamics/coloring.hpp"
#include "sim/dynamics/lanes/batches.hpp"
#include "sim/dynamics/solve_stage.hpp"

#include <optional>

namespace scree {

/// How often contacts are swept at most.
struct SweepPlan {
  int sweeps;
  int block_sweeps;  ///< over the points of a contact at each visit
  bool direct;       ///< islands on which sweeps creep are for the direct solver
};

/// For so many contact points: few are solved to the tolerance whatever it takes, since they cost nothing; of
/// many, a heap, the visits are bounded, since it moves on before it converges, and each visit sweeps a point
/// once, since news travels one contact per sweep however well each is solved (docs/decisions/0005).
SCREE_HD inline SweepPlan automatic_sweeps(std::int64_t points) {
  constexpr std::int64_t heap = 2500;      // points
  constexpr std::int64_t visits = 400000;  // of points in a substep
  constexpr std::int64_t fewest = 20, most = 10000;
  const bool is_heap = points >= heap;
  const int block = is_heap ? 1 : 4;
  const std::int64_t sweeps = visits / (block * (points > 0 ? points : 1));
  return {static_cast<int>(sweeps < fewest ? fewest : sweeps < most ? sweeps : most), block, !is_heap};
}

/// Sequential impulses over coloured contacts, accelerated by the nonsmooth nonlinear conjugate gradient
/// method (Silcowitz, Niebe, Erleben 2010, "A nonsmooth nonlinear conjugate gradient method for interactive
/// contact force problems", algorithm 1): a sweep's change of the impulses is taken as minus a gradient, and
/// Fletcher-Reeves directions on it overcome the slow modes (tall stacks, heavy on light) on which plain
/// sweeps creep.
class Sweeps {
 public:
  /// The contacts of one substep, with their rows. What `stage` and `batches` name must stay until the last
  /// call about them.
  void load(const SolveStage& stage, const Coloring& coloring, lanes::Batches& batches);

  /// Takes the impulses that the rows have.
  void take_impulses();

  /// Sets the velocities to what the impulses taken, or found since, give.
  void set_velocities();

  /// From there on, until they converge, but at most so often. The last sweep stands as it is, so that every
  /// impulse ends inside its cone. `count` goes up with each sweep.
  bool run(int most, int block_sweeps, double tolerance, std::int64_t& count);

 private:
  struct Release;
  struct StoreVelocities;

  std::optional<SolveStage> stage_;
  lanes::Batches* batches_ = nullptr;
  Array<lanes::Body, Host> bodies_;     // and one that is nobody
  Array<lanes::Body, Host> last_;       // bodies after the last sweep
  Array<lanes::Body, Host> direction_;  // of theirs
  Array<lanes::Change, Host> change_;   // of each batch: the balls', then the others
};

}  // namespace scree
