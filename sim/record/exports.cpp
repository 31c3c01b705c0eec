#include "sim/record/exports.hpp"

#include "core/bodies.hpp"
#include "core/error.hpp"
#include "sim/record/files.hpp"
#include "sim/record/vtkhdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace scree {

namespace {

namespace fs = std::filesystem;

/// One frame with all its columns, in the order of the trajectory.
struct Columns {
  TrajectoryFrame frame;
  const std::vector<TrajectoryColumn>& about;
  std::vector<std::vector<double>> numbers;

  std::size_t rows() const { return static_cast<std::size_t>(frame.rows); }
  std::optional<std::size_t> find(std::string_view name) const {
    const auto found = std::ranges::find(about, name, &TrajectoryColumn::name);
    if (found == about.end()) return std::nullopt;
    return static_cast<std::size_t>(found - about.begin());
  }
  double number(std::size_t column, std::size_t row, std::size_t component = 0) const {
    return numbers[column][row * static_cast<std::size_t>(about[column].type.columns) + component];
  }
};

Columns read_frame(TrajectoryReader& trajectory, std::size_t frame) {
  const TrajectoryIndex& index = trajectory.index();
  Columns columns{index.frames()[frame], index.columns(), {}};
  for (std::size_t c = 0; c < index.columns().size(); ++c)
    columns.numbers.push_back(trajectory.numbers(frame, c));
  return columns;
}

/// The shortest text that reads back to the same number of its type.
void append_number(std::string& text, double number, const FieldType& type) {
  const auto out = std::back_inserter(text);
  if (type.kind == FieldType::Kind::real && type.width == sizeof(float)) {
    fmt::format_to(out, "{}", static_cast<float>(number));
  } else {
    fmt::format_to(out, "{}", number);
  }
}

/// All components of a column in a row, each after `separator`.
void append_row(std::string& text, const Columns& columns, std::size_t column, std::size_t row,
                char separator) {
  const FieldType& type = columns.about[column].type;
  for (std::size_t k = 0; k < static_cast<std::size_t>(type.columns); ++k) {
    text += separator;
    append_number(text, columns.number(column, row, k), type);
  }
}

/// What particle formats need of a frame: the rows that are particles, and where their columns are.
struct Particles {
  const Columns& columns;
  std::vector<std::size_t> rows;
  std::size_t id, shape, size, material;
  std::optional<std::size_t> orientation, velocity, spin;

  bool is_sphere(std::size_t row) const {
    return columns.number(shape, row) == static_cast<double>(Shape::sphere);
  }
};

Particles particles_of(const Columns& columns) {
  const auto required = [&columns](std::string_view name) {
    if (const auto found = columns.find(name)) return *found;
    throw InputError(fmt::format("the trajectory has no {}", name));
  };
  Particles particles{columns,
                      {},
                      required("id"),
                      required("shape"),
                      required("size"),
                      required("material"),
                      columns.find("orientation"),
                      columns.find("velocity"),
                      columns.find("spin")};
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    if (!is_surface(static_cast<Shape>(columns.number(particles.shape, row)))) particles.rows.push_back(row);
  }
  return particles;
}

// Quaternions are x, y, z, w there (OVITO's manual, "Extended XYZ"). A sphere has a radius, all others half
// extents, of the boxes around them if they are none.
std::string xyz_of(const Columns& columns) {
  const Particles particles = particles_of(columns);
  std::string text =
      fmt::format("{}\nProperties=type:I:1:pos:R:3:id:I:1:material:I:1:radius:R:1:aspherical_shape:R:3",
                  particles.rows.size());
  if (particles.orientation) text += ":orientation:R:4";
  if (particles.velocity) text += ":velo:R:3";
  if (particles.spin) text += ":angular_velocity:R:3";
  fmt::format_to(std::back_inserter(text), " Time={} Timestep={} pbc=\"F F F\"\n", columns.frame.time,
                 columns.frame.step);
  const FieldType& real = columns.about[particles.size].type;
  for (const std::size_t row : particles.rows) {
    const bool is_sphere = particles.is_sphere(row);
    text += is_sphere ? '1' : '2';
    append_row(text, columns, 0, row, ' ');
    append_row(text, columns, particles.id, row, ' ');
    append_row(text, columns, particles.material, row, ' ');
    const auto half = [&](std::size_t k) { return columns.number(particles.size, row, k) / 2; };
    text += ' ';
    append_number(text, is_sphere ? half(0) : 0, real);
    for (std::size_t k = 0; k < 3; ++k) {
      text += ' ';
      append_number(text, is_sphere ? 0 : half(k), real);
    }
    if (particles.orientation) {
      for (const std::size_t k : {1, 2, 3, 0}) {
        text += ' ';
        append_number(text, columns.number(*particles.orientation, row, k), real);
      }
    }
    if (particles.velocity) append_row(text, columns, *particles.velocity, row, ' ');
    if (particles.spin) append_row(text, columns, *particles.spin, row, ' ');
    text += '\n';
  }
  return text;
}

