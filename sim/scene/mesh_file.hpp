// Triangle meshes from files: Wavefront OBJ, and STL as text or binary.
#pragma once

#include "core/geometry.hpp"

#include <filesystem>
#include <vector>

namespace scree {

/// A mesh whose triangles all have an area.
struct SceneMesh {
  TriangleMesh mesh;
  std::vector<PlacedTriangle> triangles;
};

/// All vertices, those of equal place made one, times `scale`. Of OBJ the lines that begin with v and f are
/// read, polygons as fans of triangles. Throws InputError: file:line (of binary STL: file), what is wrong.
TriangleMesh read_mesh_file(const std::filesystem::path& file, double scale);

/// The triangles of a file; those without area, and those that are there again, are left out and counted.
/// Throws InputError if none is left.
SceneMesh read_scene_mesh(const std::filesystem::path& file, double scale);

}  // namespace scree
