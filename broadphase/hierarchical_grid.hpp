// The hierarchical grid: objects of all sizes in levels of cells that fit them.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

/// The basic hierarchical grid (Ericson 2005, 7.2.1; Kroiss 2013): each object stands in the one cell that
/// holds its centre, at the lowest level whose cells are at least as wide as the object, and is tested
/// against its own and the other levels. `levels`: how many, 0: chosen from the sizes.
template <class Space>
std::unique_ptr<BroadPhase<Space>> make_hierarchical_grid(int levels);

}  // namespace scree
