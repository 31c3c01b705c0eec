// The step of many bodies: they, their contacts and all that the response works on stay in one space.
#pragma once

#include "sim/bodies/prescribed.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/step/stepper.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace scree {

struct StepperOptions {
  bool on_device = false;      ///< in Device's memory
  Vec3 origin = Vec3::Zero();  ///< local origin of the broad phase (m)
  /// After so many steps the bodies are put in order along a curve anew, and their pairs are found anew. Most
  /// still have their old neighbours by then. Where bodies lie does not change a bit of their states
  /// (docs/decisions/0047).
  std::int64_t steps_in_order = 64;
};

/// In scenes with precision: mixed impulses and velocities are found in float; the state is in double all the
/// same. General shapes, and contacts by libccd, are known on Host alone: such scenes have only their PCS
/// from Device. Throws InputError if there is no GPU.
std::unique_ptr<Stepper> make_resident_stepper(const Scene& scene, const TimeGrid& grid,
                                               const PathTable& paths, const StepperOptions& options);

}  // namespace scree
