// The conversion of frames to a film.
#pragma once

#include <filesystem>

namespace scree::render {

/// Makes an H.264 film of `frames`/00000.png, 00001.png, ... with the program ffmpeg. The file's name appears
/// only when the film is complete. Sides of odd length lose a pixel, because the format needs even ones. If
/// ffmpeg is missing or fails, it throws RunError with the end of ffmpeg's output, and leaves no file behind.
void make_movie(const std::filesystem::path& frames, double fps, const std::filesystem::path& file);

}  // namespace scree::render
