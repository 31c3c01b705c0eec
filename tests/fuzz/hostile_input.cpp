#include "tests/fuzz/hostile_input.hpp"

#include "core/error.hpp"
#include "sim/scene/body_file.hpp"
#include "sim/scene/codec.hpp"
#include "sim/scene/document.hpp"
#include "sim/scene/mesh_file.hpp"
#include "sim/scene/scene.hpp"
#include "tests/fuzz/breach.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace scree {
namespace {

/// The memory that a scene may take (bytes), enough for pictures and about ten thousand bodies. Larger scenes
/// are refused soon on every machine, whatever its memory.
constexpr double memory = 2.6e8;

/// Returns whether a text is a word or a number, which to_yaml() must write without quotes if it had none.
bool is_word_or_number(std::string_view text) {
  const auto is_alphanumeric = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return std::any_of(text.begin(), text.end(), is_alphanumeric) &&
         std::all_of(text.begin(), text.end(), [&](char c) {
           return is_alphanumeric(c) || c == '_' || c == '.' || c == '+' || c == '-';
         });
}

bool is_same(const Node& a, const Node& b) {
  const bool keeps_form = a.quoted == b.quoted || (b.quoted && !is_word_or_number(a.text));
  return a.kind == b.kind && a.key == b.key && a.text == b.text && keeps_form &&
         std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), is_same);
}

void require_round_trip(const std::string& text) {
  Node tree;
  try {
    tree = parse_document(text);
  } catch (const SyntaxError&) {
    return;
  }
  if (tree.kind != Node::Kind::map) return;
  const std::string written = to_yaml(tree);
  try {
    if (!is_same(tree, parse_document(written))) breach("to_yaml() wrote another tree:\n" + written);
  } catch (const SyntaxError& error) {
    breach(fmt::format("to_yaml() wrote what cannot be read, {}:{}: {}\n{}", error.mark.line,
                       error.mark.column, error.what, written));
  }
}

void require_state(const BodyTable& bodies) {
  for (std::size_t b = 0; b < bodies.position.size(); ++b) {
    const bool finite = bodies.position[b].allFinite() && bodies.velocity[b].allFinite() &&
                        bodies.spin[b].allFinite() && bodies.size[b].allFinite() &&
                        bodies.inverse_inertia[b].allFinite() && std::isfinite(bodies.inverse_mass[b]);
    if (!finite) breach(fmt::format("body {} is not finite", b));
    if (!(std::abs(bodies.orientation[b].norm() - 1) < 1e-6))
      breach(fmt::format("body {} has no orientation", b));
    if (bodies.shape[b] != Shape::plane && !(bodies.size[b].maxCoeff() > 0))
      breach(fmt::format("body {} has no size", b));
  }
}

void require_scene(const Scene& scene) {
  require_state(scene.bodies);
  std::string again;
  try {
    again = parse_scene(scene.resolved, "resolved.yaml", {}, memory).resolved;
  } catch (const InputError& error) {
    breach(fmt::format("the resolved scene is refused: {}\n{}", error.what(), scene.resolved));
  }
  if (again != scene.resolved)
    breach(fmt::format("resolved again, the scene differs:\n{}\nwas\n{}", again, scene.resolved));
}

struct ScenePart {
  std::string text;
  std::vector<Override> overrides;
};

ScenePart split(std::string_view bytes) {
  constexpr std::string_view set = "--set ";
  ScenePart part;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size() - 1) + 1;
    std::string_view line = bytes.substr(at, end - at);
    at = end;
    const std::size_t equals = line.find('=');
    if (!line.starts_with(set) || equals == std::string_view::npos) {
      part.text += line;
      continue;
    }
    if (line.ends_with('\n')) line.remove_suffix(1);
    part.overrides.push_back(
        {std::string(line.substr(set.size(), equals - set.size())), std::string(line.substr(equals + 1))});
  }
  return part;
}

