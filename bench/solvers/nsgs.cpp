#include "bench/solvers/local_problem.hpp"
#include "bench/solvers/solver.hpp"

namespace scree::bench {

namespace {

/// Nonsmooth Gauss-Seidel (Jourdan, Alart and Jean 1998, "A Gauss-Seidel like algorithm to solve frictional
/// contact problems"). It visits the points in order, and solves each point's problem exactly.
class Nsgs : public Solver {
 public:
  explicit Nsgs(const Problem& problem) : problem_(problem) {
    for (std::size_t p = 0; p < problem.size(); ++p)
      local_.emplace_back(problem.delassus.diagonal(p), problem.friction[p]);
  }

  Budget budget() const override { return Budget::iterations; }

  PointVectors solve(double budget) override {
    const BlockMatrix& w = problem_.delassus;
    PointVectors r(problem_.size(), Vec3::Zero());
    for (double k = 0; k < budget; ++k) {
      for (std::size_t p = 0; p < r.size(); ++p) {
        const Vec3 others = w.times(p, r) - w.diagonal(p) * r[p];
        r[p] = local_[p].solve(others + problem_.free_velocity[p]);
      }
    }
    return r;
  }

 private:
  const Problem& problem_;
  std::vector<LocalProblem> local_;
};

}  // namespace

std::unique_ptr<Solver> make_nsgs(const Problem& problem) { return std::make_unique<Nsgs>(problem); }

}  // namespace scree::bench
