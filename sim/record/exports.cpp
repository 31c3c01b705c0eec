#include "sim/record/exports.hpp"

#include "core/bodies.hpp"
#include "core/error.hpp"
#include "sim/record/export_frame.hpp"
#include "sim/record/files.hpp"
#include "sim/record/vtk_poly_data.hpp"
#include "sim/record/vtkhdf.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace scree {

namespace {

namespace fs = std::filesystem;

/// Returns a table of the columns in their order: position_x, ... orientation_w, ... shape.
std::string csv_of(const ExportFrame& frame) {
  constexpr std::string_view vector = "xyz", quaternion = "wxyz";
  std::string text;
  for (const auto& [name, type] : frame.about) {
    const std::string_view letters = type.columns == 4 ? quaternion : vector;
    for (std::size_t k = 0; k < static_cast<std::size_t>(type.columns); ++k) {
      text += text.empty() ? "" : ",";
      text += name;
      if (type.columns > 1) fmt::format_to(std::back_inserter(text), "_{}", letters.substr(k, 1));
    }
  }
  text += '\n';
  for (std::size_t row = 0; row < frame.rows(); ++row) {
    std::string line;
    for (std::size_t c = 0; c < frame.about.size(); ++c) append_row(line, frame, c, row, ',');
    text.append(line, 1);
    text += '\n';
  }
  return text;
}

/// Returns PolyData with the first column as points. Each point is a vertex, or each two consecutive points
/// are the ends of a line. Consumes the numbers of the frame, as there may be many.
template <Cells cells>
std::string vtp_of(ExportFrame& frame) {
  constexpr bool lines = cells == Cells::lines;
  VtkPolyData data;
  data.kind = lines ? VtkPolyData::Kind::lines : VtkPolyData::Kind::vertices;
  const auto rows = static_cast<std::int64_t>(frame.rows());
  const auto array = [&frame](std::size_t c) {
    return VtkPolyData::Array{frame.about[c].name, frame.about[c].type, std::move(frame.numbers[c])};
  };
  data.points = array(0);
  for (std::size_t c = 1; c < frame.about.size(); ++c) data.point_data.push_back(array(c));
  for (std::int64_t row = 0; row < rows; row += lines ? 2 : 1) {
    const std::array<std::int64_t, 2> points = {row, row + 1};
    data.add_cell(std::span(points).first(lines ? 2 : 1));
  }
  return data.text();
}

using TextOf = std::function<std::string(ExportFrame&)>;

/// Writes all frames into one file.
fs::path export_to_file(TrajectoryReader& trajectory, const fs::path& file, const TextOf& text_of) {
  AtomicFile out(file);
  for (std::size_t f = 0; f < trajectory.index().frames().size(); ++f) {
    ExportFrame frame = read_export_frame(trajectory, f);
    out.write(text_of(frame));
  }
  out.commit();
  return file;
}

fs::path make_folder(fs::path folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunError(fmt::format("cannot make {}: {}", folder.string(), error.message()));
  return folder;
}

/// Writes a file for each frame, named by its number.
fs::path export_to_files(TrajectoryReader& trajectory, const fs::path& folder, const char* ending,
                         const TextOf& text_of) {
  make_folder(folder);
  for (std::size_t f = 0; f < trajectory.index().frames().size(); ++f) {
    ExportFrame frame = read_export_frame(trajectory, f);
    write_file(folder / fmt::format("{:05}.{}", f, ending), text_of(frame));
  }
  return folder;
}

/// A PVD file: a list of files with their times, in parts.
class PvdFile {
 public:
  void add(double time, std::optional<std::size_t> part, const std::string& file) {
    const auto out = std::back_inserter(sets_);
    fmt::format_to(out, "<DataSet timestep=\"{}\"", time);
    if (part) fmt::format_to(out, " part=\"{}\"", *part);
    fmt::format_to(out, " file=\"{}\"/>\n", file);
  }
  fs::path write(fs::path file) const {
    write_file(file,
               "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" +
                   sets_ + "</Collection>\n</VTKFile>\n");
    return file;
  }

