// scree export: writes the trajectory of a run in the formats of other programs.
#include "core/error.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/output_folder.hpp"
#include "sim/record/contact_writer.hpp"
#include "sim/record/exports.hpp"
#include "sim/record/outcome.hpp"
#include "sim/record/trajectory_reader.hpp"
#include "sim/scene/particle_kinds.hpp"
#include "sim/scene/read_period.hpp"
#include "sim/scene/scene.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace scree::cli {

namespace {

namespace fs = std::filesystem;

// The words in the order of ExportFormat.
constexpr std::array<const char*, 4> format_words = {"vtp", "xyz", "lammps", "csv"};

/// Returns the period of the run's space if the format can hold it: only xyz and lammps can.
Period period_of_run(const ExportArguments& arguments) {
  if (arguments.format != ExportFormat::xyz && arguments.format != ExportFormat::lammps) return {};
  return read_period(arguments.run / "scene.yaml");
}

void print_particles(const LeftOut& left_out) {
  fmt::print("types:     {}\n", particle_kinds);
  if (left_out.any())
    fmt::print("left out:  {}, which are no particles (vtp and csv have them)\n", left_out.words());
}

/// The hulls of a run's scene, which is read only if there are any.
class Hulls {
 public:
  Hulls(const ExportArguments& arguments, TrajectoryReader& trajectory)
      : file_(arguments.run / "scene.yaml") {
    if (arguments.format == ExportFormat::vtp && shows_hulls(trajectory)) scene_ = read_scene(file_);
  }

  const Hull& of(std::int32_t body) const {
    if (!scene_ || body < 0 || body >= scene_->bodies.count() || !scene_->geometry ||
        !scene_->geometry->of_body[static_cast<std::size_t>(body)].hull)
      throw InputError(fmt::format("the trajectory is of other bodies than {}", file_.string()));
    return *scene_->geometry->of_body[static_cast<std::size_t>(body)].hull;
  }

 private:
  fs::path file_;
  std::optional<Scene> scene_;
};

void export_vtp_shapes(TrajectoryReader& trajectory, const Hulls& hulls, const fs::path& folder) {
  const auto hull_of = [&hulls](std::int32_t body) -> const Hull& { return hulls.of(body); };
  for (const auto& [name, file] : export_shapes(trajectory, hull_of, folder))
    fmt::print("{:<11}{}\n", std::string(name) + ":",
               file ? file->string() : "none: the trajectory has no orientation");
}

}  // namespace

int export_trajectory(const ExportArguments& arguments) {
  TrajectoryReader trajectory(arguments.run / trajectory_name);
  const Period period = period_of_run(arguments);
  const Hulls hulls(arguments, trajectory);
  const fs::path folder = output_folder(arguments.output, arguments.run,
                                        format_words[static_cast<std::size_t>(arguments.format)]);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw InputError(
        fmt::format("cannot make {}: {}; give another folder with -o", folder.string(), error.message()));
  const auto [file, left_out] = scree::export_trajectory(trajectory, arguments.format, period, folder);
  fmt::print("{} frames: {}\n", trajectory.index().frames().size(), file.string());
  if (arguments.format == ExportFormat::vtp) export_vtp_shapes(trajectory, hulls, folder);
  if (arguments.format == ExportFormat::xyz || arguments.format == ExportFormat::lammps)
    print_particles(left_out);
  if (!fs::exists(arguments.run / contacts_name)) return status_done;
  TrajectoryReader contacts(arguments.run / contacts_name);
  if (const auto lines = export_contacts(contacts, arguments.format, folder))
    fmt::print("contacts:  {}\n", lines->string());
  return status_done;
}

}  // namespace scree::cli
