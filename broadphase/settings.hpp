// The settings of the broad phase that a scene may give.
#pragma once

namespace scree {

enum class BroadPhaseMethod {
  hierarchical_grid,
  alternative_grid,
  uniform_grid,
  sweep_and_prune,
  lbvh,
  brute_force
};

struct BroadPhaseSettings {
  BroadPhaseMethod method = BroadPhaseMethod::hierarchical_grid;
  int levels = 0;  ///< number of grid levels; 0: chosen from the size histogram. Never changes the PCS.
};

}  // namespace scree
