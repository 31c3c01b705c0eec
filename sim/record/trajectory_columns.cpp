#include "sim/record/trajectory_columns.hpp"

#include <cstring>

namespace scree {

namespace {

using Numbers = ColumnNumbers;
Numbers of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Numbers of(double x) { return {x}; }

Vec3 extent_of(Shape shape, const Vec3& size) {
  if (shape == Shape::plane) return Vec3::Zero();
  return 2 * (shape == Shape::sphere ? Vec3::Constant(size.x()) : size);
}

template <class T>
void append(double number, std::byte*& to) {
  const auto value = static_cast<T>(number);
  std::memcpy(to, &value, sizeof(T));
  to += sizeof(T);
}

/// Adds a number in the type of a column.
void append(double number, const FieldType& type, std::byte*& to) {
  if (type.kind == FieldType::Kind::natural) return append<std::uint8_t>(number, to);
  if (type.kind == FieldType::Kind::integer) return append<std::int32_t>(number, to);
  if (type.width == sizeof(float)) return append<float>(number, to);
  append<double>(number, to);
}

}  // namespace

double trajectory_period(const Scene& scene) {
  return scene.record.trajectory->every.value_or(1 / scene.render.fps);
}

std::vector<BodyColumnSource> body_columns_of(const TrajectorySettings& settings) {
  const int real = settings.in_double ? sizeof(double) : sizeof(float);
  const FieldType vector{FieldType::Kind::real, real, 3};
  const FieldType quaternion{FieldType::Kind::real, real, 4};
  const FieldType number{FieldType::Kind::integer, sizeof(std::int32_t), 1};
  const FieldType small_number{FieldType::Kind::natural, sizeof(std::uint8_t), 1};
  std::vector<BodyColumnSource> columns;
  const auto add = [&columns](const char* name, const FieldType& type, bool is_constant, auto numbers) {
    columns.push_back({{name, type}, is_constant, numbers});
  };
  add("position", vector, false, [](const BodyTable& b, std::size_t k) { return of(b.position[k]); });
  if (settings.orientation)
    add("orientation", quaternion, false, [](const BodyTable& b, std::size_t k) {
      const Quat& q = b.orientation[k];
      return Numbers{q.w(), q.x(), q.y(), q.z()};
    });
  if (settings.velocity)
    add("velocity", vector, false, [](const BodyTable& b, std::size_t k) { return of(b.velocity[k]); });
  if (settings.spin)
    add("spin", vector, false, [](const BodyTable& b, std::size_t k) { return of(b.spin[k]); });
  add("id", number, true, [](const BodyTable& b, std::size_t k) { return of(static_cast<double>(b.id[k])); });
  add("size", vector, true,
      [](const BodyTable& b, std::size_t k) { return of(extent_of(b.shape[k], b.size[k])); });
  add("shape", small_number, true,
      [](const BodyTable& b, std::size_t k) { return of(static_cast<double>(b.shape[k])); });
  add("mobility", small_number, true,
      [](const BodyTable& b, std::size_t k) { return of(static_cast<double>(b.mobility[k])); });
  add("material", number, true, [](const BodyTable& b, std::size_t k) { return of(b.material[k]); });
  return columns;
}

void append_numbers(const ColumnNumbers& numbers, const FieldType& type, std::byte*& to) {
  for (int c = 0; c < type.columns; ++c) append(numbers[static_cast<std::size_t>(c)], type, to);
}

void write_numbers(const BodyColumnSource& source, const BodyTable& bodies,
                   std::span<const std::int32_t> rows, std::span<std::byte> out) {
  const FieldType& type = source.column.type;
  std::byte* to = out.data();
  for (const std::int32_t row : rows) {
    append_numbers(source.numbers(bodies, static_cast<std::size_t>(row)), type, to);
  }
}

}  // namespace scree
