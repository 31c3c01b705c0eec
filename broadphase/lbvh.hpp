// The linear bounding volume hierarchy: a binary tree of boxes over the objects in the order of a
// space-filling curve. It serves for comparison: most public broad phases for GPUs are of this kind.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_lbvh();

}  // namespace scree
