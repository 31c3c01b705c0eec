// The output folder of a command that works on a run.
#pragma once

#include <filesystem>

namespace scree::cli {

/// Returns the folder given, if any; else a folder beside that of the run, named after it:
/// output/drum-render.
inline std::filesystem::path output_folder(const std::filesystem::path& given, std::filesystem::path run,
                                           const char* word) {
  if (!given.empty()) return given;
  run = run.lexically_normal();
  if (!run.has_filename()) run = run.parent_path();  // for "output/drum/"
  return (run += "-") += word;
}

}  // namespace scree::cli
