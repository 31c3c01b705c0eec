// VTK's XML PolyData: points, cells of one kind between them, and data of both (VTK File Formats, "XML"; raw
// data, appended).
#pragma once

#include "core/archive.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scree {

struct VtkPolyData {
  enum class Kind { vertices, lines, polygons };
  struct Array {
    std::string name;
    FieldType type;
    std::vector<double> numbers;  ///< row by row
  };

  Kind kind = Kind::vertices;
  Array points;
  std::vector<Array> point_data, cell_data;
  std::vector<double> connectivity;  ///< of the cells, one after another
  std::vector<double> offsets;       ///< in that, where each cell ends

  /// Adds a cell between points.
  void add_cell(std::span<const std::int64_t> of_points);
  /// The whole file.
  std::string text() const;
};

}  // namespace scree
