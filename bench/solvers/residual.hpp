// How far impulses are from a solution, by one measure for all solvers.
#pragma once

#include "bench/solvers/problem.hpp"

namespace scree::bench {

/// Velocities, relative to the natural residual of no impulses at all: what closes or slips in the problem.
struct Residual {
  /// Root mean square over the points of |r - P_K(r - rho (u + mu |u_t| n))| / rho, the natural map of De
  /// Saxce's form (Acary, Bremond and Huber 2018), with 1 / rho the largest eigenvalue of the
  /// point's block of W. So heavy and light contacts weigh alike, and units do not matter. They divide by the
  /// norm of q instead, to which contacts that stay open add much.
  double natural;
  double signorini;  ///< largest |min(u_n, r_n / rho)|
  double cone;       ///< largest excess of |r_t| / rho over mu r_n / rho
};

/// The nearest point to x of the cone |x_t| <= mu x_n.
Vec3 project_on_friction_cone(const Vec3& x, double mu);

/// The largest eigenvalue of each point's block of W (1/kg).
std::vector<double> stiffness_of(const Problem& problem);

class ResidualMeter {
 public:
  /// Refers to the problem. Throws InputError if it is solved by no impulses.
  explicit ResidualMeter(const Problem& problem);

  Residual operator()(const PointVectors& impulses) const;

 private:
  Residual in_velocities(const PointVectors& impulses) const;

  const Problem& problem_;
  std::vector<double> stiffness_;
  double scale_;  // m/s
};

}  // namespace scree::bench
