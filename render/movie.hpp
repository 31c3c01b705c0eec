// Frames to a film.
#pragma once

#include <filesystem>

namespace scree::render {

/// Makes an H.264 film of `frames`/00000.png, 00001.png, ... with the program ffmpeg; the name appears only
/// when the film is complete. Sides of odd length lose a pixel, as the format wants. Throws RunError if
/// ffmpeg is missing or fails, with its last words, and leaves nothing behind.
void make_movie(const std::filesystem::path& frames, double fps, const std::filesystem::path& file);

}  // namespace scree::render
