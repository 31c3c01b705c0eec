// The period of a scene's space, without its bodies.
#pragma once

#include "core/period.hpp"

#include <filesystem>

namespace scree {

/// Reads of a scene file all but the files that it names, and makes no body. Throws InputError as
/// read_scene() does.
Period read_period(const std::filesystem::path& scene);

}  // namespace scree
