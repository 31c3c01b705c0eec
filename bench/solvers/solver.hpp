// The common interface of the solvers of contact problems.
#pragma once

#include "bench/solvers/problem.hpp"

#include <memory>
#include <string>
#include <vector>

namespace scree::bench {

class Solver {
 public:
  virtual ~Solver() = default;

  /// The kind of budget that solve() takes, from cheap to expensive.
  enum class Budget {
    iterations,  ///< number of iterations: 1, 2, 3...
    tolerance,   ///< tolerance at which the solver stops by itself
  };
  virtual Budget budget() const = 0;

  /// Returns impulses of the points (N s), solved from zero impulses as far as the budget allows.
  virtual PointVectors solve(double budget) = 0;
};

/// Returns the names for make_solver().
std::vector<std::string> solver_names();

/// Makes a solver, which refers to `scene` and `problem`. Throws InputError for an unknown name.
std::unique_ptr<Solver> make_solver(const std::string& name, const ContactProblem& scene,
                                    const Problem& problem);

/// Each solver has a file of its own; those of scree are in scree.cpp.
std::unique_ptr<Solver> make_nsgs(const Problem& problem);
std::unique_ptr<Solver> make_jacobi(const Problem& problem);
std::unique_ptr<Solver> make_apgd(const Problem& problem);
std::unique_ptr<Solver> make_scree_sweeps(const ContactProblem& scene, int block_sweeps);
std::unique_ptr<Solver> make_scree_direct(const ContactProblem& scene);
/// Makes the response that simulations use.
std::unique_ptr<Solver> make_scree_response(const ContactProblem& scene, bool accurate);

}  // namespace scree::bench
