// The direct solver, which solves the contact problem of one island by Newton's method where sweeps converge
// slowly.
#pragma once

#include "core/tolerances.hpp"
#include "sim/laws/contact_row.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/observe/observation.hpp"
#include "sim/response/islands.hpp"

#include <cmath>

namespace scree {

/// Limits of one direct solution, in passes of the multipliers and in multiplications.
struct DirectLimits {
  int passes;
  double products;         ///< multiplications in one factorization
  double products_in_all;  ///< multiplications in all factorizations
};
/// Limits of the first attempt: beyond these, sweeps are cheaper.
inline constexpr DirectLimits quick_limits{.passes = 16, .products = 4e5, .products_in_all = 4e7};
/// Limits of a second attempt, where neither the first one nor the sweeps have converged.
inline constexpr DirectLimits long_limits{.passes = 40, .products = 1e7, .products_in_all = 2e8};
/// Limits in the accurate mode, in which a solution is worth its time.
inline constexpr DirectLimits thorough_limits{.passes = 300, .products = 1e8, .products_in_all = 1e11};

/// Number of sweeps after which islands that have not converged count as converging slowly. Warm-started
/// contacts take one or two sweeps.
inline constexpr int few_sweeps = 10;

/// Returns the number of sweeps, of at most `most`, after which islands that converge slowly go to the direct
/// solver. It is few_sweeps. It is up to 200 where bodies of the scene move on one another (`moves`), since
/// such bodies have other contacts in the next substep, which cannot start from the solution
/// (docs/decisions/0069). Where direct solutions often fail, as in stirred heaps, it is half of `most`, but
/// no more than 200: within these nearly all islands converge, for a twentieth of the time
/// (docs/decisions/0011).
int sweeps_before_direct(int most, bool moves, const Counters& counters);

/// Returns whether a long direct solution is worth its time for large islands on which sweeps converge
/// slowly. It is if nearly all such solutions succeed in the scene: then warm starts keep their results.
/// Where everything tumbles they do not succeed (docs/decisions/0017).
bool pays_long_solution(const Counters& counters);

/// The least load of contacts and the sum of their loads, measured as ImpulseChange::size (J).
struct LoadSpread {
  double least = HUGE_VAL;  ///< least load, without contacts that carry none
  double all = 0;           ///< sum of the loads

  SCREE_HD static LoadSpread of(double load) { return {load > 0 ? load : HUGE_VAL, load}; }
  SCREE_HD friend LoadSpread operator+(const LoadSpread& a, const LoadSpread& b) {
    return {fmin(a.least, b.least), a.all + b.all};
  }
  /// Returns whether some contacts carry so little beside others that they may be unsolved when all together
  /// are solved to the tolerance. Then each island is judged by itself.
  SCREE_HD bool is_wide(double tolerance) const {
    constexpr double accuracy = tolerance::least_load_accuracy;
    return tolerance * tolerance * all > accuracy * accuracy * least;
  }
};

/// One island of the contact problem of a substep.
struct IslandProblem {
  ConstView<Contact> contacts;
  View<ContactRow> rows;     ///< arms, masses, targets and initial impulses are set
  View<SolverBody> solver;   ///< bodies, whose velocities include these impulses
  ConstView<Vec3> velocity;  ///< velocity of each body without any impulse (m/s)
  ConstView<Vec3> spin;      ///< spin of each body without any impulse (rad/s)
  const Islands& islands;
  std::int64_t island;
  ConstView<Guide> guides = {};  ///< guides of bodies that move along one axis and do not turn
};

/// Returns the natural residual of the island: the change of its rows' present impulses by the natural map.
ImpulseChange natural_residual(const IslandProblem& problem);

enum class DirectOutcome {
  not_needed,
  solved,     ///< the natural residual is within the tolerance
  not_tried,  ///< no solution was tried, since sweeps are cheaper or it would not last
  failed,     ///< not solved; the result is kept if its residual is less than the initial one
};

/// Solves an island: finds the impulses of its rows, and the velocities of its bodies with these impulses.
///
/// Coulomb's law is the associated law of the friction cone K for the velocity u + mu |u_t| n (De Saxce and
/// Feng 1998, "The bipotential method"), so that at given slips s = mu |u_t| the velocities v minimise a
/// convex function, and the slips follow by fixed-point iteration (Acary, Cadoux, Lemarechal and Malick 2011,
/// "A formulation of the linear discrete Coulomb friction problem via convex optimization"). With multipliers
/// p of the rows (augmented Lagrangian) that function is
///   |v - v*|^2_M / 2 + sum |P_K(p - r (u - (target - s) n))|^2 / (2 r),
/// where v* are the velocities without impulses. Newton's method finds its minimum, with a sparse
/// factorization over the bodies (BlockFactorization); then p <- P_K(...). The masses make its Hessian
/// definite however redundant the points of a face are.
DirectOutcome solve_directly(const IslandProblem& problem, double tolerance,
                             const DirectLimits& limits = quick_limits);

}  // namespace scree
