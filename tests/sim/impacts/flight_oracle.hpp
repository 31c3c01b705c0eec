// Flights in long double and the first time at which they come to a place, by stepping and bisection, which
// have nothing in common with the closed forms and Newton steps that are compared with them.
#pragma once

#include "sim/laws/flight.hpp"

#include <cmath>

namespace scree {

using Real = long double;
using RealVec3 = Eigen::Matrix<Real, 3, 1>;

/// Returns where the flight is at the time s into a substep (m).
inline RealVec3 place_at(const Flight& flight, const Vec3& velocity, double step, Real s) {
  return flight.position.cast<Real>() + (s - 0.5L * step) * velocity.cast<Real>() +
         0.5L * s * s * flight.acceleration.cast<Real>();
}

/// Returns the first s from `earliest` to `horizon` at which `there(s)` holds; infinite if there is none. It
/// may miss a visit that is shorter than one of its 20,000 cells.
template <class There>
Real first_time(Real earliest, Real horizon, There&& there) {
  constexpr int cells = 20000;
  for (int k = 0; k < cells; ++k) {
    Real low = earliest + (horizon - earliest) * k / cells;
    Real high = earliest + (horizon - earliest) * (k + 1) / cells;
    if (!there(high)) continue;
    for (int n = 0; n < 80; ++n) {
      const Real middle = 0.5L * (low + high);
      (there(middle) ? high : low) = middle;
    }
    return high;
  }
  return INFINITY;
}

}  // namespace scree
