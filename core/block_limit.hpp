// A bound for tests: results must not hang on how many blocks of threads a GPU works on at once.
#pragma once

#include <atomic>
#include <limits>

namespace scree::parallel {

/// The most blocks of a launch of a program of phases (core/space_phases.hpp), to act as a smaller GPU.
inline std::atomic<int> block_limit{std::numeric_limits<int>::max()};

}  // namespace scree::parallel
