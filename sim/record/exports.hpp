// A trajectory in the formats of other programs.
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
  vtp,     ///< VTK's XML PolyData, a file for each frame, and a .pvd that names them: ParaView of any age
  xyz,     ///< extended XYZ, one file: OVITO, ASE
  lammps,  ///< a text dump of LAMMPS, one file: OVITO, VMD
  csv,     ///< a table for each frame
};

struct ExportedTrajectory {
  std::filesystem::path file;  ///< what to open
  LeftOut left_out;            ///< what it does not have; of all frames the most
};

/// Writes into the folder, which is there; what is there under the same names is replaced. xyz and lammps
/// have particles alone, csv and vtp whatever has a row. `period`: of the run's scene. Throws InputError if
/// the trajectory cannot be read, RunError if something cannot be written.
ExportedTrajectory export_trajectory(TrajectoryReader& trajectory, ExportFormat format, const Period& period,
                                     const std::filesystem::path& folder);

struct ExportedShapes {
  const char* name;
  std::optional<std::filesystem::path> file;  ///< absent: the trajectory has no orientation
};

/// Whether export_shapes() will ask for any hull. Throws InputError if the trajectory cannot be read.
bool shows_hulls(TrajectoryReader& trajectory);

/// What vtp's points with glyphs do not show, beside them: surfaces.pvd and axes.pvd, each if there is
/// anything to be in it; see surfaces.hpp. Throws as above, and what `hull_of` throws.
std::vector<ExportedShapes> export_shapes(TrajectoryReader& trajectory, const HullOf& hull_of,
                                          const std::filesystem::path& folder);

/// As export_trajectory(), the contacts beside a trajectory (ContactWriter), for vtp, where each is a line,
/// and csv, where each is two rows, one as each of its bodies feels it; the other formats have none, and
/// nothing is written.
std::optional<std::filesystem::path> export_contacts(TrajectoryReader& contacts, ExportFormat format,
                                                     const std::filesystem::path& folder);

}  // namespace scree
