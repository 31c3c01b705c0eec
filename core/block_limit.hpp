// A bound for tests: results must not hang on how many blocks of threads a GPU works on at once.
#pragma once

#include <atomic>
#include <limits>

namespace scree::parallel {

/// Blocks that share a launch of rounds (core/space_rounds.hpp) at most, as on a smaller GPU.
inline std::atomic<int> block_limit{std::numeric_limits<int>::max()};

}  // namespace scree::parallel
