#include "sim/scene/body_slots.hpp"

#include "sim/scene/measure.hpp"
#include "sim/scene/rules.hpp"

#include <fmt/format.h>

#include <limits>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace scree {
namespace {

/// Returns the number of bodies of an entry. It is a double, because a product of counts may exceed every
/// integer type.
double count_of(const BodyEntry& entry, const BodyFile* file, const SceneMesh* mesh) {
  if (file) return static_cast<double>(file->count());
  if (mesh) return static_cast<double>(mesh->triangles.size());
  if (entry.scatter) return static_cast<double>(entry.scatter->count);
  if (entry.emit) return static_cast<double>(entry.emit->count);
  if (!entry.repeat) return 1;
  const auto& n = entry.repeat->count;
  return static_cast<double>(n[0]) * static_cast<double>(n[1]) * static_cast<double>(n[2]);
}

void add_load(const BodyEntry& body, double count, MemoryLoad& load) {
  load.bodies += count;
  if (!body.plane && !body.motion && !body.fixed.value_or(false)) load.free_bodies += count;
  if (body.name.empty()) return;
  load.names += count;
  load.name_bytes += count * static_cast<double>(body.name.size());
}

void require_room(const BodyEntry& body, const MemoryLoad& load, double memory, Reader& reader) {
  const char* cause = body.repeat         ? "repeat"
                      : body.scatter      ? "scatter"
                      : body.emit         ? "emit"
                      : body.mesh         ? "mesh"
                      : body.file.empty() ? "name"
                                          : "file";
  constexpr auto most = std::numeric_limits<std::int32_t>::max();
  if (load.bodies > most)
    reader.fail_at(cause, *body.node,
                   fmt::format("the scene would have {} bodies; at most {} are possible", load.bodies, most));
  const double need = memory_need(load).total();
  if (need > memory)
    reader.fail_at(cause, *body.node,
                   fmt::format("a run of the scene's {:.0f} bodies needs {} of memory, but this machine has "
                               "{}; use fewer bodies or another machine",
                               load.bodies, bytes_words(need), bytes_words(memory)));
}

/// Returns the shape of a file's bodies if the entry gives it with its size.
std::optional<Shape> shape_with_sizes(const BodyEntry& body) {
  if (body.sphere) return Shape::sphere;
  if (body.box) return Shape::box;
  if (body.capsule) return Shape::capsule;
  if (body.cylinder) return Shape::cylinder;
  if (body.polyhedron) return Shape::polyhedron;
  return {};
}

/// Opens the file of an entry, if it has one. The entry is given the absolute path, because the resolved
/// scene may be run from any folder.
std::unique_ptr<BodyFile> open_file(BodyEntry& body, const std::filesystem::path& scene, Reader& reader) {
  if (body.file.empty()) return nullptr;
  std::filesystem::path found;
  try {
    found = find_body_file(std::filesystem::absolute(scene.parent_path() / body.file).lexically_normal());
  } catch (const InputError& error) {
    reader.fail_at("file", *body.node, error.what());
  }
  body.file = found.string();
  const std::optional<Shape> with_sizes = shape_with_sizes(body);
  return std::make_unique<BodyFile>(
      found, BodyFileUse{body.frame, with_sizes ? with_sizes : body.shape, with_sizes.has_value()});
}

/// Returns the absolute path of a mesh's file, which is relative to the scene, and writes it to `file`, the
/// member of the entry.
std::filesystem::path find_mesh(std::string& file, const std::filesystem::path& scene) {
  const std::filesystem::path found =
      std::filesystem::absolute(scene.parent_path() / file).lexically_normal();
  file = found.string();
  return found;
}

std::unique_ptr<SceneMesh> open_mesh(BodyEntry& body, const std::filesystem::path& scene, Reader& reader) {
  if (!body.mesh) return nullptr;
  try {
    const std::filesystem::path file = find_mesh(body.mesh->file, scene);
    return std::make_unique<SceneMesh>(
        scene_mesh(read_mesh_file(file, body.mesh->scale), file, body.mesh->weld));
  } catch (const InputError& error) {
    reader.fail_at("mesh", *body.node, error.what());
  }
}

std::unique_ptr<Hull> open_hull(BodyEntry& body, const std::filesystem::path& scene, Reader& reader) {
  if (!body.polyhedron) return nullptr;
  PolyhedronEntry& entry = *body.polyhedron;
  try {
    if (!entry.file.empty())
      return std::make_unique<Hull>(
          make_hull(read_mesh_file(find_mesh(entry.file, scene), Vec3::Constant(entry.scale)).vertices));
    std::vector<Vec3> points;
    for (const Vec3& point : *entry.points) points.push_back(entry.scale * point);
    return std::make_unique<Hull>(make_hull(points));
  } catch (const InputError& error) {
    reader.fail_at("polyhedron", *body.node, error.what());
  }
}

void claim_name(const BodyEntry& body, std::unordered_map<std::string_view, SourceMark>& names,
                Reader& reader) {
  if (body.name.empty()) return;
  const SourceMark mark = body.node->find("name")->mark;
  const auto [first, fresh] = names.emplace(body.name, mark);
  if (!fresh)
    reader.fail_at(
        "name", *body.node,
        fmt::format("{} is the name of a body already, at {}", body.name, reader.place(first->second)));
  if (is_measure_word(body.name))
    reader.fail_at("name", *body.node, fmt::format("{} is a word of measures; choose another", body.name));
}

std::int32_t find_material(const BodyEntry& body, const MaterialNames& materials, Reader& reader) {
  if (body.material.empty()) return -1;
  const Reader::Step step(reader, "material");
  return materials.require(body.material, *body.node->find("material"), reader);
}

}  // namespace

std::vector<BodySlot> body_slots(std::vector<BodyEntry>& entries, const std::filesystem::path& scene,
                                 const MemoryBudget& memory, const TimeGrid& grid,
                                 const MaterialNames& materials, Reader& reader) {
  const Reader::Step step(reader, "bodies");
  std::unordered_map<std::string_view, SourceMark> names;
  MemoryLoad load{.pictures = memory.pictures};
  std::vector<BodySlot> slots;
  slots.reserve(entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Reader::Step item(reader, i);
    BodyEntry& body = entries[i];
    std::unique_ptr<BodyFile> file = open_file(body, scene, reader);
    std::unique_ptr<SceneMesh> mesh = open_mesh(body, scene, reader);
    std::unique_ptr<Hull> hull = open_hull(body, scene, reader);
    const double count = count_of(body, file.get(), mesh.get());
    const double first = load.bodies;
    add_load(body, count, load);
    require_room(body, load, memory.bytes, reader);
    claim_name(body, names, reader);
    const std::int32_t material = find_material(body, materials, reader);
    const TimeSpan span = time_span(body.from.value_or(0), body.until, grid, *body.node, reader);
    slots.push_back({&body,
                     i,
                     {static_cast<std::int32_t>(first), static_cast<std::int32_t>(count)},
                     material,
                     grid.steps_in(span),
                     std::move(file),
                     std::move(mesh),
                     std::move(hull)});
  }
  return slots;
}

}  // namespace scree
