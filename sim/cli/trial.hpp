// A run of a scene only for its checks or its time: without a folder and without pictures.
#pragma once

#include "sim/record/checks.hpp"
#include "sim/step/simulation.hpp"

#include <vector>

namespace scree::cli {

/// Checks that a scene can be read with each of its seeds, because scattered bodies may fit with one and not
/// with another. `overrides`: those with which `scene` was read. Throws InputError, whose text names the
/// seed.
void check_seeds(const Scene& scene, const std::vector<Override>& overrides);

/// Runs a scene with each of its seeds and returns the results of its checks, combined over the seeds.
/// `overrides`: those with which the scene was read. Throws the errors of check_seeds() and of a run.
std::vector<CheckResult> run_checks(const Scene& scene, const std::vector<Override>& overrides,
                                    const SimulationOptions& options);

/// Returns the wall time of all steps, without any measurement between them (s).
double time_steps(const Scene& scene, const SimulationOptions& options);

}  // namespace scree::cli
