// Bodies from a CSV file: a line that names the columns, then one line per body.
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/reader.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace scree {

/// The columns of a body file, in the order in which runs write them; those from `hull` on, where a body
/// needs them. shape, x, y and z are required, and the sizes that the shapes need.
enum class BodyColumn {
  shape,   ///< sphere, box, capsule, cylinder or polyhedron
  radius,  ///< of a sphere, capsule or cylinder (m); empty for a box
  size_x,  ///< full edge lengths of a box (m), size_z that of a capsule or cylinder; else empty
  size_y,
  size_z,
  x,  ///< of the centre (m)
  y,
  z,
  qw,  ///< orientation, a quaternion of any length but 0; all four or none
  qx,
  qy,
  qz,
  vx,  ///< velocity of the centre (m/s)
  vy,
  vz,
  wx,  ///< spin, world frame (rad/s)
  wy,
  wz,
  mass,      ///< kg; empty: from the material's density
  material,  ///< a name of the scene's materials
  hull,      ///< of a polyhedron: the OBJ, STL or PLY file whose vertices' hull it is, relative to the body file
  servo_x,   ///< of a servo: the axis along which it moves; with servo_force all four or none
  servo_y,
  servo_z,
  servo_force,  ///< N
};
inline constexpr int body_columns = static_cast<int>(BodyColumn::servo_force) + 1;
std::string_view name_of(BodyColumn column);

/// One row.
struct BodyRow {
  Shape shape = Shape::sphere;
  Vec3 size = Vec3::Zero();  ///< as in Shape; of a polyhedron unknown
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();
  std::optional<double> mass;
  std::string_view material;   ///< empty: not given
  std::string_view hull;       ///< empty: not given
  std::optional<Servo> servo;  ///< of no body yet
  SourceMark mark;             ///< of the row
  SourceMark material_mark;
  SourceMark hull_mark;
  SourceMark servo_mark;
};

/// The file that a path names: itself, or the final state in a run's folder. Throws InputError, without a
/// place, if there is none.
std::filesystem::path find_body_file(const std::filesystem::path& path);

class BodyFile {
 public:
  /// Reads the header and counts the rows, in constant memory. Throws InputError: file:line:column, the
  /// column's name, what is allowed.
  explicit BodyFile(const std::filesystem::path& file);

  std::int64_t count() const { return count_; }  ///< of bodies; at least 1

  /// Calls `take` with each row in order. Throws like the constructor.
  void read(const std::function<void(const BodyRow&)>& take);

  /// The file that a row names.
  std::filesystem::path hull_file(const BodyRow& row) const { return file_.parent_path() / row.hull; }

  [[noreturn]] void fail(BodyColumn column, const SourceMark& mark, std::string_view what);

 private:
  struct Cells;
  void read_header(std::string_view line, int number);
  Cells cells_of(std::string_view line, int number) const;
  BodyRow row_of(const Cells& cells);
  Shape shape_of(const Cells& cells);
  Vec3 sizes_of(const Cells& cells, Shape shape);
  Quat orientation_of(const Cells& cells);
  void require_hull(const Cells& cells, Shape shape);
  std::optional<Servo> servo_of(const Cells& cells, const BodyRow& row);
  Vec3 vector_of(const Cells& cells, BodyColumn first);
  double number_of(const Cells& cells, BodyColumn column);

  std::filesystem::path file_;
  Reader reader_;
  std::vector<BodyColumn> columns_;  // of the header
  std::int64_t count_ = 0;
};

}  // namespace scree
