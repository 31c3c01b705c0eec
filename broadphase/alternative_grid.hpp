// The alternative hierarchical grid: each object stands in every cell that it overlaps, on its own level and
// on all coarser ones (Ericson 2005, Real-Time Collision Detection, section 7.2.2). A comparator: what the
// basic grid looks up, this one writes down.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

/// `levels`: how many, or 0 to choose it as the basic grid does.
template <class Space>
std::unique_ptr<BroadPhase<Space>> make_alternative_grid(int levels);

}  // namespace scree
