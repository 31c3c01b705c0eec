// A small scene for the program, and what its tests ask of the folders that it writes.
#pragma once

#include "tests/sim/cli/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A ball in free fall from 10 m for 0.1 s; `tail` may add keys.
inline std::string falling_ball(const std::string& tail = "") {
  return R"(format: 1
gravity: [0, 0, -10]
time: {end: 0.1, step: 0.01}
materials:
  stone: {density: 1000}
bodies:
  - {sphere: {radius: 0.1}, name: ball, at: [0, 0, 10], material: stone}
record: {metrics_every: 0.02}
)" + tail;
}
inline const std::string no_pictures = "render: false\n";
// Free flight is exact: z = 10 - 5 t^2.
inline const std::string good_check =
    "checks: [{measure: ball.position.z, expect: 9.95, tolerance: 1.0e-12}]\n";
inline const std::string bad_check = "checks: [{measure: ball.position.z, expect: 9, tolerance: 0.1}]\n";

/// Every file below a folder, but for the run's lock.
inline std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != ".lock") {
      files.push_back(fs::relative(entry.path(), folder).string());
    }
  }
  std::ranges::sort(files);
  return files;
}

inline Json manifest_in(const fs::path& run) { return Json::parse(text_of(run / "manifest.json")); }

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class ProgramTest : public testing::Test {
 protected:
  Finished run_scene(const std::string& text, std::vector<std::string> more = {}) {
    write_text(folder_ / "fall.yaml", text);
    more.insert(more.begin(), {"run", "fall.yaml"});
    return scree_in(folder_, more);
  }
  TemporaryFolder folder_;
};

}  // namespace scree
