// The data sets of the broad-phase benchmarks: balls at random in a cube, the side of which follows from the
// share of its volume that they would fill. Seeded by the body's number, so a set is the same everywhere.
#pragma once

#include "broadphase/broad_phase.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace scree::bench {

/// A: radius 0.5, share 0.5. B: radius log-uniform from 0.01 to 1, share 0.3. C: radius 1, but 50 with
/// probability 1e-4, share 0.3. Throws InputError for other names.
std::vector<Aabb> make_data_set(const std::string& name, std::int64_t n);

}  // namespace scree::bench
