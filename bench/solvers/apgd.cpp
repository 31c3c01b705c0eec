#include "bench/solvers/residual.hpp"
#include "bench/solvers/solver.hpp"

#include <algorithm>
#include <cmath>

namespace scree::bench {

namespace {

/// Accelerated projected gradient descent (Mazhar, Heyn, Negrut and Tasora 2015, "Using Nesterov's method to
/// accelerate multibody dynamics with friction and contact"). It solves
///   min x.W x / 2 + (q + s n).x, x in K,
/// at given slips s = mu |u_t|. The slips are found by fixed-point iteration (Acary, Cadoux, Lemarechal and
/// Malick 2011, "A formulation of the linear discrete Coulomb friction problem via convex optimization"):
/// they are updated each time the gradient map has come down to a share of its value just after the last
/// update. This code departs from the papers in three points. The variables are x = sqrt(stiffness) r, by
/// point, so that heavy and light bodies have equal weight. The products with W are kept, so that an
/// iteration computes only one. The step is never shorter than Gershgorin's bound requires.
class Apgd : public Solver {
 public:
  explicit Apgd(const Problem& problem) : problem_(problem), scale_(stiffness_of(problem)) {
    for (double& scale : scale_) scale = 1 / std::sqrt(scale);
    const BlockMatrix& w = problem.delassus;
    for (std::size_t p = 0; p < scale_.size(); ++p) {
      double sum = 0;
      for (const BlockMatrix::Block* b = w.begin(p); b != w.end(p); ++b)
        sum += scale_[static_cast<std::size_t>(b->column)] * b->value.norm();
      most_curvature_ = std::max(most_curvature_, scale_[p] * sum);
    }
  }

  Budget budget() const override { return Budget::iterations; }

  PointVectors solve(double budget) override {
    left_ = budget;
    x_.assign(problem_.size(), Vec3::Zero());
    wx_ = x_;
    slope_ = x_;
    curvature_ = 1;
    while (left_ > 0) descend(set_slips());
    PointVectors r(x_.size());
    for (std::size_t p = 0; p < r.size(); ++p) r[p] = scale_[p] * x_[p];
    return r;
  }

 private:
  static constexpr double share = 0.1;

  /// Sets the slips of x. Returns the norm of the change that the natural map then makes.
  double set_slips() {
    double square = 0;
    for (std::size_t p = 0; p < x_.size(); ++p) {
      const double mu = problem_.friction[p];
      slope_[p] = scale_[p] * problem_.free_velocity[p];
      const Vec3 u = wx_[p] + slope_[p];
      slope_[p].x() += mu * std::hypot(u.y(), u.z());
      square += (x_[p] - project_on_friction_cone(x_[p] - wx_[p] - slope_[p], mu)).squaredNorm();
    }
    return std::sqrt(square);
  }

  void multiply(const PointVectors& x, PointVectors& wx) {
    scaled_.resize(x.size());
    for (std::size_t p = 0; p < x.size(); ++p) scaled_[p] = scale_[p] * x[p];
    for (std::size_t p = 0; p < x.size(); ++p) wx[p] = scale_[p] * problem_.delassus.times(p, scaled_);
    --left_;
  }

  /// Sets next_ and its product with W from y_, with a step as long as the function's curvature along it
  /// allows.
  void step() {
    for (;;) {
      double square = 0;
      for (std::size_t p = 0; p < x_.size(); ++p) {
        next_[p] = project_on_friction_cone(y_[p] - (wy_[p] + slope_[p]) / curvature_, problem_.friction[p]);
        square += (next_[p] - y_[p]).squaredNorm();
      }
      multiply(next_, wnext_);
      double along = 0;
      for (std::size_t p = 0; p < x_.size(); ++p) along += (next_[p] - y_[p]).dot(wnext_[p] - wy_[p]);
      length_ = std::sqrt(square);
      if (along <= curvature_ * square || curvature_ >= most_curvature_) return;
      curvature_ = std::min(2 * curvature_, most_curvature_);
    }
  }

  /// Descends at fixed slips, until the gradient map is a share of `error`.
  void descend(double error) {
    y_ = x_;
    wy_ = wx_;
    next_ = wnext_ = x_;
    double theta = 1;
    while (left_ > 0) {
      step();
      double uphill = 0;
      for (std::size_t p = 0; p < x_.size(); ++p) uphill += (wy_[p] + slope_[p]).dot(next_[p] - x_[p]);
      const double next_theta = 0.5 * theta * (std::sqrt(theta * theta + 4) - theta);
      const double beta = uphill > 0 ? 0.0 : theta * (1 - theta) / (theta * theta + next_theta);
      theta = uphill > 0 ? 1.0 : next_theta;
      for (std::size_t p = 0; p < x_.size(); ++p) {
        y_[p] = next_[p] + beta * (next_[p] - x_[p]);
        wy_[p] = wnext_[p] + beta * (wnext_[p] - wx_[p]);
      }
      x_.swap(next_);
      wx_.swap(wnext_);
      if (curvature_ * length_ <= share * error) return;
      curvature_ *= 0.9;
    }
  }

  const Problem& problem_;
  std::vector<double> scale_;  // scale of each point (kg^(1/2))
  double most_curvature_ = 0;
  double left_ = 0;       // number of products with W that may still be computed
  double curvature_ = 1;  // curvature that the step assumes for W
  double length_ = 0;     // length of the last step
  PointVectors x_, y_, next_, wx_, wy_, wnext_, slope_, scaled_;
};

}  // namespace

std::unique_ptr<Solver> make_apgd(const Problem& problem) { return std::make_unique<Apgd>(problem); }

}  // namespace scree::bench
