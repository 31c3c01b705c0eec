// The command line of a benchmark: options with a value each, some of which are lists.
#pragma once

#include "core/error.hpp"

#include <cstdio>
#include <exception>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace scree::bench {

using Options = std::map<std::string, std::string>;

/// The options, by their names with the dashes, at their defaults but for what the command line gives. Throws
/// InputError for an option that is not among them.
inline Options parse(int argc, char** argv, Options options) {
  for (int k = 1; k < argc; k += 2) {
    const auto option = options.find(argv[k]);
    if (option == options.end() || k + 1 == argc) {
      throw InputError(std::string(argv[k]) + ": not an option, or without a value");
    }
    option->second = argv[k + 1];
  }
  return options;
}

/// The items of a list, which commas part.
inline std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> items;
  std::istringstream text(list);
  for (std::string item; std::getline(text, item, ',');) items.push_back(item);
  return items;
}

/// What main() returns: the benchmark's own status, or 2 after the message of an error.
template <class Benchmark>
int status_of(const char* program, Benchmark run) {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 2;
  }
}

}  // namespace scree::bench
