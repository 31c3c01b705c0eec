// Where a command that works on a run writes.
#pragma once

#include <filesystem>

namespace scree::cli {

/// The folder given, if any; else one beside the run's, named after it: output/drum-render.
inline std::filesystem::path output_folder(const std::filesystem::path& given, std::filesystem::path run,
                                           const char* word) {
  if (!given.empty()) return given;
  run = run.lexically_normal();
  if (!run.has_filename()) run = run.parent_path();  // of "output/drum/"
  return (run += "-") += word;
}

}  // namespace scree::cli
