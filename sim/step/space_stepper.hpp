// The stepper of a scene: its bodies, their contacts and all data of the response stay in one space.
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
  bool on_device = false;      ///< whether the bodies are in Device's memory
  Vec3 origin = Vec3::Zero();  ///< local origin of the broad phase (m)
  /// Number of steps after which the bodies are sorted again along a curve, and their pairs are found anew.
  /// Most bodies still have their old neighbours by then. The places of bodies in memory do not change a bit
  /// of their states (docs/decisions/0047).
  std::int64_t steps_in_order = 64;
  /// Whether the impulses on bodies that are not free are summed up. If not, theirs are NaN.
  bool sums_impulses_on_walls = true;
};

/// Makes the stepper of a scene. In mixed precision impulses and velocities are found in float, but the state
/// is in double. General shapes, and contacts by libccd, are known on Host alone: of such scenes only the PCS
/// is found on Device. Throws InputError if there is no GPU, or if such a scene has mixed precision.
std::unique_ptr<Stepper> make_space_stepper(const Scene& scene, const TimeGrid& grid, const PathTable& paths,
                                            const StepperOptions& options);

}  // namespace scree
