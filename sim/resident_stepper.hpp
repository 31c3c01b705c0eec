// The step of many bodies: they, their contacts and all that the response works on stay in one space.
#pragma once

#include "sim/dynamics/prescribed.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/stepper.hpp"

#include <memory>
#include <vector>

namespace scree {

/// In scenes with precision: mixed impulses and velocities are found in float; the state is in double all the
/// same. `on_device`: in Device's memory. General shapes, and contacts by libccd, are
/// known on Host alone: such scenes have only their PCS from there. Throws InputError if there is no
/// GPU. `origin`: the local origin of the broad phase (m).
std::unique_ptr<Stepper> make_resident_stepper(const Scene& scene, const TimeGrid& grid,
                                               const PathTable& paths, bool on_device, const Vec3& origin);

}  // namespace scree
