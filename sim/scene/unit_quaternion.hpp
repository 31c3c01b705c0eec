// Makes unit quaternions from orientations as they are written in files.
#pragma once

#include "core/math.hpp"
#include "core/tolerances.hpp"

#include <cmath>
#include <optional>

namespace scree {

/// Returns the unit quaternion of the same direction; nothing if the length is 0 or not finite. A quaternion
/// of unit length, up to rounding, stays as it is, so that a state that was written is read back to the bit.
inline std::optional<Quat> unit_quaternion(double w, const Vec3& imaginary) {
  Eigen::Vector4d q(w, imaginary.x(), imaginary.y(), imaginary.z());
  const double length = q.stableNorm();
  if (!(length > 0) || !std::isfinite(length)) return {};
  if (std::abs(length - 1) > tolerance::unit_length) q = q.stableNormalized();
  return Quat(q[0], q[1], q[2], q[3]);
}

}  // namespace scree
