// The function that reads the period of a scene without making its bodies.
#pragma once

#include "core/period.hpp"

#include <filesystem>

namespace scree {

/// Returns the period of the scene in a file. Reads the whole scene file, but not the files that it names,
/// and makes no body. Throws InputError as read_scene() does.
Period read_period(const std::filesystem::path& scene);

}  // namespace scree
