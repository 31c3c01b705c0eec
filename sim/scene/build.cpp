// Makes the bodies of a scene, and checks what involves several sections. Entries keep their nodes, so that
// messages can name line and column.
#include "sim/scene/build.hpp"

#include "sim/scene/body.hpp"
#include "sim/scene/body_slots.hpp"
#include "sim/scene/measure.hpp"
#include "sim/scene/rules.hpp"
#include "sim/scene/scatter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace scree {
namespace {

constexpr const char* beyond_numbers = "its mass and inertia are beyond what numbers can hold";
constexpr const char* beyond_places = "its place, orientation or motion is beyond what numbers can hold";

class Builder {
 public:
  Builder(SceneEntry& entry, double memory, Reader& reader)
      : entry_(entry), memory_(memory), reader_(reader), grid_(entry.time), materials_(entry.materials) {}

  void build(Scene& scene) {
    scene.materials.assign(entry_.materials.begin(), entry_.materials.end());
    scene.laws = contact_laws(entry_.materials, materials_, entry_.contacts, reader_);
    slots_ =
        body_slots(entry_.bodies, scene.source, {memory_, scene.render.enabled}, grid_, materials_, reader_);
    make_room(scene);
    if (entry_.periodic) scene.bodies.period = period_of(*entry_.periodic);
    for (const BodySlot& slot : slots_) {
      slot.file   ? read_bodies(slot, scene)
      : slot.mesh ? make_triangles(slot, scene)
                  : make_bodies(slot, scene);
      name_bodies(slot, scene);
    }
    find_geometry(scene);
    if (entry_.periodic) fit_bodies(*entry_.periodic, scene.bodies, reader_);
    for (const BodySlot& slot : slots_)
      if (slot.entry->scatter) scatter_bodies(slot, scene);
    find_lifetimes(scene);
    find_motions(scene);
    find_servos(scene);
    if (scene.model.rotation == false) keep_from_turning(scene.bodies);
    require_numbers(scene);
    find_forces(scene);
    find_checks(scene);
  }

 private:
  void make_room(Scene& scene) const {
    std::size_t count = 0;
    for (const BodySlot& slot : slots_) count += static_cast<std::size_t>(slot.bodies.count);
    for_each_field([&](const char*, auto& field) { field.resize(count); }, scene.bodies);
  }

  void make_bodies(const BodySlot& slot, Scene& scene) {
    const Reader::Step step(reader_, "bodies");
    const Reader::Step item(reader_, slot.index);
    const BodyEntry& entry = *slot.entry;
    for (std::int32_t k = 0; k < slot.bodies.count; ++k) {
      const std::int32_t id = slot.bodies.first + k;
      const Material& material = scene.materials[static_cast<std::size_t>(slot.material)];
      scene.bodies.material[static_cast<std::size_t>(id)] = slot.material;
      if (!make_body(entry, k, id, scene.seed, material.density, slot.hull.get(), scene.bodies))
        reader_.fail(entry.node->mark, beyond_numbers);
    }
  }

  /// Sets the spin and inverse inertia of free bodies to zero. In a model without rotation no impulse turns a
  /// free body, and none starts with a spin.
  static void keep_from_turning(BodyTable& bodies) {
    for (std::size_t b = 0; b < bodies.mobility.size(); ++b) {
      if (bodies.mobility[b] != Mobility::free) continue;
      bodies.spin[b].setZero();
      bodies.inverse_inertia[b].setZero();
    }
  }

  void make_triangles(const BodySlot& slot, Scene& scene) const {
    for (std::int32_t k = 0; k < slot.bodies.count; ++k) {
      const std::int32_t id = slot.bodies.first + k;
      scene.bodies.material[static_cast<std::size_t>(id)] = slot.material;
      make_body(*slot.entry, slot.mesh->triangles[static_cast<std::size_t>(k)], id, scene.bodies);
    }
  }

  /// Collects the geometry of general shapes beyond their sizes: hulls, and the surroundings of mesh
  /// triangles. Fails if there is also a tube, because there is no contact test between a tube and a general
  /// shape.
  void find_geometry(Scene& scene) {
    const auto& shapes = scene.bodies.shape;
    if (std::ranges::none_of(shapes, is_general)) return;
    const auto geometry = std::make_shared<Geometry>();
    geometry->of_body.resize(shapes.size());
    for (BodySlot& slot : slots_) {
      require_no_tube(slot);
      if (slot.mesh) add_mesh(slot, *geometry, scene);
      if (!slot.hull) continue;
      geometry->hulls.push_back(std::move(*slot.hull));
      for (std::int32_t k = 0; k < slot.bodies.count; ++k)
        geometry->of_body[static_cast<std::size_t>(slot.bodies.first + k)].hull = &geometry->hulls.back();
    }
    std::map<const Hull*, const Hull*> moved;
    for (auto& [name, hull] : hulls_) {
      geometry->hulls.push_back(std::move(hull));
      moved[&hull] = &geometry->hulls.back();
    }
    for (const auto& [body, hull] : hulls_of_rows_)
      geometry->of_body[static_cast<std::size_t>(body)].hull = moved.at(hull);
    scene.geometry = geometry;
  }

