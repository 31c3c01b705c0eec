#include "bench/solvers/residual.hpp"

#include "core/error.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace scree::bench {

Vec3 project_on_friction_cone(const Vec3& x, double mu) {
  const double xt = std::hypot(x.y(), x.z());
  if (xt <= mu * x.x()) return x;
  const double xn = (x.x() + mu * xt) / (1 + mu * mu);
  if (xn <= 0) return Vec3::Zero();
  const double share = xt > 0 ? mu * xn / xt : 0.0;
  return {xn, share * x.y(), share * x.z()};
}

std::vector<double> stiffness_of(const Problem& problem) {
  std::vector<double> stiffness;
  for (std::size_t k = 0; k < problem.size(); ++k) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(problem.delassus.diagonal(k), Eigen::EigenvaluesOnly);
    stiffness.push_back(eigen.eigenvalues()[2]);
  }
  return stiffness;
}

ResidualMeter::ResidualMeter(const Problem& problem)
    : problem_(problem),
      stiffness_(stiffness_of(problem)),
      scale_(in_velocities(PointVectors(problem.size(), Vec3::Zero())).natural) {
  if (!(scale_ > 0)) throw InputError("the contact problem needs no impulses");
}

Residual ResidualMeter::operator()(const PointVectors& impulses) const {
  const Residual found = in_velocities(impulses);
  return {found.natural / scale_, found.signorini / scale_, found.cone / scale_};
}

Residual ResidualMeter::in_velocities(const PointVectors& impulses) const {
  Residual residual{};
  for (std::size_t k = 0; k < problem_.size(); ++k) {
    const double mu = problem_.friction[k];
    const Vec3 u = problem_.delassus.times(k, impulses) + problem_.free_velocity[k];
    const Vec3 r = stiffness_[k] * impulses[k];
    const Vec3 bent = u + mu * std::hypot(u.y(), u.z()) * Vec3::UnitX();
    residual.natural += (r - project_on_friction_cone(r - bent, mu)).squaredNorm();
    residual.signorini = std::max(residual.signorini, std::abs(std::min(u.x(), r.x())));
    residual.cone = std::max(residual.cone, std::hypot(r.y(), r.z()) - mu * r.x());
  }
  residual.natural = std::sqrt(residual.natural / static_cast<double>(problem_.size()));
  return residual;
}

}  // namespace scree::bench
