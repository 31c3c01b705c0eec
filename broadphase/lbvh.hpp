// The linear bounding volume hierarchy: a binary tree of boxes over the objects in the order of a
// space-filling curve. A comparator: what most public broad phases of GPUs are.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_lbvh();

}  // namespace scree
