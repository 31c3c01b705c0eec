// The columns of metrics.csv and timing.csv in memory, from which the plots are made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace scree::report {

using Column = std::vector<double>;  ///< a number for each row; NaN if the cell holds none

struct Columns {
  std::vector<std::string> names;  ///< names in the order of the file
  std::map<std::string, Column> values;

  /// Returns the column of that name; null if there is none.
  const Column* find(const std::string& name) const;
};

/// Reads a table. Throws InputError if there is no such table.
Columns read_columns(const std::filesystem::path& file);

/// The wall times at which the rows of metrics.csv were written, from timing.csv.
struct WallTimes {
  Column time;  ///< simulated time (s)
  Column wall;  ///< wall time (s)
};
WallTimes read_wall_times(const std::filesystem::path& timing);

}  // namespace scree::report
