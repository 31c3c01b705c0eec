// The broad phase by brute force, which tests every box against every other. It is the reference for the
// other methods, and the fastest one for very few bodies.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_brute_force();

}  // namespace scree