void require_scene_or_refusal(const std::string& text, const std::vector<Override>& overrides = {}) {
  // The folder does not exist, so that no `file` of a scene is found in it.
  static const std::filesystem::path name = "/nowhere/scene.yaml";
  try {
    require_scene(parse_scene(text, name, overrides, memory));
  } catch (const InputError& error) {
    require_message(error.what());
  }
}

void require_row(const BodyRow& row) {
  const bool finite = row.position.allFinite() && row.velocity.allFinite() && row.spin.allFinite() &&
                      row.size.allFinite() && std::isfinite(row.mass.value_or(1));
  if (!finite) breach("a row is not finite");
  const bool has_size = row.shape == Shape::polyhedron ? !row.hull.empty() : row.size.x() > 0;
  if (!(has_size && row.mass.value_or(1) > 0)) breach("a row without size or mass");
  if (row.servo && !(std::abs(row.servo->axis.norm() - 1) < 1e-6 && std::isfinite(row.servo->force)))
    breach("a servo without axis or force");
  if (!(std::abs(row.orientation.norm() - 1) < 1e-6)) breach("a row without orientation");
}

void require_mesh(const SceneMesh& scene) {
  const auto vertices = static_cast<int>(scene.mesh.vertices.size());
  for (const Vec3& vertex : scene.mesh.vertices)
    if (!vertex.allFinite()) breach("a vertex is not finite");
  for (const PlacedTriangle& t : scene.triangles) {
    if (!t.position.allFinite() || !(t.size.x() > 0 && t.size.z() > 0)) breach("a triangle has no area");
    for (const int corner : t.corners)
      if (corner < 0 || corner >= vertices) breach(fmt::format("there is no vertex {}", corner));
  }
  for (const std::string& warning : scene.warnings) require_message("mesh: " + warning);
  const MeshReport& r = scene.report;
  if (r.welded < 0 || r.split < 0 || r.left_out < 0 || !std::isfinite(r.farthest))
    breach("a count that is none");
  if (surroundings_of(scene.mesh, scene.triangles).size() != scene.triangles.size())
    breach("a triangle without surroundings");
}

void require_mesh_or_refusal(std::string_view bytes, const std::filesystem::path& name) {
  for (const Weld& how : {Weld{}, Weld{.on = true, .length = 0.1}}) {
    try {
      require_mesh(scene_mesh(parse_mesh_file(bytes, name, Vec3(1, -2, 1)), name, how));
    } catch (const InputError& error) {
      require_message(error.what());
    }
  }
}

}  // namespace

void read_hostile_obj(std::string_view bytes) { require_mesh_or_refusal(bytes, "mesh.obj"); }
void read_hostile_stl(std::string_view bytes) { require_mesh_or_refusal(bytes, "mesh.stl"); }
void read_hostile_ply(std::string_view bytes) { require_mesh_or_refusal(bytes, "mesh.ply"); }

void read_hostile_scene(std::string_view bytes) {
  const ScenePart part = split(bytes);
  require_round_trip(part.text);
  require_scene_or_refusal(part.text, part.overrides);
}

void read_hostile_body_file(std::string_view bytes) {
  const std::string& path = file_of(bytes);
  try {
    BodyFile file(path);
    std::int64_t rows = 0;
    file.read([&](const BodyRow& row) {
      require_row(row);
      ++rows;
    });
    if (rows != file.count() || rows == 0) breach(fmt::format("{} rows, not {}", rows, file.count()));
  } catch (const InputError& error) {
    require_message(error.what());
  }
  const std::string scene = "format: 1\ntime: {end: 1, step: 1}\nmaterials: {glass: {}}\nbodies:\n";
  require_scene_or_refusal(fmt::format("{}  - {{file: {}, name: b}}\n", scene, path));
  require_scene_or_refusal(fmt::format("{}  - {{file: {}, material: glass, fixed: true}}\n", scene, path));
  require_scene_or_refusal(
      fmt::format("{}  - {{file: {}, material: glass, sphere: {{radius: 0.1}}}}\n", scene, path));
  require_scene_or_refusal(fmt::format("{}  - {{file: {}, material: glass, frame: 1}}\n", scene, path));
}

}  // namespace scree
