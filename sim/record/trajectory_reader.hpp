// The reader of trajectory.vtkhdf, which uses the index at the end of the file.
#pragma once

#include "sim/record/trajectory_index.hpp"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// The name of the file in the folder of a run.
inline constexpr const char* trajectory_name = "trajectory.vtkhdf";

/// Returns the text with which a trajectory's file ends: its index, and a line with the checksum of the
/// index.
std::string trajectory_trailer(const TrajectoryIndex& index);

class TrajectoryReader {
 public:
  /// Throws InputError, which says what is wrong, if the file cannot be read or is not a trajectory.
  explicit TrajectoryReader(std::filesystem::path file);

  const TrajectoryIndex& index() const { return index_; }
  /// Returns the number of the column of this name; -1 if there is none.
  int column(std::string_view name) const;
  /// Returns the numbers of a column in a frame, row by row. Throws InputError if they cannot be read or are
  /// damaged.
  std::vector<double> numbers(std::size_t frame, std::size_t column);

 private:
  TrajectoryIndex read_index();

  std::filesystem::path file_;
  std::ifstream stream_;
  TrajectoryIndex index_;
};

}  // namespace scree
