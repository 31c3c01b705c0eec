// The command line of a benchmark: options with a value each, some of which are lists, and words.
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

/// What --help asks for; status_of() prints it.
struct Help {
  std::string text;
};

/// The options, by their names with the dashes, at their defaults but for what the command line gives; what
/// is no option goes to `words`. Throws InputError for an option that is not among them or is given twice,
/// and for a word where none are wanted; and Help, with the options and their defaults if it has no `usage`.
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

/// The items of a list, which commas part.
inline std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> items;
  std::istringstream text(list);
  for (std::string item; std::getline(text, item, ',');) items.push_back(item);
  return items;
}

/// What main() returns: the benchmark's own status, 0 after help, or 2 after the message of an error.
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
