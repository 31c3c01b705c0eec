#include "bench/solvers/residual.hpp"
#include "bench/solvers/solver.hpp"

#include <cmath>

namespace scree::bench {

namespace {

/// Projected Jacobi: all points at once take a step of the natural map. The steps are so short that the
/// diagonal of their inverses bounds W, as the split masses of Tonge, Benevolenski and Voroshilov do (2012,
/// "Mass splitting for jitter-free parallel rigid body simulation"). There the bound is made from the number
/// of contacts of a body, here from the norms of the blocks in a point's row of W (Gershgorin), which needs
/// no bodies. At given slips, steps of up to twice that length converge; these are longer by the relaxation
/// factor 1.5.
class Jacobi : public Solver {
 public:
  explicit Jacobi(const Problem& problem) : problem_(problem), step_(problem.size()) {
    const BlockMatrix& w = problem.delassus;
    for (std::size_t p = 0; p < step_.size(); ++p) {
      double sum = 0;
      for (const BlockMatrix::Block* b = w.begin(p); b != w.end(p); ++b) sum += b->value.norm();
      step_[p] = relaxation / sum;
    }
  }

  Budget budget() const override { return Budget::iterations; }

  PointVectors solve(double budget) override {
    PointVectors r(problem_.size(), Vec3::Zero());
    PointVectors next(r.size());
    for (double k = 0; k < budget; ++k) {
      for (std::size_t p = 0; p < r.size(); ++p) {
        const double mu = problem_.friction[p];
        Vec3 u = problem_.delassus.times(p, r) + problem_.free_velocity[p];
        u.x() += mu * std::hypot(u.y(), u.z());
        next[p] = project_on_friction_cone(r[p] - step_[p] * u, mu);
      }
      r.swap(next);
    }
    return r;
  }

 private:
  static constexpr double relaxation = 1.5;

  const Problem& problem_;
  std::vector<double> step_;  // step of each point (kg)
};

}  // namespace

std::unique_ptr<Solver> make_jacobi(const Problem& problem) { return std::make_unique<Jacobi>(problem); }

}  // namespace scree::bench
