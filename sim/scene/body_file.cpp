// Rows of text to bodies, strict: what a cell says is taken, or refused at its place.
#include "sim/scene/body_file.hpp"

#include "core/tolerances.hpp"
#include "sim/scene/codec.hpp"
#include "sim/scene/unit_quaternion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>

namespace scree {
namespace {

namespace fs = std::filesystem;

struct ColumnInfo {
  std::string_view name;
  Range range;
  const char* unit;
};

/// In the order of BodyColumn.
constexpr std::array<ColumnInfo, body_columns> columns = {{
    {"shape", any_value, ""},        {"radius", above_zero, "m"}, {"size_x", above_zero, "m"},
    {"size_y", above_zero, "m"},     {"size_z", above_zero, "m"}, {"x", any_value, "m"},
    {"y", any_value, "m"},           {"z", any_value, "m"},       {"qw", any_value, ""},
    {"qx", any_value, ""},           {"qy", any_value, ""},       {"qz", any_value, ""},
    {"vx", any_value, "m/s"},        {"vy", any_value, "m/s"},    {"vz", any_value, "m/s"},
    {"wx", any_value, "rad/s"},      {"wy", any_value, "rad/s"},  {"wz", any_value, "rad/s"},
    {"mass", above_zero, "kg"},      {"material", any_value, ""}, {"hull", any_value, ""},
    {"servo_x", any_value, ""},      {"servo_y", any_value, ""},  {"servo_z", any_value, ""},
    {"servo_force", any_value, "N"},
}};
constexpr std::array required = {BodyColumn::shape, BodyColumn::x, BodyColumn::y, BodyColumn::z};

const ColumnInfo& info_of(BodyColumn column) { return columns[static_cast<std::size_t>(column)]; }
BodyColumn after(BodyColumn column, int by) { return static_cast<BodyColumn>(static_cast<int>(column) + by); }

std::string all_names() {
  std::vector<std::string_view> names;
  for (const ColumnInfo& column : columns) names.push_back(column.name);
  return fmt::format("{}", fmt::join(names, ","));
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The lines that are not blank, one at a time, each of bounded length and plain text.
class Lines {
 public:
  Lines(const fs::path& file, const Reader& reader) : reader_(reader), stream_(file, std::ios::binary) {
    if (!stream_) reader.fail({1, 1}, fmt::format("cannot be read: {}", std::strerror(errno)));
  }

  /// False at the end of the file.
  bool next(std::string_view& line) {
    while (stream_.getline(buffer_.data(), std::ssize(buffer_)) || stream_.gcount() > 0) {
      ++number_;
      if (stream_.fail())
        reader_.fail({number_, 1}, fmt::format("is longer than {} bytes", buffer_.size() - 1));
      const auto length = static_cast<std::size_t>(stream_.gcount()) - (stream_.eof() ? 0 : 1);
      line = {buffer_.data(), length};
      if (number_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);  // of spreadsheets
      refuse_bytes(line);
      if (!trimmed(line).empty()) return true;
    }
    return false;
  }

  int number() const { return number_; }

 private:
  void refuse_bytes(std::string_view line) const {
    const auto bad = std::find_if(line.begin(), line.end(),
                                  [](char c) { return (c < ' ' && c != '\t' && c != '\r') || c == 0x7F; });
    if (bad == line.end()) return;
    reader_.fail({number_, static_cast<int>(bad - line.begin()) + 1},
                 fmt::format("byte 0x{:02X} is no text of a body file", static_cast<unsigned char>(*bad)));
  }

  const Reader& reader_;
  std::ifstream stream_;
  std::array<char, 4096> buffer_{};
  int number_ = 0;
};

/// The cells of a line: where each starts, and what is in it without the blanks around it.
template <class F>
void for_each_cell(std::string_view line, F&& f) {
  for (std::size_t start = 0, cell = 0;; ++cell) {
    const std::size_t end = std::min(line.find(',', start), line.size());
    const std::string_view text = trimmed(line.substr(start, end - start));
    f(cell, text,
      static_cast<int>(text.empty() ? start : static_cast<std::size_t>(text.data() - line.data())) + 1);
    if (end == line.size()) return;
    start = end + 1;
  }
}

}  // namespace

/// One row by columns; cells of columns that the file does not have are empty.
struct BodyFile::Cells {
  std::array<std::string_view, body_columns> text;
  std::array<SourceMark, body_columns> mark;

  std::string_view operator[](BodyColumn column) const { return text[static_cast<std::size_t>(column)]; }
  const SourceMark& mark_of(BodyColumn column) const { return mark[static_cast<std::size_t>(column)]; }
};

std::string_view name_of(BodyColumn column) { return info_of(column).name; }

fs::path find_body_file(const fs::path& path) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{} {}", path.string(), what));
  };
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    fail(fmt::format("cannot be read: {}", std::strerror(error ? error.value() : ENOENT)));
  if (fs::is_directory(status)) {
    if (!fs::is_regular_file(path / "final.csv", error))
      fail("is a folder without final.csv, which a run writes when it is done");
    return path / "final.csv";
  }
  if (!fs::is_regular_file(status)) fail("is neither a file nor a folder");
  return path;
}

