// Two runs beside each other, by the numbers that they wrote.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// How far one column of two tables differs.
struct ColumnDifference {
  std::string column;    ///< file and name: metrics.csv energy_total
  double largest = 0;    ///< of the rows, in the column's unit; infinite where only one of two is a number
  double relative = 0;   ///< by the largest magnitude in either column
  std::int64_t row = 0;  ///< where it is: the first is 1
  std::string key = {};  ///< what stands there in the table's first column (a time, say)
};

struct Comparison {
  std::int64_t columns = 0;  ///< compared
  std::int64_t rows = 0;
  std::vector<ColumnDifference> differences;  ///< of the columns that differ at all
  std::vector<std::string> unlike;            ///< what cannot be compared: columns and rows that one lacks

  /// Whether every difference is no more than one of the two: `absolute` in the unit of each column, for what
  /// is nothing but rounding.
  bool is_within(double relative, double absolute = 0) const;
};

/// Compares metrics.csv and final.csv of two run folders, column by column. Text has to be the same; NaN is
/// as NaN. Throws InputError if a folder has no metrics.csv, or a table is none. A final.csv that both lack,
/// as runs that were stopped do, is no difference.
Comparison compare_runs(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace scree
