// The data of a body's shape beyond its size.
#pragma once

namespace scree {

struct Hull;
struct Surroundings;

/// The shape data of one body; a pointer is null where it does not apply.
struct ShapeData {
  const Hull* hull = nullptr;                  ///< hull of a polyhedron
  const Surroundings* surroundings = nullptr;  ///< neighbours of a mesh's triangle
};

/// The shape data of two bodies; null for most.
struct PairShapes {
  const ShapeData* a = nullptr;
  const ShapeData* b = nullptr;
};

}  // namespace scree
