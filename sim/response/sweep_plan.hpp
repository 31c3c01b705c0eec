// The plan of a substep's sweeps: their number, their tolerance and the solver that follows.
#pragma once

#include "core/tolerances.hpp"
#include "sim/laws/heap.hpp"
#include "sim/laws/response_parameters.hpp"
#include "sim/response/direct_contact.hpp"

#include <algorithm>
#include <cstdint>

namespace scree {

/// The limits and the tolerance of the sweeps of a substep.
struct SweepPlan {
  int least, most;              ///< numbers of sweeps
  int block_sweeps;             ///< block sweeps over the points of a contact in one visit
  double tolerance;             ///< relative change of the impulses in one sweep at which they have converged
  bool direct;                  ///< whether islands that converge slowly go to the direct solver
  int first_with_momentum = 0;  ///< first sweep with momentum, from 0: earlier plain ones are cheaper
};

/// Returns the plan for a number of contacts and points. A small number is solved to the tolerance with many
/// sweeps, since these cost little. In a heap each visit sweeps a point once, since a change travels only one
/// contact per sweep however well each contact is solved. The least number of sweeps of a heap is for the
/// slow modes, whose error one sweep's change does not show (docs/decisions/0005, 0014). `flows` says that
/// the bodies of a heap move on one another; by the next substep that changes the contacts more than further
/// sweeps would (0052). `heap_change` is the tolerance for a heap.
inline SweepPlan plan_sweeps(const ResponseParameters& parameters, std::int64_t contacts,
                             std::int64_t all_points, bool flows, double heap_change) {
  constexpr std::int64_t visits = 400000;  // point visits in a substep
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
