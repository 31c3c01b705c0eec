// Pictures as files.
#pragma once

#include "render/image.hpp"

#include <filesystem>

namespace scree::render {

/// Writes a PNG marked as sRGB, or replaces one; the name appears only when the file is complete and on the
/// disk. Throws RunError with the system's reason, for a full disk too, and leaves nothing behind.
void write_png(const std::filesystem::path& file, const Image& image);

}  // namespace scree::render
