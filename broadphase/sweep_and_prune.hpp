// Sweep and prune along one axis: objects are sorted by where they begin, and each is tested against the
// objects that begin before it ends. It serves for comparison: its work grows with the number of objects that
// a plane across the axis cuts.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_sweep_and_prune();

}  // namespace scree
