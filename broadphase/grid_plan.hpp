// Which levels the hierarchical grid has: chosen from the size histogram by a cost model. No choice made here
// changes the PCS, only the time that it takes.
#pragma once

#include "broadphase/census.hpp"
#include "broadphase/grid_level.hpp"

#include <vector>

namespace scree {

inline constexpr int max_grid_levels = 8;

/// Two levels whose pairs are found from the upper one: each of its objects searches the lower.
struct Descent {
  int from;
  int to;
};

struct GridPlan {
  std::vector<GridLevel> levels;  ///< by growing cells; empty if there are no objects
  std::vector<Descent> descents;  ///< all other pairs of levels are in GridLevel::upward
  std::uint32_t cells = 0;        ///< of all tables
};

/// `forced`: number of levels, or 0 to choose it. There are no more levels than octaves with objects in them,
/// and no more than max_grid_levels.
GridPlan plan_grid(const Census& census, const SizeHistogram& sizes, int forced);

}  // namespace scree
