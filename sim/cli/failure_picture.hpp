// The picture of the bodies with which a run has failed.
#pragma once

#include "render/renderer.hpp"
#include "sim/step/simulation.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace scree::cli {

/// Draws the bodies, with marks, and the surroundings of the first of them, in the present state. `bodies`
/// has at least one. Throws RunError if the picture cannot be drawn or written.
void draw_failure(const Scene& scene, Simulation& simulation, const std::vector<std::int32_t>& bodies,
                  render::ContextChoice context, const std::filesystem::path& file);

}  // namespace scree::cli
