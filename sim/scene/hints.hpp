// Hints about words of other programs and of everyday language: what to write in a scene instead.
#pragma once

#include <span>
#include <string_view>

namespace scree {

/// Words that have the same meaning in the sections named. Both lists are separated by blanks. Words are in
/// lower case and without _ and -, and so stand for every spelling: halfsize also for half_size and halfSize.
struct Hint {
  std::string_view sections;  ///< names as in the reference, or `column` for the columns of body files
  std::string_view words;
  std::string_view advice;  ///< completes "unknown key; ..."
};

std::span<const Hint> hint_table();

/// Returns what to write instead of the word in the section; empty if the table does not say.
std::string_view advice_for(std::string_view section, std::string_view word);

}  // namespace scree
