// The columns of metrics.csv and timing.csv in memory, for what is drawn of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace scree::report {

using Column = std::vector<double>;  ///< a number for each row; NaN where there is none

struct Columns {
  std::vector<std::string> names;  ///< in the order of the file
  std::map<std::string, Column> values;

  /// Null if there is none of that name.
  const Column* find(const std::string& name) const;
};

/// Throws InputError if there is no such table.
Columns read_columns(const std::filesystem::path& file);

/// Rows of timing.csv: when each row of metrics.csv was written.
struct WallTimes {
  Column time;  ///< s, simulated
  Column wall;  ///< s
};
WallTimes read_wall_times(const std::filesystem::path& timing);

}  // namespace scree::report
