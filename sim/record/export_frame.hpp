// A frame of a trajectory with all its columns, for exports, and its numbers as text.
#pragma once

#include "core/bodies.hpp"
#include "sim/record/trajectory_reader.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

struct ExportFrame {
  TrajectoryFrame frame;
  const std::vector<TrajectoryColumn>& about;
  std::vector<std::vector<double>> numbers;  ///< numbers of each column, row by row

  std::size_t rows() const { return static_cast<std::size_t>(frame.rows); }
  std::optional<std::size_t> find(std::string_view name) const;
  /// Returns the number of the column of this name. Throws InputError if there is none.
  std::size_t require(std::string_view name) const;
  double number(std::size_t column, std::size_t row, std::size_t component = 0) const {
    return numbers[column][row * static_cast<std::size_t>(about[column].type.columns) + component];
  }
  Vec3 vector(std::size_t column, std::size_t row) const {
    return {number(column, row, 0), number(column, row, 1), number(column, row, 2)};
  }
  /// Returns the shape of the body in a row. Throws InputError if it is not a shape of this version.
  Shape shape(std::size_t column, std::size_t row) const;
};

/// Reads all columns of a frame, in the order of the trajectory. Throws InputError if they cannot be read.
ExportFrame read_export_frame(TrajectoryReader& trajectory, std::size_t frame);

/// Appends the shortest text that reads back to the same number of its type.
void append_number(std::string& text, double number, const FieldType& type);

/// Appends all components of a column in a row, each after `separator`.
void append_row(std::string& text, const ExportFrame& frame, std::size_t column, std::size_t row,
                char separator);

}  // namespace scree
