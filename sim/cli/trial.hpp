// One run of a scene for its checks or its time alone: no folder, no pictures.
#pragma once

#include "sim/record/checks.hpp"
#include "sim/step/simulation.hpp"

#include <vector>

namespace scree::cli {

/// Checks that a scene can be read with each of its seeds, because scattered bodies may fit with one and not
/// with another. `overrides`: those with which `scene` was read. Throws InputError, whose text names the
/// seed.
void check_seeds(const Scene& scene, const std::vector<Override>& overrides);

/// The checks of a scene that was read with the `overrides`, of all its seeds together. Throws what
/// check_seeds() and a run may.
std::vector<CheckResult> run_checks(const Scene& scene, const std::vector<Override>& overrides,
                                    const SimulationOptions& options);

/// Wall time of all steps, with nothing measured on the way (s).
double time_steps(const Scene& scene, const SimulationOptions& options);

}  // namespace scree::cli