 private:
  std::string sets_;
};

/// Writes a file for each frame in the folder `name`, and the file `collection` with their names.
fs::path export_to_vtp(TrajectoryReader& trajectory, const fs::path& folder, const char* name,
                       const char* collection, const TextOf& text_of) {
  export_to_files(trajectory, folder / name, "vtp", text_of);
  PvdFile pvd;
  for (std::size_t f = 0; f < trajectory.index().frames().size(); ++f)
    pvd.add(trajectory.index().frames()[f].time, std::nullopt, fmt::format("{}/{:05}.vtp", name, f));
  return pvd.write(folder / collection);
}

/// The files of one kind of shapes in all frames, and how they are made.
struct ShapeFiles {
  const char* name;
  bool (*holds)(Shape shape);
  std::string (*text_of)(const ExportFrame&, Movement, const HullOf&);
};
constexpr std::array<ShapeFiles, 2> shape_files = {
    {{"surfaces", has_surface, surfaces_of}, {"axes", has_axis, axes_of}}};
constexpr std::array<const char*, 2> movement_words = {"fixed", "moving"};  // words in the order of Movement

/// Returns, for each Movement, whether any frame has bodies of such shapes.
std::array<bool, 2> census(TrajectoryReader& trajectory, bool (*holds)(Shape)) {
  std::array<bool, 2> found{};
  const int shape = trajectory.column("shape"), mobility = trajectory.column("mobility");
  if (shape < 0 || mobility < 0) throw InputError("the trajectory has no shape or no mobility");
  for (std::size_t f = 0; f < trajectory.index().frames().size(); ++f) {
    const std::vector<double> shapes = trajectory.numbers(f, static_cast<std::size_t>(shape));
    const std::vector<double> mobilities = trajectory.numbers(f, static_cast<std::size_t>(mobility));
    for (std::size_t row = 0; row < shapes.size(); ++row) {
      if (!holds(static_cast<Shape>(shapes[row]))) continue;
      const bool fixed = mobilities[row] == static_cast<double>(Mobility::fixed);
      found[static_cast<std::size_t>(fixed ? Movement::fixed : Movement::not_fixed)] = true;
    }
  }
  return found;
}

/// Writes a part of the collection for each kind of movement that there is. A frame that is equal to the one
/// before has no file of its own.
fs::path export_shape_files(TrajectoryReader& trajectory, const ShapeFiles& files,
                            const std::array<bool, 2>& found, const HullOf& hull_of, const fs::path& folder) {
  make_folder(folder / files.name);
  PvdFile pvd;
  std::array<std::string, 2> last_text, last_file;
  for (std::size_t f = 0; f < trajectory.index().frames().size(); ++f) {
    const ExportFrame frame = read_export_frame(trajectory, f);
    for (std::size_t m = 0; m < found.size(); ++m) {
      if (!found[m]) continue;
      std::string text = files.text_of(frame, static_cast<Movement>(m), hull_of);
      if (text != last_text[m]) {
        last_file[m] = fmt::format("{}/{}{:05}.vtp", files.name, movement_words[m], f);
        write_file(folder / last_file[m], text);
        last_text[m] = std::move(text);
      }
      pvd.add(frame.frame.time, m, last_file[m]);
    }
  }
  return pvd.write(folder / (std::string(files.name) + ".pvd"));
}

}  // namespace

ExportedTrajectory export_trajectory(TrajectoryReader& trajectory, ExportFormat format, const Period& period,
                                     const fs::path& folder) {
  LeftOut left_out;
  const auto particles = [&](auto text_of) {
    return [&, text_of](const ExportFrame& frame) {
      LeftOut of_frame;
      std::string text = text_of(frame, period, of_frame);
      left_out.include(of_frame);
      return text;
    };
  };
  fs::path file;
  switch (format) {
    case ExportFormat::xyz:
      file = export_to_file(trajectory, folder / "trajectory.xyz", particles(xyz_of));
      break;
    case ExportFormat::lammps:
      file = export_to_file(trajectory, folder / "trajectory.lammpstrj", particles(lammps_of));
      break;
    case ExportFormat::csv:
      file = export_to_files(trajectory, folder / "csv", "csv", csv_of);
      break;
    case ExportFormat::vtp:
      file = export_to_vtp(trajectory, folder, "vtp", "trajectory.pvd", vtp_of<Cells::vertices>);
      break;
  }
  return {file, left_out};
}

bool shows_hulls(TrajectoryReader& trajectory) {
  if (trajectory.column("orientation") < 0) return false;
  const std::array<bool, 2> found =
      census(trajectory, [](Shape shape) { return shape == Shape::polyhedron; });
  return found[0] || found[1];
}

std::vector<ExportedShapes> export_shapes(TrajectoryReader& trajectory, const HullOf& hull_of,
                                          const fs::path& folder) {
  std::vector<ExportedShapes> exported;
  for (const ShapeFiles& files : shape_files) {
    const std::array<bool, 2> found = census(trajectory, files.holds);
    if (!found[0] && !found[1]) continue;
    exported.push_back({files.name, std::nullopt});
    if (trajectory.column("orientation") < 0) continue;
    exported.back().file = export_shape_files(trajectory, files, found, hull_of, folder);
  }
  return exported;
}

std::optional<fs::path> export_contacts(TrajectoryReader& contacts, ExportFormat format,
                                        const fs::path& folder) {
  if (format == ExportFormat::csv) return export_to_files(contacts, folder / "contacts", "csv", csv_of);
  if (format != ExportFormat::vtp) return std::nullopt;
  return export_to_vtp(contacts, folder, "contacts", "contacts.pvd", vtp_of<Cells::lines>);
}

}  // namespace scree
