// scree compare: compares the numbers of two run folders.
#include "sim/cli/commands.hpp"
#include "sim/record/comparison.hpp"
#include "sim/record/outcome.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace scree::cli {

namespace {

/// Returns the end of the last line: why the comparison has failed, or that the differences are allowed.
const char* verdict_on(const Comparison& found, const CompareArguments& arguments) {
  if (!found.differences_are_within(arguments.tolerance, arguments.absolute))
    return ", more than --tolerance and --absolute allow";
  if (!found.unlike.empty()) return "; some columns or rows are in one of the runs only";
  return found.differences.empty() ? "" : ", all within what was allowed";
}

}  // namespace

int compare(const CompareArguments& arguments) {
  Comparison found = compare_runs(arguments.first, arguments.second);
  for (const std::string& what : found.unlike) fmt::print("{}\n", printable(what));
  std::ranges::sort(found.differences, std::greater(), &ColumnDifference::relative);
  if (!found.differences.empty())
    fmt::print("{:>12}  {:>12}  {:>8}  {:<20}  column\n", "largest", "relative", "row", "first cell");
  for (const ColumnDifference& d : found.differences)
    fmt::print("{:>12.4g}  {:>12.4g}  {:>8}  {:<20}  {}\n", d.largest, d.relative, d.row, printable(d.key),
               printable(d.column));
  fmt::print("{} columns, {} rows: {} columns differ{}\n", found.columns, found.rows,
             found.differences.size(), verdict_on(found, arguments));
  return found.is_within(arguments.tolerance, arguments.absolute) ? status_done : status_check_failed;
}

}  // namespace scree::cli
