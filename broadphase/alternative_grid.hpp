// The alternative hierarchical grid: each object is entered in every cell that it overlaps, on its own level
// and on all coarser ones (Ericson 2005, Real-Time Collision Detection, section 7.2.2). It serves for
// comparison: cells that the basic grid looks up are entered here beforehand.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

/// Makes the broad phase. `levels` is the number of levels, or 0 to choose it as the basic grid does.
template <class Space>
std::unique_ptr<BroadPhase<Space>> make_alternative_grid(int levels);

}  // namespace scree
