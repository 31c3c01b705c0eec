// The comparison of two runs by the numbers that they wrote.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// How far one column of two tables differs.
struct ColumnDifference {
  std::string column;   ///< file and name of the column: metrics.csv energy_total
  double largest = 0;   ///< largest difference, in the column's unit; infinite if only one of two is a number
  double relative = 0;  ///< largest difference / largest magnitude in either column
  std::int64_t row = 0;  ///< row of the largest difference; the first row is 1
  std::string key = {};  ///< first cell of this row (a time, say)
};

struct Comparison {
  std::int64_t columns = 0;                   ///< number of columns compared
  std::int64_t rows = 0;                      ///< number of rows compared
  std::vector<ColumnDifference> differences;  ///< the columns that differ at all
  std::vector<std::string> unlike;            ///< columns and rows that only one run has, in words

  /// Whether every difference is at most one of the two tolerances. `absolute` is in the unit of each column,
  /// for columns that hold nothing but rounding.
  bool differences_are_within(double relative, double absolute) const;
  /// Whether this is so, and both runs have the same columns and rows.
  bool is_within(double relative, double absolute = 0) const;
};

/// Compares metrics.csv and final.csv of two run folders, column by column. Text has to be the same, and NaN
/// is equal to NaN. Throws InputError if a folder has no metrics.csv, or if a file is not a table. It is no
/// difference if neither run has a final.csv, as is so of runs that were stopped.
Comparison compare_runs(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace scree