/// The box is that of the centres: LAMMPS needs one.
std::string lammps_of(const Columns& columns) {
  const Particles particles = particles_of(columns);
  const FieldType& real = columns.about[particles.size].type;
  std::string text = fmt::format(
      "ITEM: TIMESTEP\n{}\nITEM: TIME\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n",
      columns.frame.step, columns.frame.time, particles.rows.size());
  for (std::size_t k = 0; k < 3; ++k) {
    double low = 0, high = 0;
    for (std::size_t n = 0; n < particles.rows.size(); ++n) {
      const double x = columns.number(0, particles.rows[n], k);
      low = n == 0 ? x : std::min(low, x);
      high = n == 0 ? x : std::max(high, x);
    }
    append_number(text, low, real);
    text += ' ';
    append_number(text, high, real);
    text += '\n';
  }
  text += "ITEM: ATOMS id type x y z radius shapex shapey shapez";
  if (particles.orientation) text += " quatw quati quatj quatk";
  if (particles.velocity) text += " vx vy vz";
  if (particles.spin) text += " omegax omegay omegaz";
  text += '\n';
  for (const std::size_t row : particles.rows) {
    const bool is_sphere = particles.is_sphere(row);
    // Numbers of atoms and of types begin at 1 there.
    fmt::format_to(std::back_inserter(text), "{} {}", columns.number(particles.id, row) + 1,
                   is_sphere ? 1 : 2);
    append_row(text, columns, 0, row, ' ');
    text += ' ';
    append_number(text, is_sphere ? columns.number(particles.size, row) / 2 : 0, real);
    append_row(text, columns, particles.size, row, ' ');
    if (particles.orientation) append_row(text, columns, *particles.orientation, row, ' ');
    if (particles.velocity) append_row(text, columns, *particles.velocity, row, ' ');
    if (particles.spin) append_row(text, columns, *particles.spin, row, ' ');
    text += '\n';
  }
  return text;
}

/// position_x, ... orientation_w, ... shape: as the columns are.
std::string csv_of(const Columns& columns) {
  constexpr std::string_view vector = "xyz", quaternion = "wxyz";
  std::string text;
  for (const auto& [name, type] : columns.about) {
    const std::string_view letters = type.columns == 4 ? quaternion : vector;
    for (std::size_t k = 0; k < static_cast<std::size_t>(type.columns); ++k) {
      text += text.empty() ? "" : ",";
      text += name;
      if (type.columns > 1) fmt::format_to(std::back_inserter(text), "_{}", letters.substr(k, 1));
    }
  }
  text += '\n';
  for (std::size_t row = 0; row < columns.rows(); ++row) {
    std::string line;
    for (std::size_t c = 0; c < columns.about.size(); ++c) append_row(line, columns, c, row, ',');
    text.append(line, 1);
    text += '\n';
  }
  return text;
}

