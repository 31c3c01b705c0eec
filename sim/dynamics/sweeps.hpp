// Sweeps over coloured contacts: sequential impulses with momentum.
#pragma once

#include "core/tolerances.hpp"
#include "sim/dynamics/coloring.hpp"
#include "sim/dynamics/lanes/batches.hpp"
#include "sim/dynamics/solve_stage.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace scree {

/// How often contacts are swept.
struct SweepPlan {
  int least, most;
  int block_sweeps;  ///< over the points of a contact at each visit
  double tolerance;  ///< change of the impulses in one sweep (of their size) at which they have converged
  bool direct;       ///< islands on which sweeps creep are for the direct solver
  bool smooth;       ///< no contact has friction: no tangents
};

/// Few contacts are solved to the tolerance whatever it takes, since they cost nothing. Of a heap each visit
/// sweeps a point once, since news travels one contact per sweep however well each is solved, and the least
/// number of sweeps sees to the slow modes, of which one sweep's change tells nothing (docs/decisions/0005,
/// 0014).
inline SweepPlan plan_sweeps(const ResponseParameters& parameters, std::int64_t contacts,
                             std::int64_t all_points) {
  constexpr std::int64_t visits = 400000;  // of points in a substep
  constexpr std::int64_t fewest = 60, most = 10000;
  const bool heap = is_heap(all_points);
  SweepPlan plan{
      .least = !heap                                ? 1
               : shares_loads(contacts, all_points) ? 12
                                                    : 6,
      .most = 0,
      .block_sweeps = heap ? 1 : 4,
      .tolerance = heap && !parameters.accurate ? tolerance::heap_change : tolerance::response_change,
      .direct = !heap,
      .smooth = !parameters.friction};
  const std::int64_t points = std::max<std::int64_t>(all_points, 1);
  plan.most = static_cast<int>(std::clamp(visits / (plan.block_sweeps * points), fewest, most));
  if (parameters.block_sweeps > 0) plan.block_sweeps = parameters.block_sweeps;
  if (parameters.iterations > 0) {
    plan.most = parameters.iterations;
    plan.least = std::min(plan.least, plan.most);
  }
  if (parameters.tolerance > 0) {
    plan.tolerance = parameters.tolerance;
    plan.least = 1;
  }
  return plan;
}

inline SweepPlan plan_sweeps(const ResponseParameters& parameters, const ContactSet& set) {
  return plan_sweeps(parameters, set.contact_count(), set.point_count());
}

/// Sequential impulses over coloured contacts, with momentum: a sweep starts where the last one would be if
/// it had gone on by beta of its change. Beta is Fletcher and Reeves' ratio, of the squares of the last two
/// sweeps' own changes, and 0 where they grow, as in the nonsmooth nonlinear conjugate gradient method
/// (Silcowitz, Niebe, Erleben 2010, "A nonsmooth nonlinear conjugate gradient method for interactive contact
/// force problems", algorithm 1), which goes on by the change before that one: this takes fewer sweeps and
/// one vector less. So slow modes (tall stacks, heavy on light), on which plain sweeps creep, are overcome.
class Sweeps {
 public:
  /// The contacts of one substep, with their rows and the impulses these have. What `stage` and `batches`
  /// name must stay until the last call about them.
  void load(const SolveStage& stage, const Coloring& coloring, lanes::Batches& batches);
  /// The same contacts, listed anew.
  void look_at(const SolveStage& stage) { stage_ = stage; }

  /// Takes the impulses that the rows have now.
  void take_impulses();

  /// Gives the rows their impulses.
  void store_impulses() const {
    lanes::store_impulses(*batches_, stage_->rows, {});
    lanes::store_couples(*batches_, stage_->couples);
  }

  /// Sets the velocities to what the impulses taken, or found since, give.
  void set_velocities();
  /// Gives the solver's bodies their velocities.
  void store_velocities() const;

  bool is_free(std::int32_t body) const { return free_.view()[body].inverse_mass > 0; }

  /// Of all contacts, with the velocities as they are; and what each loses, by batch: the balls', then the
  /// others.
  lanes::Books book(Array<lanes::Losses, Host>& losses);
  /// Of each contact in one of these batches, Moved::square (J).
  lanes::Lane square_of(std::int64_t batch) const;

  /// From there on, until they converge, but at most so often. The last sweep stands as it is, so that every
  /// impulse ends inside its cone. The velocities go along, but for the rounding of every sweep. `count` goes
  /// up with each.
  bool run(const SweepPlan& plan, int most, std::int64_t& count);

 private:
  void hold_to_guides();
  struct Release;
  struct StoreVelocities;

  std::optional<SolveStage> stage_;
  lanes::Batches* batches_ = nullptr;
  Array<lanes::Body, Host> free_;      // bodies without contacts, and one that is nobody
  Array<lanes::Body, Host> bodies_;    // with them
  Array<lanes::Body, Host> last_;      // before the last sweep
  Array<lanes::Change, Host> change_;  // of each batch: the balls', then the others
};

}  // namespace scree
