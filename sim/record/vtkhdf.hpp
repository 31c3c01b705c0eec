// The VTKHDF file of a trajectory, which ParaView and VTK read: temporal PolyData of version 2.0 of the
// format (VTK File Formats, "VTKHDF"; VTK 9.3, ParaView 5.12).
#pragma once

#include "sim/record/trajectory_index.hpp"

#include <filesystem>

namespace scree {

/// The cells between the points of a frame.
enum class Cells {
  vertices,  ///< a vertex at each point
  lines,     ///< a line between each two consecutive points
};

/// Writes the file from a journal that has the chunks of the index. The first column becomes the points,
/// which the cells join, and the others become their data. After the part that HDF5 reads come lines of text
/// with the index of the file, and a line with its length and checksum; scree reads the file by these, since
/// HDF5 does not check input that may be hostile. Throws RunError.
void write_vtkhdf(const std::filesystem::path& file, const TrajectoryIndex& index, Cells cells,
                  const std::filesystem::path& journal);

}  // namespace scree
