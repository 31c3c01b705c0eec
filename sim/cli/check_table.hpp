// The results of checks as a table for the terminal.
#pragma once

#include "sim/record/checks.hpp"

#include <string>
#include <vector>

namespace scree::cli {

/// Returns the line with the names of the columns.
std::string check_header();
/// Returns a line for each check, without a newline at its end.
std::vector<std::string> check_lines(const std::vector<CheckResult>& checks);
/// Returns how many checks of a run have passed, failed, were not reached or need other seeds; not evaluated
/// ones have failed.
std::string check_counts(const std::vector<CheckResult>& checks);

}  // namespace scree::cli
