// Which approaches bounce.
#pragma once

#include "core/math.hpp"
#include "core/tolerances.hpp"

namespace scree {

/// Slower approaches do not bounce: they end in rest. A body that bounces under the gravity g with e < 1 has
/// come to rest after 2 u / (g (1 - e)) from an approach at speed u; the threshold is proportional to 1 - e,
/// so that the bounces it leaves out would all be over within the same few substeps, whatever e. With e = 1
/// they never are, and none is left out.
struct RestitutionThreshold {
  double any = 0;    ///< for every pair (m/s)
  double lossy = 0;  ///< for pairs with e = 0; falls with 1 - e (m/s)

  SCREE_HD double of(double restitution) const {
    if (restitution >= 1) return any;
    return fmax(any, lossy * fmax(1 - restitution, tolerance::least_loss));
  }
};

}  // namespace scree