BodyFile::BodyFile(const fs::path& file) : file_(file), reader_(file.string(), {}) {
  Lines lines(file_, reader_);
  std::string_view line;
  if (!lines.next(line))
    reader_.fail({1, 1},
                 fmt::format("the file is empty; its first line names the columns, of {}", all_names()));
  read_header(line, lines.number());
  while (lines.next(line)) ++count_;
  if (count_ == 0) reader_.fail({lines.number(), 1}, "there are no bodies, only the names of the columns");
}

void BodyFile::fail(BodyColumn column, const SourceMark& mark, std::string_view what) {
  const Reader::Step step(reader_, name_of(column));
  reader_.fail(mark, what);
}

void BodyFile::read_header(std::string_view line, int number) {
  for_each_cell(line, [&](std::size_t, std::string_view name, int place) {
    const SourceMark mark{number, place};
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&](const ColumnInfo& column) { return column.name == name; });
    if (found == columns.end()) {
      std::vector<std::string_view> known;
      for (const ColumnInfo& column : columns) known.push_back(column.name);
      std::string hint = suggestion(name, known);
      if (hint.empty()) hint = fmt::format(" (known: {})", all_names());
      reader_.fail(mark, fmt::format("unknown column {}{}", name.substr(0, 40), hint));
    }
    const auto column = static_cast<BodyColumn>(found - columns.begin());
    if (std::find(columns_.begin(), columns_.end(), column) != columns_.end())
      fail(column, mark, "the column is there twice");
    columns_.push_back(column);
  });
  const auto is_missing = [&](BodyColumn column) {
    return std::find(columns_.begin(), columns_.end(), column) == columns_.end();
  };
  for (const BodyColumn column : required)
    if (is_missing(column)) fail(column, {number, 1}, "the column is missing; shape, x, y and z are needed");
}

void BodyFile::read(const std::function<void(const BodyRow&)>& take) {
  Lines lines(file_, reader_);
  std::string_view line;
  lines.next(line);
  std::int64_t rows = 0;
  while (lines.next(line)) {
    if (++rows > count_) break;
    take(row_of(cells_of(line, lines.number())));
  }
  if (rows != count_) reader_.fail({lines.number(), 1}, "the file changed while it was read");
}

BodyFile::Cells BodyFile::cells_of(std::string_view line, int number) const {
  Cells cells;
  cells.mark.fill({number, 1});
  std::size_t given = 0;
  for_each_cell(line, [&](std::size_t cell, std::string_view text, int place) {
    given = cell + 1;
    if (cell >= columns_.size()) return;
    const auto column = static_cast<std::size_t>(columns_[cell]);
    cells.text[column] = text;
    cells.mark[column] = {number, place};
  });
  if (given != columns_.size())
    reader_.fail({number, 1},
                 fmt::format("has {} cells; the header names {} columns", given, columns_.size()));
  return cells;
}

BodyRow BodyFile::row_of(const Cells& cells) {
  for (const BodyColumn column : {BodyColumn::x, BodyColumn::y, BodyColumn::z})
    if (cells[column].empty()) fail(column, cells.mark_of(column), "must be a number (m), not nothing");
  BodyRow row;
  row.shape = shape_of(cells);
  row.size = sizes_of(cells, row.shape);
  row.position = vector_of(cells, BodyColumn::x);
  row.orientation = orientation_of(cells);
  row.velocity = vector_of(cells, BodyColumn::vx);
  row.spin = vector_of(cells, BodyColumn::wx);
  if (!cells[BodyColumn::mass].empty()) row.mass = number_of(cells, BodyColumn::mass);
  row.material = cells[BodyColumn::material];
  require_hull(cells, row.shape);
  row.hull = cells[BodyColumn::hull];
  row.servo = servo_of(cells, row);
  row.mark = {cells.mark_of(BodyColumn::shape).line, 1};
  row.material_mark = cells.mark_of(BodyColumn::material);
  row.hull_mark = cells.mark_of(BodyColumn::hull);
  row.servo_mark = cells.mark_of(BodyColumn::servo_x);
  return row;
}

Shape BodyFile::shape_of(const Cells& cells) {
  const std::string_view shape = cells[BodyColumn::shape];
  if (shape == "sphere") return Shape::sphere;
  if (shape == "box") return Shape::box;
  if (shape == "capsule") return Shape::capsule;
  if (shape == "cylinder") return Shape::cylinder;
  if (shape == "polyhedron") return Shape::polyhedron;
  fail(BodyColumn::shape, cells.mark_of(BodyColumn::shape),
       fmt::format("must be one of sphere, box, capsule, cylinder, polyhedron, not {}{}",
                   shape.empty() ? "nothing" : shape.substr(0, 40),
                   suggestion(shape, {"sphere", "box", "capsule", "cylinder", "polyhedron"})));
}

