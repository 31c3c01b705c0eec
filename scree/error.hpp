// What scree throws. Bad input is the user's to mend; a run that failed has its last good state.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace scree {

/// Bad input; nothing was changed. The text is complete: file:line:column, key, what is allowed. Exit status
/// 2 of the program.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run cannot go on, or a file cannot be read or written. The text says what happened, where, and what to
/// change. Exit status 3 of the program.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A step that the run cannot go on from; the state is as it was before it.
class StepFailure : public RunError {
 public:
  StepFailure(const std::string& what, std::vector<std::int32_t> bodies);
  /// That it is about, by their numbers in the scene, a few; the worst first. Empty if it is about none in
  /// particular.
  const std::vector<std::int32_t>& bodies() const { return bodies_; }

 private:
  std::vector<std::int32_t> bodies_;
};

}  // namespace scree
