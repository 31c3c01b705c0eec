// One row of a file of bodies, and its conversion from words to a body.
#pragma once

#include "core/bodies.hpp"
#include "sim/scene/row_source.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace scree {

/// The body that one row describes.
struct BodyRow {
  Shape shape = Shape::sphere;
  bool has_shape_of_entry = false;  ///< the scene gives the shape with its size
  Vec3 size = Vec3::Zero();         ///< as in Shape; unknown for a polyhedron, or if the scene gives the size
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();
  std::optional<double> mass;
  std::string_view material;   ///< name or index of the material; empty: not given
  std::string_view hull;       ///< file of the hull; empty: not given
  std::optional<Servo> servo;  ///< the servo, without the number of its body
  SourceMark mark;             ///< start of the row
  SourceMark material_mark;
  SourceMark hull_mark;
  SourceMark servo_mark;
};

/// The keys that a scene gives beside the file of bodies.
struct BodyFileUse {
  std::optional<std::int64_t> frame = {};  ///< number of the frame; absent: the last one
  std::optional<Shape> shape = {};         ///< shape of all bodies; absent: given by the file
  bool has_sizes = false;                  ///< the scene gives the size of the shape too
};

/// The cells of one row by columns. Cells of columns that the file does not have are empty.
struct BodyCells {
  std::array<std::string_view, body_columns> text;
  std::array<SourceMark, body_columns> mark;
  std::array<const RowColumn*, body_columns>
      about{};  ///< description of each column; null: the file has no such column

  std::string_view operator[](BodyColumn column) const { return text[static_cast<std::size_t>(column)]; }
  const SourceMark& mark_of(BodyColumn column) const { return mark[static_cast<std::size_t>(column)]; }
};

class RowReader {
 public:
  /// The reader must outlive this object.
  RowReader(SizeStyle style, const BodyFileUse& use, Reader& reader)
      : style_(style), use_(use), reader_(reader) {}

  /// Converts one row. Throws InputError with file:line:column, the column's name and what is allowed. The
  /// texts in the returned row are views of those in the cells.
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
