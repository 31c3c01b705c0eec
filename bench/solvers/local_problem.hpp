// The solver of the contact problem of one point, exact to rounding.
#pragma once

#include "core/math.hpp"

namespace scree::bench {

/// Finds the impulse r with u = w r + q that satisfies Signorini's and Coulomb's laws. It is zero, or it
/// sticks, or it slips: then u_t = -alpha r_t and u_n = 0 leave one equation for alpha > 0 (Bonnefon and
/// Daviet 2011, "Quartic formulation of Coulomb 3D frictional contact"). Here this equation is not solved as
/// a quartic, but by Newton's method within a bracket.
class LocalProblem {
 public:
  /// `w` must be positive definite (1/kg). `friction` is Coulomb's coefficient.
  LocalProblem(const Mat3& w, double friction);

  /// Returns r (N s) for the relative velocity q without it (m/s).
  Vec3 solve(const Vec3& q) const;

 private:
  using Vec2 = Eigen::Vector2d;
  struct Slip;

  Slip slip_at(double alpha, double normal_alone, const Vec2& load) const;
  Vec3 solve_slip(const Vec3& q) const;

  double friction_;
  double normal_mass_;    // 1 / w_nn
  Mat3 inverse_;          // inverse of w
  Vec2 coupling_;         // w_tn
  Vec2 eigenvalues_;      // eigenvalues of S, the Schur complement of w_nn; ascending
  Eigen::Matrix2d axes_;  // eigenvectors of S
};

}  // namespace scree::bench
