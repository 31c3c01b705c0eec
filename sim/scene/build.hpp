// The function that makes the Scene of a simulation from a scene as it is written.
#pragma once

#include "sim/scene/keys.hpp"

#include <filesystem>

namespace scree {

/// Draws and places the bodies, and checks what involves several sections: materials, body names, measures,
/// counts. `memory`: the memory that a run may take (bytes). Throws InputError.
Scene build_scene(SceneEntry entry, const std::filesystem::path& source, double memory, Reader& reader);

}  // namespace scree
