// The uniform grid, with one cell width, that of the largest box. It serves for comparison, and as a
// reference for the hierarchical grid at numbers of bodies that brute force cannot handle: its cells, their
// look-up and its traversal are independent of that grid.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_uniform_grid();

}  // namespace scree
