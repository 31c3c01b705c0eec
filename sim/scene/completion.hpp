// Completion of the text of --set, for shells, from the table of keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace scree {

struct Continuation {
  std::string text;  ///< whole text from its start, such as time.step=
  std::string help;
};

/// Returns the possible continuations of `typed`. While its last key is incomplete, these are the keys that
/// begin with it, each followed by `.` before a key of its own, `[` before an index into a list, or `=`
/// before its value. After `=`, they are the words that the value may be. Names that the user gives, such as
/// those of materials, are not known here.
std::vector<Continuation> continuations_of(std::string_view typed);

}  // namespace scree