template <class T>
void append_bytes(std::string& bytes, const std::vector<double>& numbers) {
  for (const double number : numbers) {
    const auto value = static_cast<T>(number);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
}

/// VTK's name for the type, and the numbers in it, after their length.
std::string_view append_block(std::string& block, const std::vector<double>& numbers, const FieldType& type) {
  using Kind = FieldType::Kind;
  const std::uint64_t bytes = numbers.size() * static_cast<std::uint64_t>(type.width);
  block.append(reinterpret_cast<const char*>(&bytes), sizeof(bytes));
  if (type.kind == Kind::natural) return append_bytes<std::uint8_t>(block, numbers), "UInt8";
  if (type.kind == Kind::integer && type.width == 8)
    return append_bytes<std::int64_t>(block, numbers), "Int64";
  if (type.kind == Kind::integer) return append_bytes<std::int32_t>(block, numbers), "Int32";
  if (type.width == 4) return append_bytes<float>(block, numbers), "Float32";
  return append_bytes<double>(block, numbers), "Float64";
}

/// The first column as points, each a vertex, or each two that follow one another a line (VTK File Formats,
/// "XML"; appended raw data).
template <Cells cells>
std::string vtp_of(const Columns& columns) {
  constexpr bool lines = cells == Cells::lines;
  std::string block, text;
  const auto add_array = [&](std::string_view name, const FieldType& type,
                             const std::vector<double>& numbers) {
    const std::size_t offset = block.size();
    const std::string_view word = append_block(block, numbers, type);
    fmt::format_to(
        std::back_inserter(text),
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        word, name, type.columns, offset);
  };
  const std::size_t rows = columns.rows(), count = lines ? rows / 2 : rows;
  fmt::format_to(
      std::back_inserter(text),
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" "
      "NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n",
      rows, lines ? 0 : count, lines ? count : 0);
  for (std::size_t c = 1; c < columns.about.size(); ++c)
    add_array(columns.about[c].name, columns.about[c].type, columns.numbers[c]);
  text += "</PointData>\n<Points>\n";
  add_array(columns.about[0].name, columns.about[0].type, columns.numbers[0]);
  text += lines ? "</Points>\n<Lines>\n" : "</Points>\n<Verts>\n";
  constexpr FieldType whole_number{FieldType::Kind::integer, sizeof(std::int64_t), 1};
  std::vector<double> numbers(rows);
  for (std::size_t row = 0; row < rows; ++row) numbers[row] = static_cast<double>(row);
  add_array("connectivity", whole_number, numbers);
  numbers.resize(count);
  for (std::size_t k = 0; k < count; ++k) numbers[k] = static_cast<double>((k + 1) * (lines ? 2 : 1));
  add_array("offsets", whole_number, numbers);
  text += lines ? "</Lines>\n" : "</Verts>\n";
  text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  text += block;
  text += "\n</AppendedData>\n</VTKFile>\n";
  return text;
}

/// Every frame into one file.
fs::path export_to_file(TrajectoryReader& trajectory, const fs::path& file,
                        std::string (*text_of)(const Columns&)) {
  AtomicFile out(file);
  for (std::size_t f = 0; f < trajectory.index().frames().size(); ++f)
    out.write(text_of(read_frame(trajectory, f)));
  out.commit();
  return file;
}

fs::path make_folder(fs::path folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunError(fmt::format("cannot make {}: {}", folder.string(), error.message()));
  return folder;
}

/// A file for each frame, named by its number.
fs::path export_to_files(TrajectoryReader& trajectory, const fs::path& folder, const char* ending,
                         std::string (*text_of)(const Columns&)) {
  make_folder(folder);
  for (std::size_t f = 0; f < trajectory.index().frames().size(); ++f)
    write_file(folder / fmt::format("{:05}.{}", f, ending), text_of(read_frame(trajectory, f)));
  return folder;
}

/// A file for each frame in the folder `name`, and NAME.pvd, which names them.
fs::path export_to_vtp(TrajectoryReader& trajectory, const fs::path& folder, const char* name,
                       const char* collection, std::string (*text_of)(const Columns&)) {
  export_to_files(trajectory, folder / name, "vtp", text_of);
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
  for (std::size_t f = 0; f < trajectory.index().frames().size(); ++f)
    fmt::format_to(std::back_inserter(text), "<DataSet timestep=\"{}\" file=\"{}/{:05}.vtp\"/>\n",
                   trajectory.index().frames()[f].time, name, f);
  text += "</Collection>\n</VTKFile>\n";
  fs::path file = folder / collection;
  write_file(file, text);
  return file;
}

}  // namespace

fs::path export_trajectory(TrajectoryReader& trajectory, ExportFormat format, const fs::path& folder) {
  switch (format) {
    case ExportFormat::xyz:
      return export_to_file(trajectory, folder / "trajectory.xyz", xyz_of);
    case ExportFormat::lammps:
      return export_to_file(trajectory, folder / "trajectory.lammpstrj", lammps_of);
    case ExportFormat::csv:
      return export_to_files(trajectory, folder / "csv", "csv", csv_of);
    case ExportFormat::vtp:
      break;
  }
  return export_to_vtp(trajectory, folder, "vtp", "trajectory.pvd", vtp_of<Cells::vertices>);
}

std::optional<fs::path> export_contacts(TrajectoryReader& contacts, ExportFormat format,
                                        const fs::path& folder) {
  if (format == ExportFormat::csv) return export_to_files(contacts, folder / "contacts", "csv", csv_of);
  if (format != ExportFormat::vtp) return std::nullopt;
  return export_to_vtp(contacts, folder, "contacts", "contacts.pvd", vtp_of<Cells::lines>);
}

}  // namespace scree
