// The columns of numbers that a trajectory has of each body.
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

/// The numbers of one row. A column has as many of them as its type says.
using ColumnNumbers = std::array<double, 4>;

/// A column: its type in the file, and the source of its numbers.
struct BodyColumnSource {
  TrajectoryColumn column;
  bool is_constant;  ///< whether the numbers of a body never change
  ColumnNumbers (*numbers)(const BodyTable& bodies, std::size_t k);
};

/// Returns the simulated time between two frames of a scene's trajectory (s).
double trajectory_period(const Scene& scene);

/// Returns the columns of a scene's trajectory. `position` (m) is the first; then come the requested ones of
/// `orientation` (w, x, y, z), `velocity` (m/s) and `spin` (rad/s). The constant ones follow: `id`, the
/// body's number in the scene; `size`, full edges or diameters (m; 0 for a plane); `shape` and `mobility`,
/// numbers of Shape and Mobility; `material`, the number of the material in the scene.
std::vector<BodyColumnSource> body_columns_of(const TrajectorySettings& settings);

/// Writes the numbers of a row in the type, and moves `to` behind them.
void append_numbers(const ColumnNumbers& numbers, const FieldType& type, std::byte*& to);

/// Writes the numbers of these bodies to `out`, in the column's type, row by row.
void write_numbers(const BodyColumnSource& source, const BodyTable& bodies,
                   std::span<const std::int32_t> rows, std::span<std::byte> out);

}  // namespace scree
