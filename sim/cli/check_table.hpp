// Checks as a table for people.
#pragma once

#include "sim/record/checks.hpp"

#include <string>
#include <vector>

namespace scree::cli {

/// One line: the names of the columns.
std::string check_header();
/// One line for each check, without a newline at its end.
std::vector<std::string> check_lines(const std::vector<CheckResult>& checks);

}  // namespace scree::cli
