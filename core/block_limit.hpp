// A bound on the number of thread blocks, for tests: results must not depend on how many blocks a GPU works
// on at once.
#pragma once

#include <atomic>
#include <limits>

namespace scree::parallel {

/// The largest number of blocks in a launch of a program of phases (core/space_phases.hpp). A test lowers it
/// to act as a smaller GPU.
inline std::atomic<int> block_limit{std::numeric_limits<int>::max()};

}  // namespace scree::parallel
