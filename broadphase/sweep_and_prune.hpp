// Sweep and prune along one axis: objects sorted by where they begin, each against those that begin before it
// ends. A comparator: its work grows with the number of objects that a plane across the axis cuts.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_sweep_and_prune();

}  // namespace scree
