// From a scene as written to the Scene that a simulation takes.
#pragma once

#include "sim/scene/keys.hpp"

#include <filesystem>

namespace scree {

/// Draws and places the bodies, and checks what spans sections: materials, body names, measures, counts.
/// Throws InputError.
Scene build_scene(SceneEntry entry, const std::filesystem::path& source, Reader& reader);

}  // namespace scree