  void require_no_tube(const BodySlot& slot) {
    if (!slot.entry->tube) return;
    const Reader::Step step(reader_, "bodies");
    const Reader::Step item(reader_, slot.index);
    reader_.fail_at(
        "tube", *slot.entry->node,
        "holds spheres and boxes alone: it cannot be in a scene with meshes, capsules, cylinders or "
        "polyhedra; a mesh of its wall can");
  }

  static void add_mesh(const BodySlot& slot, Geometry& geometry, Scene& scene) {
    const SceneMesh& mesh = *slot.mesh;
    scene.meshes.push_back({slot.entry->name, slot.entry->mesh->file, slot.bodies,
                            slot.entry->at.value_or(Vec3::Zero()), mesh.report});
    for (const std::string& warning : mesh.warnings)
      scene.notes.push_back(fmt::format("{}: {}", slot.entry->mesh->file, warning));
    std::int32_t id = slot.bodies.first;
    for (Surroundings& around : surroundings_of(mesh.mesh, mesh.triangles)) {
      geometry.surroundings.push_back(std::move(around));
      geometry.of_body[static_cast<std::size_t>(id++)].surroundings = &geometry.surroundings.back();
    }
  }

  void read_bodies(const BodySlot& slot, Scene& scene) {
    const bool fixed = slot.entry->fixed.value_or(false);
    std::int32_t id = slot.bodies.first;
    for (const std::string& note : slot.file->notes()) scene.notes.push_back(note);
    slot.file->read([&](const BodyRow& row) {
      const std::int32_t index = slot.material >= 0 ? slot.material : material_of(row, *slot.file);
      const Material& material = scene.materials[static_cast<std::size_t>(index)];
      scene.bodies.material[static_cast<std::size_t>(id)] = index;
      const Hull* hull = slot.hull.get();
      if (!row.hull.empty()) {
        hull = &hull_of(row, *slot.file);
        hulls_of_rows_.emplace_back(id, hull);
      }
      if (row.servo && !fixed) add_servo(row, id, *slot.file, scene);
      if (!make_body(*slot.entry, row, id, scene.seed, material.density, hull, scene.bodies))
        slot.file->fail(BodyColumn::mass, row.mark, beyond_numbers);
      ++id;
    });
  }

  /// Returns the hull of the file that a row names. All rows that name the same file share one hull.
  const Hull& hull_of(const BodyRow& row, BodyFile& file) {
    const std::string name = file.hull_file(row).lexically_normal().string();
    const auto [found, fresh] = hulls_.try_emplace(name);
    if (fresh) {
      try {
        found->second = make_hull(read_mesh_file(name, Vec3::Ones()).vertices);
      } catch (const InputError& error) {
        file.fail(BodyColumn::hull, row.hull_mark, error.what());
      }
    }
    return found->second;
  }

  static void add_servo(const BodyRow& row, std::int32_t id, BodyFile& file, Scene& scene) {
    if (scene.precision == Precision::mixed)
      file.fail(BodyColumn::servo_x, row.servo_mark,
                "the scene's precision cannot be mixed where a body is a servo");
    scene.servos.push_back(*row.servo);
    scene.servos.back().body = id;
  }

  std::int32_t material_of(const BodyRow& row, BodyFile& file) const {
    if (row.material.empty())
      file.fail(BodyColumn::material, row.material_mark,
                "the body needs one: fill the column, or give `material` beside `file` in the scene");
    const std::optional<std::int32_t> index = materials_.find_or_at(row.material);
    if (!index) file.fail(BodyColumn::material, row.material_mark, materials_.unknown(row.material));
    return *index;
  }

  void name_bodies(const BodySlot& slot, Scene& scene) const {
    const BodyEntry& entry = *slot.entry;
    if (entry.name.empty()) return;
    const bool many = entry.repeat || entry.scatter || entry.emit || slot.file || slot.mesh;
    for (std::int32_t k = 0; k < slot.bodies.count; ++k)
      scene.body_names.emplace(many ? fmt::format("{}[{}]", entry.name, k) : entry.name,
                               slot.bodies.first + k);
  }

