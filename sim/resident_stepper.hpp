// The step of many bodies: they, their contacts and all that the response works on stay in one space.
#pragma once

#include "sim/dynamics/prescribed.hpp"
#include "sim/scene/scene.hpp"
#include "sim/scene/time_grid.hpp"
#include "sim/stepper.hpp"

#include <memory>
#include <vector>

namespace scree {

/// Whether a scene has what is stepped on Host alone: general shapes, and contacts by libccd. Its PCS may
/// come from Device all the same.
bool needs_host(const Scene& scene);

/// In scenes with precision: mixed impulses and velocities are found in float; the state is in double all the
/// same. `on_device`: in Device's memory, as far as the scene can be there; throws InputError if there is no
/// GPU. `origin`: the local origin of the broad phase (m).
std::unique_ptr<Stepper> make_resident_stepper(const Scene& scene, const TimeGrid& grid,
                                               const PathTable& paths, bool on_device, const Vec3& origin);

}  // namespace scree
