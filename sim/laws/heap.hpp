// When the contacts of a substep are a heap, which is not solved until convergence.
#pragma once

#include "core/space.hpp"

#include <cstdint>

namespace scree {

/// Smallest number of contact points that make a heap.
inline constexpr std::int64_t fewest_heap_points = 2500;
/// Returns whether there are so many points that solving them until convergence in every substep is not worth
/// its cost. Then the residual is left to the next substeps, which start from the impulses found.
SCREE_HD inline bool is_heap(std::int64_t points) { return points >= fewest_heap_points; }
/// Returns whether contacts have several points. Load moves slowly between the points of one contact.
SCREE_HD inline bool shares_loads(std::int64_t contacts, std::int64_t points) { return points > contacts; }

}  // namespace scree
