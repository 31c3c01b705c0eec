// The contact problem of one point, solved to rounding.
#pragma once

#include "core/math.hpp"

namespace scree::bench {

/// The impulse r with u = w r + q in Signorini's and Coulomb's laws: none, the one that sticks, or the one
/// that slips, where u_t = -alpha r_t and u_n = 0 leave one equation for alpha > 0 (Bonnefon and Daviet 2011,
/// "Quartic formulation of Coulomb 3D frictional contact"), which is solved here by Newton's method kept
/// inside a bracket rather than as a quartic.
class LocalProblem {
 public:
  /// `w`: positive definite (1/kg). `friction`: Coulomb's coefficient.
  LocalProblem(const Mat3& w, double friction);

  /// r (N s), for the relative velocity q without it (m/s).
  Vec3 solve(const Vec3& q) const;

 private:
  using Vec2 = Eigen::Vector2d;
  struct Slip;

  Slip slip_at(double alpha, double normal_alone, const Vec2& load) const;
  Vec3 solve_slip(const Vec3& q) const;

  double friction_;
  double normal_mass_;    // 1 / w_nn
  Mat3 inverse_;          // of w
  Vec2 coupling_;         // w_tn
  Vec2 eigenvalues_;      // of S, the Schur complement of w_nn; ascending
  Eigen::Matrix2d axes_;  // its eigenvectors
};

}  // namespace scree::bench
