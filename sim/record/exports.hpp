// A trajectory in the formats of other programs.
#pragma once

#include "sim/record/trajectory_reader.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace scree {

enum class ExportFormat {
  vtp,     ///< VTK's XML PolyData, a file for each frame, and a .pvd that names them: ParaView of any age
  xyz,     ///< extended XYZ, one file: OVITO, ASE
  lammps,  ///< a text dump of LAMMPS, one file: OVITO, VMD
  csv,     ///< a table for each frame
};

/// Writes into the folder, which is there; what is there under the same names is replaced. xyz and lammps
/// have spheres and boxes alone, csv and vtp whatever has a row. Returns what to open. Throws InputError if
/// the trajectory cannot be read, RunError if something cannot be written.
std::filesystem::path export_trajectory(TrajectoryReader& trajectory, ExportFormat format,
                                        const std::filesystem::path& folder);

/// The same of the contacts beside a trajectory (ContactWriter), for vtp, where each is a line, and csv,
/// where each is two rows, one as each of its bodies feels it; the other formats have none, and nothing is
/// written.
std::optional<std::filesystem::path> export_contacts(TrajectoryReader& contacts, ExportFormat format,
                                                     const std::filesystem::path& folder);

}  // namespace scree
