// The outcome of a run, in the form in which a process sends it to another, and `scree verify --json` writes
// it.
#pragma once

#include "sim/record/checks.hpp"

#include <string>
#include <vector>

namespace scree {

/// Exit statuses of the program. Where several apply, the greatest one is the worst.
enum ExitStatus {
  status_done = 0,
  status_check_failed = 1,
  status_bad_input = 2,
  status_run_failed = 3,
  status_interrupted = 130
};

struct SceneOutcome {
  std::string scene;          ///< path of the scene, as it was found
  std::string settings = {};  ///< settings that this run varied, in words
  int status = status_done;
  std::string message = {};             ///< the error that ended the run; empty if none did
  std::string left_out = {};            ///< the reason why the scene was not run; empty if it was
  std::vector<std::string> notes = {};  ///< notes of the reader of the scene
  double wall = 0;                      ///< wall time (s)
  std::vector<CheckResult> checks = {};
};

/// Returns the exit status of a run with these results: done, or a check failed.
int status_of(const std::vector<CheckResult>& checks);

std::string to_json(const SceneOutcome& outcome);
/// Reads an outcome from a text that to_json() has made. Throws RunError if it is not one.
SceneOutcome outcome_from_json(const std::string& text);

/// Counts of checks. A scene that could not be run counts as one failure.
struct Tally {
  int passed = 0;
  int failed = 0;
  int left_out = 0;  ///< number of scenes that were not run
};
Tally tally_of(const std::vector<SceneOutcome>& outcomes);

/// Groups the outcomes by their settings, in the order in which these first occur.
std::vector<std::vector<SceneOutcome>> by_settings(const std::vector<SceneOutcome>& outcomes);

/// Returns the table of `scree verify` for other programs.
std::string to_json(const std::vector<SceneOutcome>& outcomes);

}  // namespace scree
