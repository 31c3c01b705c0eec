// Words of other programs and of everyday, and what scree writes for them.
#pragma once

#include <span>
#include <string_view>

namespace scree {

/// Words that stand for the same in the sections named. Both are lists parted by blanks; words are written
/// small and without _ and -, and so mean every spelling: halfsize is half_size and halfSize too.
struct Hint {
  std::string_view sections;  ///< as in the reference, or `column` for those of body files
  std::string_view words;
  std::string_view advice;  ///< completes "unknown key; ..."
};

std::span<const Hint> hint_table();

/// What to write instead of the word in the section; empty if the table does not say.
std::string_view advice_for(std::string_view section, std::string_view word);

}  // namespace scree
