// Draws the bodies and settles what spans sections; entries keep their nodes so that messages find their
// place.
#include "sim/scene/build.hpp"

#include "sim/scene/body.hpp"
#include "sim/scene/body_file.hpp"
#include "sim/scene/materials.hpp"
#include "sim/scene/measure.hpp"
#include "sim/scene/memory.hpp"
#include "sim/scene/scatter.hpp"
#include "sim/scene/time_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <unordered_map>
#include <utility>

namespace scree {
namespace {

/// The bodies that one entry stands for.
struct Slot {
  const BodyEntry* entry;
  std::size_t index;  ///< of the entry in `bodies`
  std::int64_t first;
  std::int64_t count;
  std::int32_t material;             ///< -1: each row of the file says its own
  TimeGrid::Steps steps;             ///< in whose states the bodies are there
  std::unique_ptr<BodyFile> file{};  ///< where they come from, if from one
};

constexpr const char* beyond_numbers = "its mass and inertia are beyond what numbers can hold";

/// A product of counts may exceed every integer, but not the doubles.
double count_of(const BodyEntry& entry, const BodyFile* file) {
  if (file) return static_cast<double>(file->count());
  if (entry.scatter) return static_cast<double>(entry.scatter->count);
  if (!entry.repeat) return 1;
  const auto& n = entry.repeat->count;
  return static_cast<double>(n[0]) * static_cast<double>(n[1]) * static_cast<double>(n[2]);
}

class Builder {
 public:
  Builder(SceneEntry& entry, Reader& reader)
      : entry_(entry), reader_(reader), grid_(entry.time), materials_(entry.materials) {}

  void build(Scene& scene) {
    scene.materials.assign(entry_.materials.begin(), entry_.materials.end());
    scene.laws = contact_laws(entry_.materials, materials_, entry_.contacts, reader_);
    reserve(scene);
    for (const Slot& slot : slots_) {
      slot.file ? read_bodies(slot, scene) : make_bodies(slot, scene);
      name_bodies(slot, scene);
    }
    for (const Slot& slot : slots_)
      if (slot.entry->scatter) scatter_bodies(slot, scene);
    find_lifetimes(scene);
    find_motions(scene);
    find_forces(scene);
    find_checks(scene);
  }

 private:
  /// Counts the bodies and checks their number, and the memory of the whole run, before anything is allocated
  /// for them.
  void reserve(Scene& scene) {
    const Reader::Step step(reader_, "bodies");
    std::unordered_map<std::string_view, SourceMark> names;
    MemoryLoad load{.pictures = scene.render.enabled};
    slots_.reserve(entry_.bodies.size());
    for (std::size_t i = 0; i < entry_.bodies.size(); ++i) {
      const Reader::Step item(reader_, i);
      BodyEntry& body = entry_.bodies[i];
      std::unique_ptr<BodyFile> file = open_file(body, scene.source);
      const double count = count_of(body, file.get());
      const double first = load.bodies;
      add_load(body, count, load);
      require_room(body, load);
      claim_name(body, names);
      slots_.push_back(
          {&body, i, static_cast<std::int64_t>(first), static_cast<std::int64_t>(count), find_material(body),
           grid_.steps_in(span_of(body.from.value_or(0), body.until, *body.node)), std::move(file)});
    }
    const auto total = static_cast<std::size_t>(load.bodies);
    for_each_field([&](const char*, auto& field) { field.resize(total); }, scene.bodies);
  }

  static void add_load(const BodyEntry& body, double count, MemoryLoad& load) {
    load.bodies += count;
    if (!body.plane && !body.motion && !body.fixed.value_or(false)) load.free_bodies += count;
    if (body.name.empty()) return;
    load.names += count;
    load.name_bytes += count * static_cast<double>(body.name.size());
  }

