// Frames as ParaView and VTK read them: temporal PolyData of the VTKHDF format, version 2.0 (VTK File
// Formats, "VTKHDF"; VTK 9.3, ParaView 5.12).
#pragma once

#include "sim/record/trajectory_index.hpp"

#include <filesystem>

namespace scree {

/// What is drawn of the points of a frame.
enum class Cells {
  vertices,  ///< each by itself
  lines,     ///< each two that follow one another are joined
};

/// Writes the file from a journal that has the chunks of the index. The first column becomes the points,
/// which the cells join, the others their data. After what HDF5 reads come lines of text with the index of
/// the file, and one with its length and checksum, which scree reads it by: HDF5 does not look at what may be
/// hostile. Throws RunError.
void write_vtkhdf(const std::filesystem::path& file, const TrajectoryIndex& index, Cells cells,
                  const std::filesystem::path& journal);

}  // namespace scree
