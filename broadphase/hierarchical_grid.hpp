// The hierarchical grid, with objects of all sizes in levels of cells that fit them.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

/// Makes the basic hierarchical grid (Ericson 2005, 7.2.1; Kroiss 2013). Each object is in the one cell that
/// holds its centre, at the lowest level whose cells are at least as wide as the object, and is tested
/// against its own and the other levels. `levels` is the number of levels, or 0 to choose it from the sizes.
template <class Space>
std::unique_ptr<BroadPhase<Space>> make_hierarchical_grid(int levels);

}  // namespace scree
