// Converts rows of words to bodies, strictly: each cell is either used, or refused with its line and column.
#include "sim/scene/body_row.hpp"

#include "core/tolerances.hpp"
#include "sim/scene/codec.hpp"
#include "sim/scene/particle_kinds.hpp"
#include "sim/scene/scalar.hpp"
#include "sim/scene/unit_quaternion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace scree {
namespace {

struct ColumnInfo {
  std::string_view name;
  Range range;
  const char* unit;
};

/// The names, ranges and units of the columns, in the order of BodyColumn.
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

const ColumnInfo& info_of(BodyColumn column) { return columns[static_cast<std::size_t>(column)]; }

/// Returns whether the text would be a number with a point in place of its first comma.
bool is_with_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return false;
  std::string changed(text);
  changed[comma] = '.';
  return is_number(changed);
}

}  // namespace

std::string_view name_of(BodyColumn column) { return info_of(column).name; }

void RowReader::fail(BodyColumn column, const SourceMark& mark, std::string_view what) {
  const Reader::Step step(reader_, name_of(column));
  reader_.fail(mark, what);
}

BodyRow RowReader::read(const BodyCells& cells) {
  for (const BodyColumn column : {BodyColumn::x, BodyColumn::y, BodyColumn::z})
    if (cells[column].empty()) fail(column, cells.mark_of(column), "must be a number (m), not nothing");
  BodyRow row;
  row.shape = shape_of(cells);
  row.has_shape_of_entry = use_.has_sizes;
  if (!use_.has_sizes) row.size = sizes_of(cells, row.shape);
  row.position = vector_of(cells, BodyColumn::x);
  row.orientation = orientation_of(cells);
  row.velocity = vector_of(cells, BodyColumn::vx);
  row.spin = vector_of(cells, BodyColumn::wx);
  if (!cells[BodyColumn::mass].empty()) row.mass = number_of(cells, BodyColumn::mass);
  row.material = cells[BodyColumn::material];
  if (!use_.has_sizes) require_hull(cells, row.shape);
  row.hull = cells[BodyColumn::hull];
  row.servo = servo_of(cells, row);
  row.mark = {cells.mark_of(BodyColumn::shape).line, 1};
  row.material_mark = cells.mark_of(BodyColumn::material);
  row.hull_mark = cells.mark_of(BodyColumn::hull);
  row.servo_mark = cells.mark_of(BodyColumn::servo_x);
  return row;
}

Shape RowReader::shape_of(const BodyCells& cells) {
  if (use_.shape) return *use_.shape;
  const std::string_view shape = cells[BodyColumn::shape];
  if (style_ == SizeStyle::ovito) return shape_of_kind(cells);
  const auto found = std::ranges::find(shape_words, shape);
  if (found != shape_words.end())
    return shapes_of_kinds[static_cast<std::size_t>(found - shape_words.begin())];
  fail(BodyColumn::shape, cells.mark_of(BodyColumn::shape),
       fmt::format("must be one of {}, not {}{}", fmt::join(shape_words, ", "),
                   shape.empty() ? "nothing" : shape.substr(0, 40),
                   suggestion(shape, {shape_words.begin(), shape_words.end()})));
}

/// Returns the shape whose number, as `scree export` writes it, is in the column `shape`.
Shape RowReader::shape_of_kind(const BodyCells& cells) {
  const std::string_view kind = cells[BodyColumn::shape];
  for (const Shape shape : shapes_of_kinds) {
    if (kind != std::to_string(kind_of(shape))) continue;
    if (shape == Shape::polyhedron)
      fail(BodyColumn::shape, cells.mark_of(BodyColumn::shape),
           "a polyhedron's corners are not in this file; final.csv of the run has them");
    return shape;
  }
  fail(BodyColumn::shape, cells.mark_of(BodyColumn::shape),
       fmt::format("must be a kind of particle that scree writes: {}", particle_kinds));
}

void RowReader::require_hull(const BodyCells& cells, Shape shape) {
  if ((shape == Shape::polyhedron) == !cells[BodyColumn::hull].empty()) return;
  fail(BodyColumn::hull, cells.mark_of(BodyColumn::hull),
       shape == Shape::polyhedron
           ? std::string("a polyhedron needs it, an OBJ, STL or PLY file whose vertices' hull it is")
           : fmt::format("does not go with a {}; leave it empty", word_of(shape)));
}

/// Returns the servo that the row describes, if it describes one. Since a servo only moves along its axis,
/// other velocities are refused.
std::optional<Servo> RowReader::servo_of(const BodyCells& cells, const BodyRow& row) {
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

Quat RowReader::orientation_of(const BodyCells& cells) {
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

Vec3 RowReader::sizes_of(const BodyCells& cells, Shape shape) {
  return style_ == SizeStyle::ovito ? ovito_sizes_of(cells, shape) : own_sizes_of(cells, shape);
}

/// Returns the size of a body from columns as `scree export` writes them; see docs/trajectories.md, "In OVITO
/// and others".
Vec3 RowReader::ovito_sizes_of(const BodyCells& cells, Shape shape) {
  const auto positive = [&](BodyColumn column) {
    const double value = number_of(cells, column);
    if (!(value > 0))
      fail(column, cells.mark_of(column), fmt::format("a {} needs it, a number > 0 (m)", word_of(shape)));
    return value;
  };
  if (shape == Shape::sphere) return {positive(BodyColumn::radius), 0, 0};
  if (shape == Shape::box)
    return {positive(BodyColumn::size_x), positive(BodyColumn::size_y), positive(BodyColumn::size_z)};
  const double radius = positive(BodyColumn::radius), half = 0.5 * positive(BodyColumn::size_z);
  return {radius, radius, shape == Shape::capsule ? half + radius : half};
}

Vec3 RowReader::own_sizes_of(const BodyCells& cells, Shape shape) {
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
                : fmt::format("does not go with a {}; leave it empty", word_of(shape)));
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

/// Returns the vector in three columns next to each other.
Vec3 RowReader::vector_of(const BodyCells& cells, BodyColumn first) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = number_of(cells, after(first, k));
  return v;
}

/// Converts a number to SI units by the scale and offset of its column. A number that needs no conversion
/// keeps its bits.
double RowReader::in_our_units(double value, const BodyCells& cells, BodyColumn column) {
  const RowColumn& about = *cells.about[static_cast<std::size_t>(column)];
  if (about.scale != 1) value *= about.scale;
  if (about.offset != 0) value += about.offset;
  if (!std::isfinite(value) || !info_of(column).range.holds(value))
    fail(column, cells.mark_of(column), "is out of range");
  return value;
}

/// Returns the number in a cell, 0 if the cell is empty. The fast path reads most cells; the reader of the
/// scene language reads the others, or says what is wrong with them.
double RowReader::number_of(const BodyCells& cells, BodyColumn column) {
  const std::string_view text = cells[column];
  if (text.empty()) return 0;
  const ColumnInfo& info = info_of(column);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(value) &&
      info.range.holds(value))
    return in_our_units(value, cells, column);
  if (is_with_comma(text))
    fail(column, cells.mark_of(column), fmt::format("must be a number with a decimal point, not {}", text));
  Node node = Node::scalar(std::string(text));
  node.mark = cells.mark_of(column);
  const Reader::Step step(reader_, info.name);
  number(info.range, info.unit).read(value, node, reader_);
  return in_our_units(value, cells, column);
}

}  // namespace scree
