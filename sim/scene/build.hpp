// From a scene as written to the Scene that a simulation takes.
#pragma once

#include "sim/scene/keys.hpp"

#include <filesystem>

namespace scree {

/// Draws and places the bodies, and checks what spans sections: materials, body names, measures, counts.
/// `memory`: what a run may take (bytes). Throws InputError.
Scene build_scene(SceneEntry entry, const std::filesystem::path& source, double memory, Reader& reader);

}  // namespace scree
