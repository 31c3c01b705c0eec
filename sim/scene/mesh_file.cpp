#include "sim/scene/mesh_file.hpp"

#include "core/error.hpp"
#include "sim/scene/mesh_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

namespace scree {
namespace {

namespace fs = std::filesystem;

using Reading = void (*)(MeshSource&, MeshMaker&);

Reading reading_of(const fs::path& name) {
  std::string suffix = name.extension().string();
  std::ranges::transform(suffix, suffix.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (suffix == ".obj") return read_obj;
  if (suffix == ".stl") return read_stl;
  if (suffix == ".ply") return read_ply;
  throw InputError(fmt::format("{}: is none of .obj, .stl and .ply", name.string()));
}

std::string bytes_of(const fs::path& file) {
  const auto fail = [&](std::string_view what) {
    throw InputError(fmt::format("{}: {}", file.string(), what));
  };
  std::ifstream stream(file, std::ios::binary);
  const int reason = errno;
  std::error_code error;
  if (fs::is_directory(file, error)) fail("is a folder, not a mesh");
  if (fs::exists(file, error) && !fs::is_regular_file(file, error)) fail("is no regular file");
  if (!stream) fail(fmt::format("cannot be read: {}", std::strerror(reason)));
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Marks every triangle that has the same corners as an earlier one.
std::vector<char> repeats(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::pair<std::array<int, 3>, std::size_t>> sorted;
  sorted.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    sorted.emplace_back(triangles[t], t);
    std::ranges::sort(sorted.back().first);
  }
  std::ranges::sort(sorted);
  std::vector<char> again(triangles.size());
  for (std::size_t k = 1; k < sorted.size(); ++k)
    again[sorted[k].second] = sorted[k].first == sorted[k - 1].first;
  return again;
}

void count_edges(const std::vector<PlacedTriangle>& placed, MeshReport& report) {
  std::vector<std::array<int, 3>> corners;
  corners.reserve(placed.size());
  for (const PlacedTriangle& t : placed) corners.push_back(t.corners);
  for (const MeshEdge& edge : edges_of(corners)) {
    report.open += edge.count == 1;
    report.crowded += edge.count > 2;
  }
}

}  // namespace

MeshFile parse_mesh_file(std::string_view bytes, const fs::path& name, const Vec3& scale) {
  const Reading read = reading_of(name);
  MeshSource source(name, bytes);
  MeshMaker mesh(source, scale);
  read(source, mesh);
  return mesh.finish();
}

MeshFile read_mesh_file(const fs::path& file, const Vec3& scale) {
  return parse_mesh_file(bytes_of(file), file, scale);
}

SceneMesh scene_mesh(MeshFile file, const fs::path& name, const Weld& how) {
  SceneMesh scene{.mesh = {std::move(file.vertices), std::move(file.triangles)},
                  .triangles = {},
                  .report = {},
                  .warnings = std::move(file.warnings)};
  try {
    weld(scene.mesh, how, scene.report);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", name.string(), error.what()));
  }
  const std::vector<char> again = repeats(scene.mesh.triangles);
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    PlacedTriangle placed;
    if (!again[t] && place_triangle(scene.mesh, t, placed))
      scene.triangles.push_back(placed);
    else
      ++scene.report.left_out;
  }
  if (scene.triangles.empty())
    throw InputError(fmt::format("{}: has no triangle with an area", name.string()));
  count_edges(scene.triangles, scene.report);
  return scene;
}

}  // namespace scree
