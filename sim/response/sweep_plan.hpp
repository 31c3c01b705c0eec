// How often the contacts of a substep are swept.
#pragma once

#include "core/tolerances.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/response/direct_contact.hpp"

#include <algorithm>
#include <cstdint>

namespace scree {

/// How often contacts are swept.
struct SweepPlan {
  int least, most;
  int block_sweeps;  ///< over the points of a contact at each visit
  double tolerance;  ///< change of the impulses in one sweep (of their size) at which they have converged
  bool direct;       ///< islands on which sweeps creep are for the direct solver
  int first_with_momentum = 0;  ///< sweep, counted from 0: a few plain ones are cheaper
};

/// Few contacts are solved to the tolerance whatever it takes, since they cost nothing. Of a heap each visit
/// sweeps a point once, since news travels one contact per sweep however well each is solved, and the least
/// number of sweeps sees to the slow modes, of which one sweep's change tells nothing (docs/decisions/0005,
/// 0014). `flows`: a heap's bodies move on one another; what that does to the contacts by the next substep is
/// more than what further sweeps would change (0052). `heap_change`: at which those of a heap have converged.
inline SweepPlan plan_sweeps(const ResponseParameters& parameters, std::int64_t contacts,
                             std::int64_t all_points, bool flows, double heap_change) {
  constexpr std::int64_t visits = 400000;  // of points in a substep
  constexpr std::int64_t fewest = 60, most = 10000;
  constexpr int plain_in_flow = 2;
  const bool heap = is_heap(all_points);
  SweepPlan plan{.least = !heap                                ? 1
                          : shares_loads(contacts, all_points) ? 12
                                                               : 6,
                 .most = 0,
                 .block_sweeps = heap ? 1 : 4,
                 .tolerance = heap && !parameters.accurate ? heap_change / parameters.quality
                                                           : tolerance::response_change,
                 .direct = !heap,
                 .first_with_momentum = heap && flows ? plain_in_flow : 0};
  const std::int64_t points = std::max<std::int64_t>(all_points, 1);
  plan.most = static_cast<int>(std::clamp(visits / (plan.block_sweeps * points), fewest, most));
  if (parameters.block_sweeps > 0) plan.block_sweeps = parameters.block_sweeps;
  if (parameters.iterations > 0) {
    plan.most = parameters.iterations;
    plan.least = std::min(plan.least, plan.most);
  }
  if (parameters.tolerance > 0) {
    plan.tolerance = parameters.tolerance;
    plan.least = 1;
  }
  return plan;
}

}  // namespace scree
