// scree's own solvers on a captured problem: the code that simulations run, started from zero impulses.
#include "bench/solvers/scree_contacts.hpp"
#include "bench/solvers/solver.hpp"
#include "sim/response/contacts_on_host.hpp"
#include "sim/response/direct.hpp"
#include "sim/response/sweep_plan.hpp"

#include <algorithm>
#include <cmath>

namespace scree::bench {

namespace {

class SweepsAlone : public Solver {
 public:
  SweepsAlone(const ContactProblem& scene, int block_sweeps)
      : contacts_(scene), block_sweeps_(block_sweeps) {}

  Budget budget() const override { return Budget::iterations; }

  PointVectors solve(double budget) override {
    const int count = static_cast<int>(budget);
    contacts_.reset();
    contacts_.sweep(
        {.least = count, .most = count, .block_sweeps = block_sweeps_, .tolerance = 0, .direct = false});
    return contacts_.impulses();
  }

 private:
  ScreeContacts contacts_;
  int block_sweeps_;
};

/// Solves island by island, with the limits of the accurate mode. An island that is too large for them keeps
/// zero impulses.
class DirectAlone : public Solver {
 public:
  explicit DirectAlone(const ContactProblem& scene) : contacts_(scene) {}

  Budget budget() const override { return Budget::tolerance; }

  PointVectors solve(double budget) override {
    std::int64_t solved = 0, failed = 0;
    contacts_.reset();
    contacts_.solve_islands(budget, thorough_limits, solved, failed);
    return contacts_.impulses();
  }

 private:
  ScreeContacts contacts_;
};

/// Solves as ContactSolver::solve_islands() does for bodies at rest.
class Response : public Solver {
 public:
  Response(const ContactProblem& scene, bool accurate) : contacts_(scene), accurate_(accurate) {}

  Budget budget() const override { return Budget::tolerance; }

  PointVectors solve(double budget) override {
    contacts_.reset();
    ResponseParameters parameters;
    parameters.accurate = accurate_;
    parameters.tolerance = budget;
    const SweepPlan plan =
        plan_sweeps(parameters, contacts_.contacts(), contacts_.points(), false, tolerance::heap_change);
    SweepPlan first = plan, rest = plan;
    if (plan.direct) first.most = few_sweeps;
    rest.most = std::max(plan.most - first.most, few_sweeps);
    std::int64_t solved = 0, failed = 0;
    const bool converged = contacts_.sweep(first);
    if (converged && !accurate_) return contacts_.impulses();
    if (!plan.direct && !accurate_) return contacts_.impulses();
    if (!contacts_.solve_islands(plan.tolerance, accurate_ ? thorough_limits : quick_limits, solved,
                                 failed) &&
        !contacts_.sweep(rest) && !accurate_)
      contacts_.solve_islands(plan.tolerance, long_limits, solved, failed);
    return contacts_.impulses();
  }

 private:
  ScreeContacts contacts_;
  bool accurate_;
};

}  // namespace

std::unique_ptr<Solver> make_scree_sweeps(const ContactProblem& scene, int block_sweeps) {
  return std::make_unique<SweepsAlone>(scene, block_sweeps);
}
std::unique_ptr<Solver> make_scree_direct(const ContactProblem& scene) {
  return std::make_unique<DirectAlone>(scene);
}
std::unique_ptr<Solver> make_scree_response(const ContactProblem& scene, bool accurate) {
  return std::make_unique<Response>(scene, accurate);
}

}  // namespace scree::bench
