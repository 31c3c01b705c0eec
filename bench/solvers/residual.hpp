// The distance of impulses from a solution, by one measure for all solvers.
#pragma once

#include "bench/solvers/problem.hpp"

namespace scree::bench {

/// The residual in velocities, relative to the natural residual of zero impulses, which comes from the points
/// that close or slip in the problem.
struct Residual {
  /// The root mean square over the points of |r - P_K(r - rho (u + mu |u_t| n))| / rho, the natural map of De
  /// Saxce's form (Acary, Bremond and Huber 2018). 1 / rho is the largest eigenvalue of the point's block of
  /// W, so that heavy and light contacts have equal weight, and units do not matter. Acary, Bremond and Huber
  /// divide by the norm of q instead, to which contacts that stay open contribute much.
  double natural;
  double signorini;  ///< largest |min(u_n, r_n / rho)|
  double cone;       ///< largest excess of |r_t| / rho over mu r_n / rho
};

/// Returns the nearest point to x of the cone |x_t| <= mu x_n.
Vec3 project_on_friction_cone(const Vec3& x, double mu);

/// Returns the largest eigenvalue of each point's block of W (1/kg).
std::vector<double> stiffness_of(const Problem& problem);

class ResidualMeter {
 public:
  /// Refers to the problem. Throws InputError if zero impulses solve it.
  explicit ResidualMeter(const Problem& problem);

  Residual operator()(const PointVectors& impulses) const;

 private:
  Residual in_velocities(const PointVectors& impulses) const;

  const Problem& problem_;
  std::vector<double> stiffness_;
  double scale_;  // natural residual of zero impulses (m/s)
};

}  // namespace scree::bench
