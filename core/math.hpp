// Vectors, quaternions and rotations, on Eigen. Everything here runs in both spaces.
#pragma once

#include "core/space.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

namespace scree {

using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;  ///< unit quaternion; rotates body-frame vectors into the world frame

inline constexpr double pi = 3.14159265358979323846;

/// Returns the rotation by the vector `angle` (rad). It is exact for any length; near 0 it uses the series.
SCREE_HD inline Quat rotation_of(const Vec3& angle) {
  const double square = 0.25 * angle.squaredNorm();  // square of half the angle
  if (square < 1e-8) {
    const Vec3 v = (0.5 - square / 12.0) * angle;
    return Quat(1.0 - 0.5 * square, v.x(), v.y(), v.z());
  }
  const double half_angle = sqrt(square);
  const double s = 0.5 * sin(half_angle) / half_angle;
  return Quat(cos(half_angle), s * angle.x(), s * angle.y(), s * angle.z());
}

/// Returns a unit vector at right angles to the unit vector n (Duff et al. 2017). It is continuous on each
/// side of the plane z = 0 and jumps across it, so components along it must not be kept while n changes.
SCREE_HD inline Vec3 tangent_of(const Vec3& n) {
  const double sign = copysign(1.0, n.z());
  const double a = -1.0 / (sign + n.z());
  return Vec3(1.0 + sign * n.x() * n.x() * a, sign * n.x() * n.y() * a, -sign * n.x());
}

/// Returns R diag(d) R^T for the rotation matrix R: a body-frame diagonal tensor in the world frame.
SCREE_HD inline Mat3 rotated_diagonal(const Mat3& R, const Vec3& d) {
  return R * d.asDiagonal() * R.transpose();
}

}  // namespace scree
