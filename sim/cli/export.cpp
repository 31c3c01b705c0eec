// scree export: the trajectory of a run in the formats of other programs.
#include "core/error.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/output_folder.hpp"
#include "sim/record/contact_writer.hpp"
#include "sim/record/exports.hpp"
#include "sim/record/outcome.hpp"
#include "sim/record/trajectory_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <system_error>

namespace scree::cli {

namespace {
// In the order of ExportFormat.
constexpr std::array<const char*, 4> format_words = {"vtp", "xyz", "lammps", "csv"};
}  // namespace

int export_trajectory(const ExportArguments& arguments) {
  TrajectoryReader trajectory(arguments.run / trajectory_name);
  const std::filesystem::path folder = output_folder(
      arguments.output, arguments.run, format_words[static_cast<std::size_t>(arguments.format)]);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(
        fmt::format("cannot make {}: {}; give another folder with -o", folder.string(), error.message()));
  const std::filesystem::path file = scree::export_trajectory(trajectory, arguments.format, folder);
  fmt::print("{} frames: {}\n", trajectory.index().frames().size(), file.string());
  if (!std::filesystem::exists(arguments.run / contacts_name)) return status_done;
  TrajectoryReader contacts(arguments.run / contacts_name);
  if (const auto lines = export_contacts(contacts, arguments.format, folder))
    fmt::print("contacts:  {}\n", lines->string());
  return status_done;
}

}  // namespace scree::cli
