// A trajectory as ParaView and VTK read it: temporal PolyData of the VTKHDF format, version 2.0 (VTK File
// Formats, "VTKHDF"; VTK 9.3, ParaView 5.12).
#pragma once

#include "sim/record/trajectory_index.hpp"

#include <filesystem>

namespace scree {

/// Writes the file from a journal that has the chunks of the index. The first column becomes the points, each
/// a vertex, the others their data. After what HDF5 reads come lines of text with the index of the file, and
/// one with its length and checksum, which scree reads it by: HDF5 does not look at what may be hostile.
/// Throws RunError.
void write_vtkhdf(const std::filesystem::path& file, const TrajectoryIndex& index,
                  const std::filesystem::path& journal);

}  // namespace scree
