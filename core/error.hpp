// The two ways in which scree gives up. Bad input is the user's to mend; a failed run saved what it had.
#pragma once

#include <stdexcept>
#include <string>

namespace scree {

/// Bad input: exit status 2, nothing written. The text is complete: file:line:column, key, what is allowed.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run cannot go on: exit status 3. The text says what happened, where, and what to change.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace scree
