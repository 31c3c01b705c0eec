#include "bench/solvers/local_problem.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace scree::bench {

/// The state of a slipping point at alpha: r_t = -(S + alpha)^-1 (q_t - w_tn q_n / w_nn), and r_n from u_n =
/// 0.
struct LocalProblem::Slip {
  Vec2 friction;  // r_t, along the axes
  double normal;
  double excess;  // excess of |r_t| over its bound: positive at alpha = 0, negative for large alpha
  double slope;   // derivative of the excess by alpha
};

LocalProblem::LocalProblem(const Mat3& w, double friction)
    : friction_(friction), normal_mass_(1 / w(0, 0)), inverse_(w.inverse()), coupling_(w.block<2, 1>(1, 0)) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> schur;
  schur.computeDirect(w.block<2, 2>(1, 1) - normal_mass_ * coupling_ * coupling_.transpose());
  eigenvalues_ = schur.eigenvalues();
  axes_ = schur.eigenvectors();
}

LocalProblem::Slip LocalProblem::slip_at(double alpha, double normal_alone, const Vec2& load) const {
  const Vec2 along = eigenvalues_.array() + alpha;
  const Vec2 friction = -load.cwiseQuotient(along);
  const Vec2 change = -friction.cwiseQuotient(along);
  const Vec2 coupling = normal_mass_ * axes_.transpose() * coupling_;
  const double length = friction.norm();
  const double normal = normal_alone - coupling.dot(friction);
  return {friction, normal, length - friction_ * normal,
          friction.dot(change) / length + friction_ * coupling.dot(change)};
}

Vec3 LocalProblem::solve_slip(const Vec3& q) const {
  constexpr int most_steps = 60;
  const double normal_alone = -q.x() * normal_mass_;
  const Vec2 load = axes_.transpose() * (q.tail<2>() + coupling_ * normal_alone);
  double low = 0;
  double high = eigenvalues_[1];
  Slip slip = slip_at(high, normal_alone, load);
  for (; slip.excess > 0; slip = slip_at(high, normal_alone, load)) high *= 4;
  double alpha = high;
  for (int step = 0; step < most_steps && slip.excess != 0; ++step) {
    (slip.excess > 0 ? low : high) = alpha;
    if (high - low <= 2 * std::numeric_limits<double>::epsilon() * high) break;
    const double newton = alpha - slip.excess / slip.slope;
    alpha = newton > low && newton < high ? newton : 0.5 * (low + high);
    slip = slip_at(alpha, normal_alone, load);
  }
  const Vec2 friction = axes_ * (friction_ * slip.normal / slip.friction.norm() * slip.friction);
  return {slip.normal, friction.x(), friction.y()};
}

Vec3 LocalProblem::solve(const Vec3& q) const {
  if (q.x() >= 0) return Vec3::Zero();
  if (friction_ == 0) return {-q.x() * normal_mass_, 0, 0};
  Vec3 sticking = -inverse_ * q;
  if (std::hypot(sticking.y(), sticking.z()) <= friction_ * sticking.x()) return sticking;
  return solve_slip(q);
}

}  // namespace scree::bench