  void require_room(const BodyEntry& body, const MemoryLoad& load) {
    const char* cause = body.repeat         ? "repeat"
                        : body.scatter      ? "scatter"
                        : body.file.empty() ? "name"
                                            : "file";
    constexpr auto most = std::numeric_limits<std::int32_t>::max();
    if (load.bodies > most)
      reader_.fail_at(
          cause, *body.node,
          fmt::format("the scene would have {} bodies; at most {} are possible", load.bodies, most));
    const double need = memory_need(load).total();
    if (need > machine_memory())
      reader_.fail_at(
          cause, *body.node,
          fmt::format("a run of the scene's {:.0f} bodies needs {} of memory, but this machine has {}",
                      load.bodies, bytes_words(need), bytes_words(machine_memory())));
  }

  /// The entry keeps where the file is found, for the resolved scene, which may be run from anywhere.
  std::unique_ptr<BodyFile> open_file(BodyEntry& body, const std::filesystem::path& scene) {
    if (body.file.empty()) return nullptr;
    std::filesystem::path found;
    try {
      found = find_body_file(std::filesystem::absolute(scene.parent_path() / body.file).lexically_normal());
    } catch (const InputError& error) {
      reader_.fail_at("file", *body.node, error.what());
    }
    body.file = found.string();
    return std::make_unique<BodyFile>(found);
  }

  std::int32_t find_material(const BodyEntry& body) {
    if (body.material.empty()) return -1;
    const Reader::Step step(reader_, "material");
    return materials_.require(body.material, *body.node->find("material"), reader_);
  }

  void claim_name(const BodyEntry& body, std::unordered_map<std::string_view, SourceMark>& names) {
    if (body.name.empty()) return;
    const SourceMark mark = body.node->find("name")->mark;
    const auto [first, fresh] = names.emplace(body.name, mark);
    if (!fresh)
      reader_.fail_at(
          "name", *body.node,
          fmt::format("{} is the name of a body already, at {}", body.name, reader_.place(first->second)));
    if (is_measure_word(body.name))
      reader_.fail_at("name", *body.node, fmt::format("{} is a word of measures; choose another", body.name));
  }

  void make_bodies(const Slot& slot, Scene& scene) {
    const Reader::Step step(reader_, "bodies");
    const Reader::Step item(reader_, slot.index);
    const BodyEntry& entry = *slot.entry;
    for (std::int64_t k = 0; k < slot.count; ++k) {
      const auto id = static_cast<std::int32_t>(slot.first + k);
      const Material& material = scene.materials[static_cast<std::size_t>(slot.material)];
      scene.bodies.material[static_cast<std::size_t>(id)] = slot.material;
      if (!make_body(entry, k, id, scene.seed, material.density, scene.bodies))
        reader_.fail(entry.node->mark, beyond_numbers);
    }
  }

  void read_bodies(const Slot& slot, Scene& scene) {
    auto id = static_cast<std::int32_t>(slot.first);
    slot.file->read([&](const BodyRow& row) {
      const std::int32_t index = slot.material >= 0 ? slot.material : material_of(row, *slot.file);
      const Material& material = scene.materials[static_cast<std::size_t>(index)];
      scene.bodies.material[static_cast<std::size_t>(id)] = index;
      if (!make_body(row, slot.entry->fixed.value_or(false), id, material.density, scene.bodies))
        slot.file->fail(BodyColumn::mass, row.mark, beyond_numbers);
      ++id;
    });
  }

  std::int32_t material_of(const BodyRow& row, BodyFile& file) const {
    if (row.material.empty())
      file.fail(BodyColumn::material, row.material_mark,
                "the body needs one: fill the column, or give `material` beside `file` in the scene");
    const std::optional<std::int32_t> index = materials_.find(row.material);
    if (!index) file.fail(BodyColumn::material, row.material_mark, materials_.unknown(row.material));
    return *index;
  }

  void name_bodies(const Slot& slot, Scene& scene) const {
    const BodyEntry& entry = *slot.entry;
    if (entry.name.empty()) return;
    const bool many = entry.repeat || entry.scatter || slot.file;
    for (std::int64_t k = 0; k < slot.count; ++k)
      scene.body_names.emplace(many ? fmt::format("{}[{}]", entry.name, k) : entry.name,
                               static_cast<std::int32_t>(slot.first + k));
  }

