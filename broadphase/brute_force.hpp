// Every box against every other: the oracle of the other methods, and the fastest for very few bodies.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <memory>

namespace scree {

template <class Space>
std::unique_ptr<BroadPhase<Space>> make_brute_force();

}  // namespace scree
