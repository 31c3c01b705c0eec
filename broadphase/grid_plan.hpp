// Which levels the hierarchical grid has: chosen from the size histogram by a cost model. No choice made here
// changes the PCS, only the time that it takes.
#pragma once

#include "broadphase/census.hpp"
#include "broadphase/grid_level.hpp"

#include <vector>

namespace scree {

inline constexpr int max_grid_levels = 8;

/// Two levels whose pairs are found by the objects of one, which search the other.
struct LevelPair {
  int from;
  int to;
  std::int64_t first;  ///< number of its first search: those of a list of such pairs are numbered on
};

struct GridPlan {
  std::vector<GridLevel> levels;    ///< by growing cells; empty if there are no objects
  std::vector<LevelPair> ascents;   ///< to wider cells
  std::vector<LevelPair> descents;  ///< to narrower ones; every two levels are in one of the lists
  std::uint32_t cells = 0;          ///< of all tables

  /// Searches of a list.
  std::int64_t searches(const std::vector<LevelPair>& pairs) const {
    if (pairs.empty()) return 0;
    const GridLevel& from = levels[static_cast<std::size_t>(pairs.back().from)];
    return pairs.back().first + (from.end - from.begin);
  }
};

/// What the cost model counts with, in units of the look-up of one row of cells: measured in each space.
struct GridCosts {
  double test;  ///< of two boxes
};
template <class Space>
inline constexpr GridCosts grid_costs{.test = 0.35};
/// Four at once.
template <>
inline constexpr GridCosts grid_costs<Host>{.test = 0.12};
/// Levels whose number is forced are the same in every space.
template <class Space>
constexpr const GridCosts& grid_costs_for(int forced) {
  return forced > 0 ? grid_costs<Host> : grid_costs<Space>;
}

/// `forced`: number of levels, or 0 to choose it. There are no more levels than octaves with objects in them,
/// and no more than max_grid_levels.
GridPlan plan_grid(const Census& census, const SizeHistogram& sizes, const GridCosts& costs, int forced);

}  // namespace scree
