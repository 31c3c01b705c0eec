// What the text of --set may become, for shells: from the table of keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace scree {

struct Continuation {
  std::string text;  ///< from the start: time.step=
  std::string help;
};

/// Of `typed`, as far as its last key is typed: the keys that begin so, each with what comes after it: `.`
/// before a key of its own, `[` before a number in a list, `=` before its value. After `=`, the words that
/// the value may be. Names that the user gives, such as those of materials, are not known here.
std::vector<Continuation> continuations_of(std::string_view typed);

}  // namespace scree
