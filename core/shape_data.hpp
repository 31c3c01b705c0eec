// What is to be known of a body's shape beyond what its size tells.
#pragma once

namespace scree {

struct Hull;
struct Surroundings;

/// Of one body; null where it does not apply.
struct ShapeData {
  const Hull* hull = nullptr;                  ///< of a polyhedron
  const Surroundings* surroundings = nullptr;  ///< of a mesh's triangle
};

/// Of two bodies; null for most.
struct PairShapes {
  const ShapeData* a = nullptr;
  const ShapeData* b = nullptr;
};

}  // namespace scree
