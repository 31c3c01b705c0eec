// The command line of a benchmark: options with one value each, some of which are lists, and words.
#pragma once

#include "core/error.hpp"

#include <cstdio>
#include <exception>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace scree::bench {

using Options = std::map<std::string, std::string>;

/// The text that --help prints. parse() throws it, and status_of() prints it.
struct Help {
  std::string text;
};

/// Parses a command line. Returns the options by their names (with the dashes), at their defaults unless the
/// command line gives another value. Arguments that are no options are appended to `words`. Throws InputError
/// for an option that is not in `options` or is given twice, and for a word if `words` is null. Throws Help
/// on --help, with `usage`, or if that is empty with the options and their defaults.
inline Options parse(int argc, char** argv, Options options, std::vector<std::string>* words = nullptr,
                     std::string usage = "") {
  std::set<std::string> given;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const auto option = options.find(word);
    if (word == "--help") {
      if (usage.empty()) {
        for (const auto& [name, value] : options) usage += '[' + name + ' ' + value + "] ";
        usage += '\n';
      }
      throw Help{usage};
    }
    if (words && !word.starts_with("-")) {
      words->push_back(word);
    } else if (option == options.end() || k + 1 == argc) {
      throw InputError(word + ": not an option, or without a value; see --help");
    } else if (!given.insert(word).second) {
      throw InputError(word + ": given twice");
    } else {
      option->second = argv[++k];
    }
  }
  return options;
}

/// Returns the items of a comma-separated list.
inline std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> items;
  std::istringstream text(list);
  for (std::string item; std::getline(text, item, ',');) items.push_back(item);
  return items;
}

/// Runs a benchmark and returns the exit status for main(): that of the benchmark, 0 after help, or 2 after
/// the message of an error.
template <class Benchmark>
int status_of(const char* program, Benchmark run) {
  try {
    return run();
  } catch (const Help& help) {
    std::printf("usage: %s %s", program, help.text.c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 2;
  }
}

}  // namespace scree::bench