  /// Returns whether the bodies of `other` are where the scene puts them when the bodies of `slot` appear.
  static bool is_in_place(const BodySlot& other, const BodySlot& slot, const Scene& scene) {
    if (other.entry->emit) return false;
    const bool fixed = scene.bodies.mobility[static_cast<std::size_t>(other.bodies.first)] == Mobility::fixed;
    return fixed ? other.steps.holds(slot.steps.first) : other.steps.first == slot.steps.first;
  }

  /// Scatters the bodies of a slot. The obstacles are the bodies that have their position by then: those that
  /// are not scattered, and those of earlier scatters.
  void scatter_bodies(const BodySlot& slot, Scene& scene) {
    std::vector<std::int32_t> obstacles;
    for (const BodySlot& other : slots_)
      if (is_in_place(other, slot, scene) &&
          (!other.entry->scatter || other.bodies.first < slot.bodies.first))
        for (std::int32_t k = 0; k < other.bodies.count; ++k) obstacles.push_back(other.bodies.first + k);
    std::vector<std::int32_t> bodies(static_cast<std::size_t>(slot.bodies.count));
    std::iota(bodies.begin(), bodies.end(), slot.bodies.first);
    const ScatterEntry& box = *slot.entry->scatter;
    const std::int64_t fitted = scatter(
        scene.bodies, bodies,
        {.from = box.from, .to = box.to, .seed = scene.seed, .period = scene.bodies.period}, obstacles);
    if (fitted == slot.bodies.count) return;
    const Reader::Step step(reader_, "bodies");
    const Reader::Step item(reader_, slot.index);
    reader_.fail_at("scatter", *slot.entry->node,
                    fmt::format("only {} of {} bodies fit without overlap; make the region larger or the "
                                "bodies fewer or smaller, or list larger bodies first",
                                fitted, slot.bodies.count));
  }

  void find_lifetimes(Scene& scene) {
    for (const BodySlot& slot : slots_) {
      const BodyEntry& entry = *slot.entry;
      if (entry.emit)
        scene.emitters.push_back(
            {slot.bodies, entry.emit->from, entry.emit->to, entry.emit->rate, entry.from.value_or(0)});
      else if (entry.from || entry.until)
        scene.lifetimes.push_back({slot.bodies, {entry.from.value_or(0), entry.until.value_or(HUGE_VAL)}});
    }
  }

  /// Makes the prescribed motions. It is called after every body has its position, because the centre of a
  /// body that turns about a point has a velocity from the turn, too.
  void find_motions(Scene& scene) {
    for (const BodySlot& slot : slots_) {
      if (!slot.entry->motion) continue;
      for (std::int32_t id = slot.bodies.first; id < slot.bodies.first + slot.bodies.count; ++id) {
        const auto b = static_cast<std::size_t>(id);
        Motion& motion = scene.motions.emplace_back(motion_of(*slot.entry->motion, id));
        // A mesh turns as a whole, about its `at`.
        if (slot.mesh && !motion.about) motion.about = slot.entry->at.value_or(Vec3::Zero());
        if (motion.oscillate) {
          const double rate = motion.oscillate->omega() * std::cos(motion.oscillate->phase);
          scene.bodies.velocity[b] += rate * motion.oscillate->displacement;
          scene.bodies.spin[b] += rate * motion.oscillate->angle;
        }
        if (motion.about)
          scene.bodies.velocity[b] += scene.bodies.spin[b].cross(scene.bodies.position[b] - *motion.about);
      }
    }
  }

  /// Adds the servos of the entries. Servos from body files have been added by read_bodies().
  void find_servos(Scene& scene) {
    for (const BodySlot& slot : slots_) {
      if (!slot.entry->servo) continue;
      const ServoEntry& servo = *slot.entry->servo;
      for (std::int32_t id = slot.bodies.first; id < slot.bodies.first + slot.bodies.count; ++id)
        scene.servos.push_back({id, servo.axis.stableNormalized(), servo.force});
    }
    std::ranges::sort(scene.servos, {}, &Servo::body);
  }