  /// Whether the bodies of `other` are where the scene puts them when those of `slot` appear.
  static bool is_in_place(const Slot& other, const Slot& slot, const Scene& scene) {
    const bool fixed = scene.bodies.mobility[static_cast<std::size_t>(other.first)] == Mobility::fixed;
    return fixed ? other.steps.holds(slot.steps.first) : other.steps.first == slot.steps.first;
  }

  /// Obstacles are the bodies with a place: those of no scatter, and of scatters before this one.
  void scatter_bodies(const Slot& slot, Scene& scene) {
    std::vector<std::int32_t> obstacles;
    for (const Slot& other : slots_)
      if (is_in_place(other, slot, scene) && (!other.entry->scatter || other.first < slot.first))
        for (std::int64_t k = 0; k < other.count; ++k)
          obstacles.push_back(static_cast<std::int32_t>(other.first + k));
    const std::int64_t fitted =
        scatter(scene.bodies, slot.first, slot.count, *slot.entry->scatter, obstacles, scene.seed);
    if (fitted == slot.count) return;
    const Reader::Step step(reader_, "bodies");
    const Reader::Step item(reader_, slot.index);
    reader_.fail_at("scatter", *slot.entry->node,
                    fmt::format("only {} of {} bodies fit without overlap; make the region larger or the "
                                "bodies fewer or smaller",
                                fitted, slot.count));
  }

  void find_lifetimes(Scene& scene) {
    for (const Slot& slot : slots_)
      if (slot.entry->from || slot.entry->until)
        scene.lifetimes.push_back(
            {{static_cast<std::int32_t>(slot.first), static_cast<std::int32_t>(slot.count)},
             {slot.entry->from.value_or(0), slot.entry->until.value_or(HUGE_VAL)}});
  }

  /// Once every body has its place: the centre of a body that turns about a point moves by that too.
  void find_motions(Scene& scene) {
    for (const Slot& slot : slots_) {
      if (!slot.entry->motion) continue;
      const MotionEntry& motion = *slot.entry->motion;
      for (std::int64_t id = slot.first; id < slot.first + slot.count; ++id) {
        const auto b = static_cast<std::size_t>(id);
        scene.motions.push_back({static_cast<std::int32_t>(id), motion.velocity, motion.spin, motion.about});
        if (motion.about)
          scene.bodies.velocity[b] += motion.spin.cross(scene.bodies.position[b] - *motion.about);
      }
    }
  }

  void find_forces(Scene& scene) {
    const Reader::Step step(reader_, "forces");
    for (std::size_t i = 0; i < entry_.forces.size(); ++i) {
      const Reader::Step item(reader_, i);
      const ForceEntry& force = entry_.forces[i];
      const BodyRange on = bodies_called(force.on, *force.node, scene);
      if (scene.bodies.mobility[static_cast<std::size_t>(on.first)] != Mobility::free)
        reader_.fail_at("on", *force.node,
                        fmt::format("{} is not free; forces move free bodies alone", force.on));
      scene.forces.push_back({on, force.force, force.torque, span_of(force.from, force.until, *force.node)});
    }
  }

  /// One body by its name, or all of an entry by the entry's.
  BodyRange bodies_called(const std::string& name, const Node& node, const Scene& scene) {
    const auto body = scene.body_names.find(name);
    if (body != scene.body_names.end()) return {body->second, 1};
    std::vector<std::string_view> known;
    for (const Slot& slot : slots_) {
      if (slot.entry->name == name)
        return {static_cast<std::int32_t>(slot.first), static_cast<std::int32_t>(slot.count)};
      known.push_back(slot.entry->name);
    }
    reader_.fail_at("on", node, fmt::format("there is no body called {}{}", name, suggestion(name, known)));
  }

