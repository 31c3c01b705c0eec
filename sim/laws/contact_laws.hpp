// The contact laws of pairs of bodies.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/shape_data.hpp"

#include <cstdint>

namespace scree {

/// The restitution and friction of a pair of materials.
struct PairLaw {
  double restitution;
  double friction;
  double rolling_friction = 0;
};

/// The contact law of each pair of bodies, and the shapes, sizes and mobilities of the bodies.
struct ContactLaws {
  ConstView<Shape> shape;            ///< shape of each body
  ConstView<Vec3> size;              ///< size of each body (m)
  ConstView<Mobility> mobility;      ///< mobility of each body
  ConstView<std::int32_t> material;  ///< material of each body
  ConstView<PairLaw> table;          ///< laws of all pairs of materials, materials x materials
  std::int64_t materials = 0;
  ConstView<ShapeData> shapes = {};  ///< shape data of each body, on Host; empty if no shape is general

  SCREE_HD bool is_free(std::int32_t body) const { return mobility[body] == Mobility::free; }
  /// Returns the smaller smallest_size() of two bodies (m).
  SCREE_HD double smaller_size(std::int32_t i, std::int32_t j) const {
    return fmin(smallest_size(shape[i], size[i]), smallest_size(shape[j], size[j]));
  }
  /// Returns the data of a body's shape beyond its size; null if no body's shape is general.
  SCREE_HD const ShapeData* shape_data(std::int32_t body) const {
    return shapes.size() > 0 ? &shapes[body] : nullptr;
  }
  SCREE_HD const PairLaw& between(std::int32_t i, std::int32_t j) const {
    return table[material[i] * materials + material[j]];
  }
  /// Returns the largest couple against rolling for each unit of normal impulse (m): the coefficient times
  /// the radius of the round body, or times r_i r_j / (r_i + r_j) if both bodies are round.
  SCREE_HD double rolling_reach(std::int32_t i, std::int32_t j) const {
    const double curvature = 1 / rolling_radius(shape[i], size[i]) + 1 / rolling_radius(shape[j], size[j]);
    return curvature > 0 ? between(i, j).rolling_friction / curvature : 0.0;
  }
};

}  // namespace scree
