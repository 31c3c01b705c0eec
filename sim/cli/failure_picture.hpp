// A picture of the place where a run has failed.
#pragma once

#include "render/renderer.hpp"
#include "sim/step/simulation.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace scree::cli {

/// Draws the bodies, marked, and what is around the first of them, in the present state. `bodies` holds one
/// at least. Throws RunError if that cannot be drawn or written.
void draw_failure(const Scene& scene, Simulation& simulation, const std::vector<std::int32_t>& bodies,
                  render::ContextChoice context, const std::filesystem::path& file);

}  // namespace scree::cli