  /// `node` holds the keys from and until.
  TimeSpan span_of(double from, const std::optional<double>& until, const Node& node) {
    const TimeSpan span{from, until.value_or(HUGE_VAL)};
    const double end = entry_.time.end;
    if (from >= end)
      reader_.fail_at("from", node, fmt::format("must be before the end, {} s, not {} s", end, from));
    const TimeGrid::Steps steps = grid_.steps_in(span);
    if (steps.first >= steps.end)
      reader_.fail_at("until", node,
                      fmt::format("must be at least a step after from, {} s, not {} s", from, span.until));
    return span;
  }

  void find_checks(Scene& scene) {
    const Reader::Step step(reader_, "checks");
    for (std::size_t i = 0; i < entry_.checks.size(); ++i) {
      const Reader::Step item(reader_, i);
      const CheckEntry& check = entry_.checks[i];
      Measure measure;
      try {
        measure = parse_measure(check.measure, scene);
      } catch (const InputError& error) {
        reader_.fail_at("measure", *check.node, error.what());
      }
      const double end = scene.time.end;
      if (check.at.value_or(0) > end)
        reader_.fail_at("at", *check.node,
                        fmt::format("must be at most the end, {} s, not {} s", end, *check.at));
      if (check.over && (*check.over)[1] > end)
        reader_.fail_at(
            "over", *check.node,
            fmt::format("must end at the end, {} s, or before, not at {} s", end, (*check.over)[1]));
      if (measure.body >= 0) require_presence(measure.body, check);
      scene.checks.push_back(check);
    }
  }

  /// Of the body that a check is about, at all times that it asks for.
  void require_presence(std::int32_t body, const CheckEntry& check) {
    const auto after =
        std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.first > body; });
    const Slot& slot = *std::prev(after);
    const double end = entry_.time.end;
    const auto first = check.over ? grid_.first_in((*check.over)[0]) : grid_.nearest(check.at.value_or(end));
    const auto last = check.over ? grid_.last_in((*check.over)[1]) : first;
    for (const std::int64_t step : {first, last})
      if (!slot.steps.holds(step))
        reader_.fail_at(
            check.over ? "over"
            : check.at ? "at"
                       : "measure",
            *check.node,
            fmt::format("the body is not there at {:.9g} s; see its from and until", grid_.time(step)));
  }

  SceneEntry& entry_;
  Reader& reader_;
  TimeGrid grid_;
  MaterialNames materials_;
  std::vector<Slot> slots_;
};

/// Writes the defaults that depend on other keys into the entry.
void fill_defaults(BodyEntry& body) {
  if (body.plane || !body.file.empty()) return;
  const bool free = !body.fixed.value_or(false) && !body.motion;
  if (!body.fixed) body.fixed = false;
  if (!body.scatter) {
    if (!body.at) body.at = Vec3::Zero();
    if (!body.rotate && !body.orientation) body.orientation = {1, 0, 0, 0};
  }
  if (free && !body.velocity) body.velocity = Vec3::Zero();
  if (free && !body.spin) body.spin = Vec3::Zero();
}

}  // namespace

Scene build_scene(SceneEntry entry, const std::filesystem::path& source, Reader& reader) {
  if (entry.name.empty()) entry.name = source.stem().string();
  if (!is_file_name(entry.name))
    reader.fail({1, 1},
                fmt::format("the file's stem, {}, cannot name the run folder; give a name", entry.name));
  Scene scene;
  scene.name = entry.name;
  scene.label = entry.label;
  scene.source = source;
  scene.seed = entry.seed;
  scene.gravity = entry.gravity;
  scene.time = entry.time;
  scene.regions = entry.regions;
  scene.response = entry.response;
  scene.broadphase = entry.broadphase;
  scene.narrowphase = entry.narrowphase;
  scene.model = entry.model;
  scene.render = entry.render;
  scene.record = entry.record;
  Builder(entry, reader).build(scene);
  for (BodyEntry& body : entry.bodies) fill_defaults(body);
  scene.resolved = to_yaml(*scene_codec().write(entry));
  return scene;
}

}  // namespace scree
