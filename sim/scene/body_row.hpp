// One row of a file of bodies: from its words to a body.
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/row_source.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace scree {

/// One row.
struct BodyRow {
  Shape shape = Shape::sphere;
  bool has_shape_of_entry = false;  ///< the scene gives the size too
  Vec3 size = Vec3::Zero();         ///< as in Shape; of a polyhedron, or if the scene gives it, unknown
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

/// What a scene says of a file's bodies beside it.
struct BodyFileUse {
  std::optional<std::int64_t> frame = {};  ///< the last one if not given
  std::optional<Shape> shape = {};         ///< of all bodies
  bool has_sizes = false;                  ///< the scene gives these too
};

/// One row by columns; cells of columns that the file does not have are empty.
struct BodyCells {
  std::array<std::string_view, body_columns> text;
  std::array<SourceMark, body_columns> mark;
  std::array<const RowColumn*, body_columns> about{};  ///< null: the file has no such column

  std::string_view operator[](BodyColumn column) const { return text[static_cast<std::size_t>(column)]; }
  const SourceMark& mark_of(BodyColumn column) const { return mark[static_cast<std::size_t>(column)]; }
};

class RowReader {
 public:
  /// The reader must outlive it.
  RowReader(SizeStyle style, const BodyFileUse& use, Reader& reader)
      : style_(style), use_(use), reader_(reader) {}

  /// Throws InputError: file:line:column, the column's name, what is allowed. The row's texts are those of
  /// the cells.
  BodyRow read(const BodyCells& cells);

 private:
  [[noreturn]] void fail(BodyColumn column, const SourceMark& mark, std::string_view what);
  Shape shape_of(const BodyCells& cells);
  Shape shape_of_kind(const BodyCells& cells);
  Vec3 sizes_of(const BodyCells& cells, Shape shape);
  Vec3 own_sizes_of(const BodyCells& cells, Shape shape);
  Vec3 ovito_sizes_of(const BodyCells& cells, Shape shape);
  Quat orientation_of(const BodyCells& cells);
  void require_hull(const BodyCells& cells, Shape shape);
  std::optional<Servo> servo_of(const BodyCells& cells, const BodyRow& row);
  Vec3 vector_of(const BodyCells& cells, BodyColumn first);
  double number_of(const BodyCells& cells, BodyColumn column);
  double in_our_units(double value, const BodyCells& cells, BodyColumn column);

  SizeStyle style_;
  BodyFileUse use_;
  Reader& reader_;
};

}  // namespace scree
