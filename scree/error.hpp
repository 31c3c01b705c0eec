// The exceptions that scree throws. Bad input can be corrected by the user; a run that failed still has its
// last good state.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace scree {

/// Bad input; nothing was changed. The text is complete: file:line:column, key, and what is allowed. The
/// program's exit status is 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The run cannot go on, or a file cannot be read or written. The text says what happened, where, and what to
/// change. The program's exit status is 3.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A step from which the run cannot go on. The state is as it was before the step.
class StepFailure : public RunError {
 public:
  StepFailure(const std::string& what, std::vector<std::int32_t> bodies);
  /// Returns the numbers in the scene of a few bodies that the failure is about, the worst first. Empty if it
  /// is about no particular body.
  const std::vector<std::int32_t>& bodies() const { return bodies_; }

 private:
  std::vector<std::int32_t> bodies_;
};

}  // namespace scree
