// What a trajectory says of a body, as columns of numbers.
#pragma once

#include "core/bodies.hpp"
#include "sim/record/trajectory_index.hpp"
#include "sim/scene/scene.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Of one row; a column has as many of them as its type says.
using ColumnNumbers = std::array<double, 4>;

/// One column: its type in the file, and where its numbers come from.
struct BodyColumnSource {
  TrajectoryColumn column;
  bool is_constant;  ///< of a body
  ColumnNumbers (*numbers)(const BodyTable& bodies, std::size_t k);
};

/// Simulated time between the frames of a scene's trajectory (s).
double trajectory_period(const Scene& scene);

/// Of a scene's trajectory; `position` (m) is the first, and then come those asked for: `orientation` (w, x,
/// y, z), `velocity` (m/s), `spin` (rad/s). The constant ones follow: `id`, the body's number in the scene;
/// `size`, full edges or diameters (m; 0 of a plane); `shape` and `mobility`, numbers of Shape and Mobility;
/// `material`, its place among the scene's.
std::vector<BodyColumnSource> body_columns_of(const TrajectorySettings& settings);

/// Sets a row's numbers as the type has them, and moves on behind them.
void append_numbers(const ColumnNumbers& numbers, const FieldType& type, std::byte*& to);

/// The numbers of these bodies, as the column's type has them, row by row in `out`.
void write_numbers(const BodyColumnSource& source, const BodyTable& bodies,
                   std::span<const std::int32_t> rows, std::span<std::byte> out);

}  // namespace scree
