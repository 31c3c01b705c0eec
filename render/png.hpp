// The writing of pictures to PNG files.
#pragma once

#include "render/image.hpp"

#include <filesystem>

namespace scree::render {

/// Writes a PNG file marked as sRGB, or replaces one. The file's name appears only when it is complete and on
/// the disk. On failure, also if the disk is full, it throws RunError with the system's reason and leaves no
/// file behind.
void write_png(const std::filesystem::path& file, const Image& image);

}  // namespace scree::render
