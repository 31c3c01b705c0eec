// The restitution threshold, which decides which approaches bounce.
#pragma once

#include "core/math.hpp"
#include "core/tolerances.hpp"

namespace scree {

/// The speed under which approaches do not bounce, but end in rest. A body that bounces under the gravity g
/// with e < 1 has come to rest after 2 u / (g (1 - e)) from an approach at speed u. The threshold is
/// proportional to 1 - e, so that the bounces left out would all be over within the same few substeps,
/// whatever e. With e = 1 bounces never end, and none is left out.
struct RestitutionThreshold {
  double any = 0;    ///< threshold for every pair (m/s)
  double lossy = 0;  ///< threshold for pairs with e = 0; decreases with 1 - e (m/s)

  SCREE_HD double of(double restitution) const {
    if (restitution >= 1) return any;
    return fmax(any, lossy * fmax(1 - restitution, tolerance::least_loss));
  }
};

}  // namespace scree
