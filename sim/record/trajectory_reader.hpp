// trajectory.vtkhdf, as it is read again: by the index at its end.
#pragma once

#include "sim/record/trajectory_index.hpp"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// In the folder of a run.
inline constexpr const char* trajectory_name = "trajectory.vtkhdf";

/// What a trajectory's file ends with.
std::string trajectory_trailer(const TrajectoryIndex& index);

class TrajectoryReader {
 public:
  /// Throws InputError if the file cannot be read, or is no trajectory: it says what is wrong.
  explicit TrajectoryReader(std::filesystem::path file);

  const TrajectoryIndex& index() const { return index_; }
  /// Its place among the columns; -1 if there is none of that name.
  int column(std::string_view name) const;
  /// The numbers of a frame, row by row. Throws InputError if they cannot be read, or are damaged.
  std::vector<double> numbers(std::size_t frame, std::size_t column);

 private:
  TrajectoryIndex read_index();

  std::filesystem::path file_;
  std::ifstream stream_;
  TrajectoryIndex index_;
};

}  // namespace scree
