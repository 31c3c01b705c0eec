// Which law holds between two bodies.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/shape_data.hpp"

#include <cstdint>

namespace scree {

/// Restitution and friction of a pair of materials.
struct PairLaw {
  double restitution;
  double friction;
  double rolling_friction = 0;
};

/// Which law holds between two bodies, and what they are.
struct ContactLaws {
  ConstView<Shape> shape;            ///< of each body
  ConstView<Vec3> size;              ///< of each body (m)
  ConstView<Mobility> mobility;      ///< of each body
  ConstView<std::int32_t> material;  ///< of each body
  ConstView<PairLaw> table;          ///< materials x materials
  std::int64_t materials = 0;
  ConstView<ShapeData> shapes = {};  ///< of each body, on Host; empty if no body's shape is general

  SCREE_HD bool is_free(std::int32_t body) const { return mobility[body] == Mobility::free; }
  /// The smaller smallest_size of two bodies (m).
  SCREE_HD double smaller_size(std::int32_t i, std::int32_t j) const {
    return fmin(smallest_size(shape[i], size[i]), smallest_size(shape[j], size[j]));
  }
  /// What is to be known of a body's shape beyond its size; null for most.
  SCREE_HD const ShapeData* shape_data(std::int32_t body) const {
    return shapes.size() > 0 ? &shapes[body] : nullptr;
  }
  SCREE_HD const PairLaw& between(std::int32_t i, std::int32_t j) const {
    return table[material[i] * materials + material[j]];
  }
  /// Couple against rolling for each normal impulse, at most (m): the coefficient times the radius of one, or
  /// of two that are round r_i r_j / (r_i + r_j).
  SCREE_HD double rolling_reach(std::int32_t i, std::int32_t j) const {
    const double curvature = 1 / rolling_radius(shape[i], size[i]) + 1 / rolling_radius(shape[j], size[j]);
    return curvature > 0 ? between(i, j).rolling_friction / curvature : 0.0;
  }
};

}  // namespace scree
