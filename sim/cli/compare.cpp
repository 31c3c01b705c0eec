// scree compare: two run folders beside each other.
#include "sim/cli/commands.hpp"
#include "sim/record/comparison.hpp"
#include "sim/record/outcome.hpp"
#include "sim/scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace scree::cli {

int compare(const CompareArguments& arguments) {
  Comparison found = compare_runs(arguments.first, arguments.second);
  for (const std::string& what : found.unlike) fmt::print("{}\n", printable(what));
  std::ranges::sort(found.differences, std::greater(), &ColumnDifference::relative);
  if (!found.differences.empty())
    fmt::print("{:>12}  {:>12}  {:>8}  {:<20}  column\n", "largest", "relative", "row", "beside");
  for (const ColumnDifference& d : found.differences)
    fmt::print("{:>12.4g}  {:>12.4g}  {:>8}  {:<20}  {}\n", d.largest, d.relative, d.row, printable(d.key),
               printable(d.column));
  const bool within = found.is_within(arguments.tolerance, arguments.absolute);
  fmt::print("{} columns, {} rows: {} columns differ{}\n", found.columns, found.rows,
             found.differences.size(),
             within && !found.differences.empty() ? ", all within what was allowed" : "");
  return within ? status_done : status_check_failed;
}

}  // namespace scree::cli
