// How a run came out, as one process tells another and as `scree verify --json` writes it.
#pragma once

#include "sim/record/checks.hpp"

#include <string>
#include <vector>

namespace scree {

/// Exit statuses of the program; where several apply the greatest is the worst.
enum ExitStatus {
  status_done = 0,
  status_check_failed = 1,
  status_bad_input = 2,
  status_run_failed = 3,
  status_interrupted = 130
};

struct SceneOutcome {
  std::string scene;          ///< path, as found
  std::string settings = {};  ///< that this run varied, in words
  int status = status_done;
  std::string message = {};             ///< of the error, if one ended it
  std::string left_out = {};            ///< why it was not run; empty if it was
  std::vector<std::string> notes = {};  ///< of the scene's reader
  double wall = 0;                      ///< s
  std::vector<CheckResult> checks = {};
};

/// Done, or a check failed.
int status_of(const std::vector<CheckResult>& checks);

std::string to_json(const SceneOutcome& outcome);
/// Of a text made by to_json. Throws RunError if it is not one.
SceneOutcome outcome_from_json(const std::string& text);

/// Counts of checks; a scene that could not be run counts as one failure.
struct Tally {
  int passed = 0;
  int failed = 0;
  int left_out = 0;  ///< scenes
};
Tally tally_of(const std::vector<SceneOutcome>& outcomes);

/// Those of each settings apart, in the order in which they first come.
std::vector<std::vector<SceneOutcome>> by_settings(const std::vector<SceneOutcome>& outcomes);

/// The table of `scree verify` for other programs to read.
std::string to_json(const std::vector<SceneOutcome>& outcomes);

}  // namespace scree
