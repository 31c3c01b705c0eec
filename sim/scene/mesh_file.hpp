// The readers of triangle meshes from files: Wavefront OBJ, STL as text or binary, and PLY.
#pragma once

#include "core/geometry.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// The mesh in a file, and warnings about it.
struct MeshFile : TriangleMesh {
  std::vector<std::string> warnings;  ///< parts of the file that are not read, but may matter to the user
};

/// A mesh whose triangles all have an area.
struct SceneMesh {
  TriangleMesh mesh;
  std::vector<PlacedTriangle> triangles;
  MeshReport report;
  std::vector<std::string> warnings;
};

/// Reads the mesh in a file. Vertices at equal positions become one, and each component is multiplied by that
/// of `scale`. Where the scale mirrors, the order of corners is reversed, so that the fronts of triangles
/// stay fronts. Polygons are cut into triangles. Throws InputError with file:line (only file if it is binary)
/// and what is wrong.
MeshFile read_mesh_file(const std::filesystem::path& file, const Vec3& scale);

/// Parses the bytes of a mesh file, as read_mesh_file() does. `name` is the name of the file in messages, and
/// its suffix determines the format.
MeshFile parse_mesh_file(std::string_view bytes, const std::filesystem::path& name, const Vec3& scale);

/// Welds the triangles of a file. Triangles without area and repeated triangles are left out and counted.
/// Throws InputError if none is left.
SceneMesh scene_mesh(MeshFile file, const std::filesystem::path& name, const Weld& how);

}  // namespace scree