void BodyFile::require_hull(const Cells& cells, Shape shape) {
  if ((shape == Shape::polyhedron) == !cells[BodyColumn::hull].empty()) return;
  fail(BodyColumn::hull, cells.mark_of(BodyColumn::hull),
       shape == Shape::polyhedron
           ? std::string("a polyhedron needs it, an OBJ, STL or PLY file whose vertices' hull it is")
           : fmt::format("does not go with a {}; leave it empty", cells[BodyColumn::shape]));
}

/// It moves along its axis alone.
std::optional<Servo> BodyFile::servo_of(const Cells& cells, const BodyRow& row) {
  const auto fail_at = [&](BodyColumn column, const char* what) {
    fail(column, cells.mark_of(column), what);
  };
  int given = 0;
  for (int k = 0; k < 4; ++k) given += !cells[after(BodyColumn::servo_x, k)].empty();
  if (given == 0) return {};
  for (int k = 0; k < 4; ++k)
    if (const BodyColumn column = after(BodyColumn::servo_x, k); cells[column].empty())
      fail_at(column, "must be a number, as the others of servo_x, servo_y, servo_z, servo_force");
  if (row.shape != Shape::box) fail_at(BodyColumn::servo_x, "goes with a box alone");
  Servo servo{.body = -1,
              .axis = vector_of(cells, BodyColumn::servo_x),
              .force = number_of(cells, BodyColumn::servo_force)};
  const double length = servo.axis.stableNorm();
  if (!(length > 0)) fail_at(BodyColumn::servo_x, "the axis must not be zero");
  if (std::abs(length - 1) > tolerance::unit_length) servo.axis = servo.axis.stableNormalized();
  const double across = (row.velocity - servo.axis.dot(row.velocity) * servo.axis).stableNorm();
  if (!(across <= tolerance::unit_length * row.velocity.stableNorm()))
    fail_at(BodyColumn::vx, "must be along the axis of the servo");
  if (row.spin != Vec3::Zero()) fail_at(BodyColumn::wx, "must be zero: a servo does not turn");
  return servo;
}

Quat BodyFile::orientation_of(const Cells& cells) {
  int given = 0;
  for (int k = 0; k < 4; ++k) given += !cells[after(BodyColumn::qw, k)].empty();
  if (given == 0) return Quat::Identity();
  for (int k = 0; k < 4; ++k) {
    const BodyColumn column = after(BodyColumn::qw, k);
    if (cells[column].empty())
      fail(column, cells.mark_of(column), "must be a number, as the others of qw, qx, qy, qz");
  }
  const Vec3 imaginary = vector_of(cells, BodyColumn::qx);
  const std::optional<Quat> unit = unit_quaternion(number_of(cells, BodyColumn::qw), imaginary);
  if (!unit) fail(BodyColumn::qw, cells.mark_of(BodyColumn::qw), "the quaternion must not be zero");
  return *unit;
}

Vec3 BodyFile::sizes_of(const Cells& cells, Shape shape) {
  const bool along = shape == Shape::capsule || shape == Shape::cylinder;
  for (int k = 0; k < 4; ++k) {
    const BodyColumn column = after(BodyColumn::radius, k);
    const bool wanted = shape == Shape::box ? column != BodyColumn::radius
                        : shape == Shape::sphere
                            ? column == BodyColumn::radius
                            : along && (column == BodyColumn::radius || column == BodyColumn::size_z);
    if (wanted == !cells[column].empty()) continue;
    fail(column, cells.mark_of(column),
         wanted ? fmt::format("a {} needs it, a number > 0 (m)", cells[BodyColumn::shape])
                : fmt::format("does not go with a {}; leave it empty", cells[BodyColumn::shape]));
  }
  if (shape == Shape::polyhedron) return Vec3::Zero();
  const double radius = number_of(cells, BodyColumn::radius);
  if (shape == Shape::sphere) return Vec3(radius, 0, 0);
  if (along) {
    const double half = 0.5 * number_of(cells, BodyColumn::size_z);
    if (shape == Shape::capsule && !(half > radius))
      fail(BodyColumn::size_z, cells.mark_of(BodyColumn::size_z),
           "a capsule's length from end to end exceeds two radii");
    return Vec3(radius, radius, half);
  }
  return 0.5 * vector_of(cells, BodyColumn::size_x);
}

/// Of three columns next to each other.
Vec3 BodyFile::vector_of(const Cells& cells, BodyColumn first) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = number_of(cells, after(first, k));
  return v;
}

/// 0 for an empty cell. The quick way takes most cells; the scene language's own reader takes the rest, or
/// says what is wrong with them.
double BodyFile::number_of(const Cells& cells, BodyColumn column) {
  const std::string_view text = cells[column];
  if (text.empty()) return 0;
  const ColumnInfo& info = info_of(column);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(value) &&
      info.range.holds(value))
    return value;
  Node node = Node::scalar(std::string(text));
  node.mark = cells.mark_of(column);
  const Reader::Step step(reader_, info.name);
  number(info.range, info.unit).read(value, node, reader_);
  return value;
}

}  // namespace scree
