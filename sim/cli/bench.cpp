// scree bench: runs one of the benchmarks that were built with this program.
#include "core/error.hpp"
#include "sim/cli/commands.hpp"
#include "sim/record/outcome.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <string_view>
#include <unistd.h>

namespace scree::cli {

namespace {

namespace fs = std::filesystem;

/// Returns the programs named scree_bench_NAME, by NAME: those beside this one, and those in BUILD/bench/* if
/// this one is in BUILD/bin.
std::map<std::string, fs::path> benchmarks() {
  constexpr std::string_view prefix = "scree_bench_";
  const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
  std::vector<fs::path> folders = {here};
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(here.parent_path() / "bench", none))
    if (entry.is_directory()) folders.push_back(entry.path());
  std::map<std::string, fs::path> found;
  for (const fs::path& folder : folders) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(prefix) && access(entry.path().c_str(), X_OK) == 0 && entry.is_regular_file())
        found.try_emplace(name.substr(prefix.size()), entry.path());
    }
  }
  return found;
}

}  // namespace

std::vector<std::string> benchmark_names() {
  std::vector<std::string> names;
  for (const auto& [name, program] : benchmarks()) names.push_back(name);
  return names;
}

int bench(const std::vector<std::string>& arguments) {
  const std::map<std::string, fs::path> found = benchmarks();
  if (arguments.empty() || arguments.front() == "--help" || arguments.front() == "-h") {
    fmt::print("Usage: scree bench NAME [ARGUMENTS OF THE BENCHMARK]...; --help is one that all have\n\n");
    for (const auto& [name, program] : found) fmt::print("  {:<18} {}\n", name, program.string());
    if (found.empty()) fmt::print("No benchmark was built beside this program.\n");
    return status_done;
  }
  const auto chosen = found.find(arguments.front());
  if (chosen == found.end()) {
    std::vector<std::string_view> names;
    for (const auto& [name, program] : found) names.push_back(name);
    throw InputError(fmt::format("there is no benchmark {}{}; `scree bench` lists those that were built",
                                 arguments.front(), suggestion(arguments.front(), names)));
  }
  std::vector<std::string> words = arguments;
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(chosen->second.c_str(), pointers.data());
  throw RunError(fmt::format("cannot start {}: {}", chosen->second.string(), std::strerror(errno)));
}

}  // namespace scree::cli
