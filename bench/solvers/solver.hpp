// Solvers of contact problems behind one interface.
#pragma once

#include "bench/solvers/problem.hpp"

#include <memory>
#include <string>
#include <vector>

namespace scree::bench {

class Solver {
 public:
  virtual ~Solver() = default;

  /// What solve() takes, from cheap to dear.
  enum class Budget {
    iterations,  ///< 1, 2, 3...
    tolerance,   ///< at which it stops by itself
  };
  virtual Budget budget() const = 0;

  /// Impulses of the points (N s) from none at all, as far as the budget takes them.
  virtual PointVectors solve(double budget) = 0;
};

/// Names for make_solver().
std::vector<std::string> solver_names();

/// Sets a solver up. It refers to both. Throws InputError for an unknown name.
std::unique_ptr<Solver> make_solver(const std::string& name, const ContactProblem& scene,
                                    const Problem& problem);

/// One for each file.
std::unique_ptr<Solver> make_nsgs(const Problem& problem);
std::unique_ptr<Solver> make_jacobi(const Problem& problem);
std::unique_ptr<Solver> make_apgd(const Problem& problem);
std::unique_ptr<Solver> make_scree_sweeps(const ContactProblem& scene, int block_sweeps);
std::unique_ptr<Solver> make_scree_direct(const ContactProblem& scene);
/// The response as simulations have it.
std::unique_ptr<Solver> make_scree_response(const ContactProblem& scene, bool accurate);

}  // namespace scree::bench