  /// Fails if a position, an orientation or a velocity is not finite: sums and products of finite numbers may
  /// be infinite.
  void require_numbers(const Scene& scene) {
    const Reader::Step step(reader_, "bodies");
    const BodyTable& bodies = scene.bodies;
    for (const BodySlot& slot : slots_) {
      const Reader::Step item(reader_, slot.index);
      for (std::int32_t k = 0; k < slot.bodies.count; ++k) {
        const auto b = static_cast<std::size_t>(slot.bodies.first + k);
        if (!bodies.position[b].allFinite() || !bodies.orientation[b].coeffs().allFinite() ||
            !bodies.velocity[b].allFinite() || !bodies.spin[b].allFinite())
          reader_.fail(slot.entry->node->mark, beyond_places);
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
      if (is_servo(on.first, scene))
        reader_.fail_at("on", *force.node,
                        fmt::format("{} is a servo, which has a force of its own", force.on));
      scene.forces.push_back(
          {on, force.force, force.torque, time_span(force.from, force.until, grid_, *force.node, reader_)});
    }
  }

  static bool is_servo(std::int32_t body, const Scene& scene) {
    return std::ranges::any_of(scene.servos, [body](const Servo& servo) { return servo.body == body; });
  }

  /// Returns the one body with this name, or all bodies of the entry with this name.
  BodyRange bodies_called(const std::string& name, const Node& node, const Scene& scene) {
    const auto body = scene.body_names.find(name);
    if (body != scene.body_names.end()) return {body->second, 1};
    std::vector<std::string_view> known;
    for (const BodySlot& slot : slots_) {
      if (slot.entry->name == name) return slot.bodies;
      known.push_back(slot.entry->name);
    }
    reader_.fail_at("on", node, fmt::format("there is no body called {}{}", name, suggestion(name, known)));
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
      if (check.confidence && entry_.seeds < 2)
        reader_.fail_at("confidence", *check.node, "needs seeds: 2 or more, at the top of the scene");
      if (measure.body >= 0) require_presence(measure.body, check);
      scene.checks.push_back(in_mode(check, entry_.response.mode));
    }
  }

  static Check in_mode(const CheckEntry& entry, ResponseMode mode) {
    Check check = entry;
    if (!check.in_default_mode || mode != ResponseMode::standard) return check;
    for (std::optional<double>* limit : {&check.tolerance, &check.relative, &check.below, &check.above}) {
      if (limit->has_value()) *limit = check.in_default_mode;
    }
    return check;
  }

  /// Fails if the body of a check does not exist at the first or at the last step of the check.
  void require_presence(std::int32_t body, const CheckEntry& check) {
    const auto after =
        std::find_if(slots_.begin(), slots_.end(), [&](const BodySlot& s) { return s.bodies.first > body; });
    const BodySlot& slot = *std::prev(after);
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
  double memory_;
  Reader& reader_;
  TimeGrid grid_;
  MaterialNames materials_;
  std::vector<BodySlot> slots_;
  std::map<std::string, Hull> hulls_;  ///< hulls that rows of body files name, by the paths of their files
  std::vector<std::pair<std::int32_t, const Hull*>> hulls_of_rows_;
};

/// Writes the defaults that depend on other keys into the entry.
void fill_defaults(BodyEntry& body) {
  if (body.plane || !body.file.empty()) return;
  const bool free = !body.fixed.value_or(false) && !body.motion && !body.servo;
  const bool keyframed = body.motion && !body.motion->keyframes.empty();
  if (!body.fixed) body.fixed = false;
  if (!body.scatter && !body.emit && !keyframed) {
    if (!body.at) body.at = Vec3::Zero();
    if (!body.rotate && !body.orientation) body.orientation = {1, 0, 0, 0};
  }
  if (free && !body.velocity) body.velocity = Vec3::Zero();
  if (free && !body.spin) body.spin = Vec3::Zero();
}

}  // namespace

Scene build_scene(SceneEntry entry, const std::filesystem::path& source, double memory, Reader& reader) {
  if (entry.name.empty()) entry.name = source.stem().string();
  if (!is_file_name(entry.name))
    reader.fail({1, 1},
                fmt::format("the file's stem, {}, cannot name the run folder; give a name", entry.name));
  Scene scene;
  scene.name = entry.name;
  scene.label = entry.label;
  scene.source = source;
  scene.seed = entry.seed;
  scene.seeds = entry.seeds;
  scene.gravity =
      entry.gravity.keyframes.empty() ? entry.gravity.vector : entry.gravity.keyframes.front().vector;
  if (entry.gravity.spin || !entry.gravity.keyframes.empty()) scene.gravity_turn = entry.gravity;
  scene.time = entry.time;
  scene.world = entry.world;
  scene.regions = entry.regions;
  scene.response = entry.response;
  scene.broadphase = entry.broadphase;
  scene.narrowphase = entry.narrowphase;
  scene.precision = entry.precision;
  scene.model = entry.model;
  scene.render = entry.render;
  scene.record = entry.record;
  Builder(entry, memory, reader).build(scene);
  for (BodyEntry& body : entry.bodies) fill_defaults(body);
  scene.resolved = to_yaml(*scene_codec().write(entry));
  return scene;
}

}  // namespace scree
