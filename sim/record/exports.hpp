// The export of trajectories to the formats of other programs.
#pragma once

#include "core/period.hpp"
#include "sim/record/particle_text.hpp"
#include "sim/record/surfaces.hpp"
#include "sim/record/trajectory_reader.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace scree {

enum class ExportFormat {
  vtp,     ///< VTK's XML PolyData, a file for each frame and a .pvd with their names: for ParaView of any age
  xyz,     ///< extended XYZ in one file: for OVITO and ASE
  lammps,  ///< a text dump of LAMMPS in one file: for OVITO and VMD
  csv,     ///< a table for each frame
};

struct ExportedTrajectory {
  std::filesystem::path file;  ///< the file to open
  LeftOut left_out;            ///< rows that are not in the file; the most of any frame
};

/// Writes a trajectory into the folder, which must exist; files of the same names are replaced. xyz and
/// lammps have only particles, csv and vtp everything that has a row. `period`: that of the run's scene.
/// Throws InputError if the trajectory cannot be read, RunError if a file cannot be written.
ExportedTrajectory export_trajectory(TrajectoryReader& trajectory, ExportFormat format, const Period& period,
                                     const std::filesystem::path& folder);

struct ExportedShapes {
  const char* name;
  std::optional<std::filesystem::path> file;  ///< absent: the trajectory has no orientation
};

/// Whether export_shapes() will request a hull. Throws InputError if the trajectory cannot be read.
bool shows_hulls(TrajectoryReader& trajectory);

/// Writes the shapes that glyphs at the points of vtp do not show: surfaces.pvd and axes.pvd, each only if
/// there is anything to be in it; see surfaces.hpp. Throws the errors of export_trajectory() and of
/// `hull_of`.
std::vector<ExportedShapes> export_shapes(TrajectoryReader& trajectory, const HullOf& hull_of,
                                          const std::filesystem::path& folder);

/// Writes the contacts of a trajectory (see ContactWriter): for vtp a contact is a line, for csv it is two
/// rows, one for each of its bodies. For the other formats, which have no contacts, nothing is written.
/// Throws the errors of export_trajectory().
std::optional<std::filesystem::path> export_contacts(TrajectoryReader& contacts, ExportFormat format,
                                                     const std::filesystem::path& folder);

}  // namespace scree
