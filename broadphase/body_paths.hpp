// The straight paths along which moving bodies are looked at.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"

#include <cmath>
#include <cstdint>

namespace scree {

/// Straight paths of free bodies, which pass their positions at the time 0. Bodies that are not free stay
/// where they are.
struct BodyPaths {
  ConstView<Vec3> velocity = {};  ///< (m/s); empty if all bodies stay where they are
  double from = 0;                ///< start of the paths, at most 0 (s)
  double until = 0;               ///< end of the paths, at least 0 (s)

  SCREE_HD bool exist() const { return velocity.size() > 0; }
  /// Returns the velocity of a body on its path (m/s).
  SCREE_HD Vec3 velocity_of(Mobility mobility, std::int64_t k) const {
    return exist() && mobility == Mobility::free ? velocity[k] : Vec3(Vec3::Zero());
  }
  /// Returns the time on the paths that is nearest to `time` (s).
  SCREE_HD double within(double time) const { return fmin(fmax(time, from), until); }
  SCREE_HD double middle() const { return 0.5 * (from + until); }
  SCREE_HD double length() const { return until - from; }
};

}  // namespace scree
