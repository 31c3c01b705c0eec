#include "sim/record/surfaces.hpp"

#include "sim/record/vtk_poly_data.hpp"

#include <array>
#include <vector>

namespace scree {

namespace {

/// The numbers of the columns that give the shape of a body.
struct Places {
  explicit Places(const ExportFrame& of)
      : frame(of),
        id(of.require("id")),
        shape(of.require("shape")),
        mobility(of.require("mobility")),
        size(of.require("size")),
        orientation(of.require("orientation")) {}

  bool is_in(Movement movement, std::size_t row) const {
    const bool fixed = frame.number(mobility, row) == static_cast<double>(Mobility::fixed);
    return fixed == (movement == Movement::fixed);
  }
  /// Transforms a point from the body's frame to the world's.
  Vec3 place(std::size_t row, const Vec3& local) const {
    const auto q = [&](std::size_t k) { return frame.number(orientation, row, k); };
    return frame.vector(0, row) + Quat(q(0), q(1), q(2), q(3)).normalized() * local;
  }
  bool says_shape(std::size_t column) const { return column == 0 || column == size || column == orientation; }

  const ExportFrame& frame;
  std::size_t id, shape, mobility, size, orientation;
};

/// Points, and cells between them, each with the row of its body.
class Builder {
 public:
  Builder(const Places& places, VtkPolyData::Kind kind) : places_(places) {
    data_.kind = kind;
    data_.points = {"position", places.frame.about[0].type, {}};
  }

  std::int64_t add_point(std::size_t row, const Vec3& local) {
    const Vec3 x = places_.place(row, local);
    data_.points.numbers.insert(data_.points.numbers.end(), {x.x(), x.y(), x.z()});
    return static_cast<std::int64_t>(data_.points.numbers.size() / 3) - 1;
  }
  void add_cell(std::span<const std::int64_t> points) { data_.add_cell(points); }

  /// Returns the columns that do not give the shape, for these rows of bodies.
  std::vector<VtkPolyData::Array> columns(const std::vector<std::size_t>& rows) const {
    std::vector<VtkPolyData::Array> arrays;
    const ExportFrame& frame = places_.frame;
    for (std::size_t c = 0; c < frame.about.size(); ++c) {
      if (places_.says_shape(c)) continue;
      const FieldType& type = frame.about[c].type;
      arrays.push_back({frame.about[c].name, type, {}});
      VtkPolyData::Array& array = arrays.back();
      for (const std::size_t row : rows)
        for (std::size_t k = 0; k < static_cast<std::size_t>(type.columns); ++k)
          array.numbers.push_back(frame.number(c, row, k));
    }
    return arrays;
  }
  VtkPolyData& data() { return data_; }

 private:
  const Places& places_;
  VtkPolyData data_;
};

}  // namespace

bool has_surface(Shape shape) { return shape == Shape::triangle || shape == Shape::polyhedron; }
bool has_axis(Shape shape) {
  return shape == Shape::capsule || shape == Shape::cylinder || shape == Shape::tube;
}

std::string surfaces_of(const ExportFrame& frame, Movement movement, const HullOf& hull_of) {
  const Places places(frame);
  Builder out(places, VtkPolyData::Kind::polygons);
  std::vector<std::size_t> row_of_cell;
  const auto add_cell = [&](std::size_t row, std::span<const std::int64_t> points) {
    out.add_cell(points);
    row_of_cell.push_back(row);
  };
  for (std::size_t row = 0; row < frame.rows(); ++row) {
    const Shape shape = frame.shape(places.shape, row);
    if (!has_surface(shape) || !places.is_in(movement, row)) continue;
    if (shape == Shape::triangle) {
      const Vec3 size = 0.5 * frame.vector(places.size, row);
      std::array<std::int64_t, 3> points{};
      for (int k = 0; k < 3; ++k)
        points[static_cast<std::size_t>(k)] = out.add_point(row, triangle_corner(size, k));
      add_cell(row, points);
      continue;
    }
    const Hull& hull = hull_of(static_cast<std::int32_t>(frame.number(places.id, row)));
    std::vector<std::int64_t> points;
    for (const Vec3& vertex : hull.vertices) points.push_back(out.add_point(row, vertex));
    for (const Hull::Face& face : hull.faces) {
      std::vector<std::int64_t> corners;
      for (const int corner : hull.corners_of(face))
        corners.push_back(points[static_cast<std::size_t>(corner)]);
      add_cell(row, corners);
    }
  }
  out.data().cell_data = out.columns(row_of_cell);
  return out.data().text();
}

std::string axes_of(const ExportFrame& frame, Movement movement, const HullOf&) {
  const Places places(frame);
  Builder out(places, VtkPolyData::Kind::lines);
  std::vector<std::size_t> row_of_point;
  VtkPolyData::Array radius{"radius", frame.about[places.size].type, {}};
  radius.type.columns = 1;
  for (std::size_t row = 0; row < frame.rows(); ++row) {
    const Shape shape = frame.shape(places.shape, row);
    if (!has_axis(shape) || !places.is_in(movement, row)) continue;
    const Vec3 size = 0.5 * frame.vector(places.size, row);
    const double half = shape == Shape::capsule ? size.z() - size.x() : size.z();
    out.add_cell(std::array{out.add_point(row, {0, 0, -half}), out.add_point(row, {0, 0, half})});
    row_of_point.insert(row_of_point.end(), 2, row);
    radius.numbers.insert(radius.numbers.end(), 2, size.x());
  }
  out.data().point_data = out.columns(row_of_point);
  out.data().point_data.push_back(std::move(radius));
  return out.data().text();
}

}  // namespace scree
