// The plan of the hierarchical grid: its levels, chosen from the size histogram by a cost model. No choice
// made here changes the PCS, only the time that it takes.
#pragma once

#include "broadphase/census.hpp"
#include "broadphase/grid_level.hpp"

#include <vector>

namespace scree {

inline constexpr int max_grid_levels = 8;

/// Two levels whose pairs are found by the objects of one level, which search the other level.
struct LevelPair {
  int from;
  int to;
  std::int64_t first;  ///< number of its first search: the searches of a list of level pairs are numbered
                       ///< consecutively
};

struct GridPlan {
  std::vector<GridLevel> levels;    ///< levels, by growing cells; empty if there are no objects
  std::vector<LevelPair> ascents;   ///< level pairs whose objects search wider cells
  std::vector<LevelPair> descents;  ///< level pairs whose objects search narrower cells; every two levels are
                                    ///< in one of the lists
  std::uint32_t cells = 0;          ///< number of cells of all tables

  /// Returns the number of searches of a list.
  std::int64_t searches(const std::vector<LevelPair>& pairs) const {
    if (pairs.empty()) return 0;
    const GridLevel& from = levels[static_cast<std::size_t>(pairs.back().from)];
    return pairs.back().first + (from.end - from.begin);
  }
};

/// The costs in the cost model, in units of the look-up of one row of cells, as measured in each space.
struct GridCosts {
  double test;  ///< test of two boxes
};
template <class Space>
inline constexpr GridCosts grid_costs{.test = 0.35};
/// On Host, four boxes are tested at once.
template <>
inline constexpr GridCosts grid_costs<Host>{.test = 0.12};
/// Returns the costs to use. If the number of levels is forced, the levels are the same in every space.
template <class Space>
constexpr const GridCosts& grid_costs_for(int forced) {
  return forced > 0 ? grid_costs<Host> : grid_costs<Space>;
}

/// Plans the grid. `forced` is the number of levels, or 0 to choose it. There are no more levels than octaves
/// with objects in them, and no more than max_grid_levels.
GridPlan plan_grid(const Census& census, const SizeHistogram& sizes, const GridCosts& costs, int forced);

}  // namespace scree
