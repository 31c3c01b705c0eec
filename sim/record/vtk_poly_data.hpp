// The XML PolyData of VTK: points, cells of one kind between them, and data of both (VTK File Formats, "XML";
// the data are raw and appended).
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
    std::vector<double> numbers;  ///< numbers, row by row
  };

  Kind kind = Kind::vertices;
  Array points;
  std::vector<Array> point_data, cell_data;
  std::vector<double> connectivity;  ///< points of the cells, one cell after another
  std::vector<double> offsets;       ///< end of each cell in `connectivity`

  /// Adds a cell between points.
  void add_cell(std::span<const std::int64_t> of_points);
  /// Returns the whole file.
  std::string text() const;
};

}  // namespace scree
