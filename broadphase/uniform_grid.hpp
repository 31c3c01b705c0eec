// The uniform grid: one cell width, that of the largest box. A comparator, and an oracle for the hierarchical
// grid at sizes that brute force cannot reach: its cells, their look-up and its traversal are its own.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_uniform_grid();

}  // namespace scree
