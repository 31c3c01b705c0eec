// The direct solver: the contact problem of one island by Newton's method, where sweeps creep.
#pragma once

#include "core/tolerances.hpp"
#include "sim/laws/contact_row.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/observe/observation.hpp"
#include "sim/response/islands.hpp"

#include <cmath>

namespace scree {

/// What a solution may take.
struct DirectLimits {
  int passes;
  double products;         ///< of one factorization
  double products_in_all;  ///< of all of them
};
/// Beyond these, sweeps are cheaper.
inline constexpr DirectLimits quick_limits{.passes = 16, .products = 4e5, .products_in_all = 2e7};
/// Where sweeps have not got there.
inline constexpr DirectLimits patient_limits{.passes = 40, .products = 1e7, .products_in_all = 1e8};
/// Where a solution is worth its time.
inline constexpr DirectLimits thorough_limits{.passes = 300, .products = 1e8, .products_in_all = 1e11};

/// Sweeps after which what has not converged creeps. Warm-started contacts take one or two.
inline constexpr int few_sweeps = 10;

/// Of at most so many sweeps those after which islands that creep go to the direct solver: few; where
/// solutions often fail, as in stirred heaps, half of them or 200, in which nearly all converge for a
/// twentieth of the time (docs/decisions/0011).
int sweeps_before_direct(int most, const Counters& counters);

/// Large islands that creep are worth a long direct solution, if nearly all succeed in the scene: then warm
/// starts keep what was found. Where everything tumbles they do not (docs/decisions/0017).
bool pays_long_solution(const Counters& counters);

/// Loads of contacts, as ImpulseChange::size (J).
struct LoadSpread {
  double least = HUGE_VAL;  ///< but for those without
  double all = 0;

  SCREE_HD static LoadSpread of(double load) { return {load > 0 ? load : HUGE_VAL, load}; }
  SCREE_HD friend LoadSpread operator+(const LoadSpread& a, const LoadSpread& b) {
    return {fmin(a.least, b.least), a.all + b.all};
  }
  /// Whether some carry so little beside others that to solve all together to the tolerance leaves them
  /// unsolved: then each island is looked at by itself.
  SCREE_HD bool is_wide(double tolerance) const {
    constexpr double accuracy = tolerance::least_load_accuracy;
    return tolerance * tolerance * all > accuracy * accuracy * least;
  }
};

/// One island of the contact problem of a substep.
struct IslandProblem {
  ConstView<Contact> contacts;
  View<ContactRow> rows;     ///< with their arms, masses, targets, and impulses to start from
  View<SolverBody> solver;   ///< velocities with these impulses
  ConstView<Vec3> velocity;  ///< of each body without any impulse (m/s)
  ConstView<Vec3> spin;
  const Islands& islands;
  std::int64_t island;
  ConstView<Guide> guides = {};  ///< bodies that move along one axis alone, and do not turn
};

/// What the natural map changes in the impulses of the island's rows, as they are.
ImpulseChange natural_residual(const IslandProblem& problem);

enum class DirectOutcome {
  not_needed,
  solved,     ///< to the tolerance, in the natural residual
  too_large,  ///< nothing was tried: sweeps are cheaper
  failed,     ///< what was found is kept if it is nearer to a solution than what was there
};

/// Solves an island: the impulses of its rows, and the velocities of its bodies with them.
///
/// Coulomb's law is the associated law of the friction cone K for the velocity u + mu |u_t| n (De Saxce and
/// Feng 1998, "The bipotential method"), so that at given slips s = mu |u_t| the velocities v minimise a
/// convex function, and the slips follow by fixed-point iteration (Acary, Cadoux, Lemarechal and Malick 2011,
/// "A formulation of the linear discrete Coulomb friction problem via convex optimization"). With multipliers
/// p of the rows (augmented Lagrangian) that function is
///   |v - v*|^2_M / 2 + sum |P_K(p - r (u - (target - s) n))|^2 / (2 r),
/// v* the velocities without impulses. Newton's method takes it to its minimum, with a sparse Cholesky
/// factorization over the bodies; then p <- P_K(...). The masses make it definite however redundant the
/// points of a face are.
DirectOutcome solve_directly(const IslandProblem& problem, double tolerance,
                             const DirectLimits& limits = quick_limits);

}  // namespace scree
