// Triangle meshes from files: Wavefront OBJ, STL as text or binary, and PLY.
#pragma once

#include "core/geometry.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// What a file says.
struct MeshFile : TriangleMesh {
  std::vector<std::string> warnings;  ///< what of the file is not read, and may have been meant
};

/// A mesh whose triangles all have an area.
struct SceneMesh {
  TriangleMesh mesh;
  std::vector<PlacedTriangle> triangles;
  MeshReport report;
  std::vector<std::string> warnings;
};

/// All vertices, those of equal place made one, each component times that of `scale`; where the scale
/// mirrors, triangles are turned round, so that their fronts stay fronts. Polygons are cut into triangles.
/// Throws InputError: file:line (of what is binary: file), what is wrong.
MeshFile read_mesh_file(const std::filesystem::path& file, const Vec3& scale);

/// The same from bytes; `name` stands for the file in messages, and says by its suffix what they are.
MeshFile parse_mesh_file(std::string_view bytes, const std::filesystem::path& name, const Vec3& scale);

/// The triangles of a file, welded; those without area, and those that are there again, are left out and
/// counted. Throws InputError if none is left.
SceneMesh scene_mesh(MeshFile file, const std::filesystem::path& name, const Weld& how);

}  // namespace scree
