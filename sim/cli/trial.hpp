// One run of a scene for its checks or its time alone: no folder, no pictures.
#pragma once

#include "sim/record/checks.hpp"
#include "sim/simulation.hpp"

#include <vector>

namespace scree::cli {

/// Reads a scene that was read with the `overrides` with each of its other seeds too, because bodies that
/// are scattered may not fit with each. Throws InputError, whose text names the seed.
void check_seeds(const Scene& scene, const std::vector<Override>& overrides);

/// The checks of a scene that was read with the `overrides`, of all its seeds together. Throws what
/// check_seeds() and a run may.
std::vector<CheckResult> run_checks(const Scene& scene, const std::vector<Override>& overrides,
                                    const SimulationOptions& options);

/// Wall time of all steps, with nothing measured on the way (s).
double time_steps(const Scene& scene, const SimulationOptions& options);

}  // namespace scree::cli
