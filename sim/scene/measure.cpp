// The parser of measures, and their values.
#include "sim/scene/measure.hpp"

#include "core/error.hpp"
#include "sim/scene/codec.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace scree {
namespace {

constexpr std::string_view region_word = "region";
constexpr std::string_view components[] = {"x", "y", "z", "norm"};

double part_of(const Vec3& v, Component component) {
  return component == Component::norm ? v.norm() : v[static_cast<int>(component)];
}

/// Returns the load on the mesh to which the measure belongs.
MeshLoad load_of_mesh(const Measure& measure, const std::function<BodyState(std::int32_t)>& body) {
  const BodyState first = body(measure.body);
  const Quat turned = first.orientation * first.start_orientation.conjugate();
  const Vec3 place = first.position + turned * measure.to_place;
  MeshLoad load{Vec3::Zero(), Vec3::Zero()};
  for (std::int32_t k = 0; k < measure.triangles; ++k) {
    const BodyState triangle = k == 0 ? first : body(measure.body + k);
    load.force += triangle.force;
    load.torque += triangle.torque + (triangle.position - place).cross(triangle.force);
  }
  return load;
}

double value_of(const Measure& measure, const Measured& measured) {
  const MeasureInfo& info = *measure.info;
  return info.is_vector() ? part_of(info.vector(measured), measure.component) : info.number(measured);
}

std::string_view first_word(std::string_view name) { return name.substr(0, name.find('.')); }

[[noreturn]] void fail(std::string_view text, std::string_view what) {
  throw InputError(fmt::format("{} is no measure: {}", text, what));
}

const MeasureInfo* find_measure(std::string_view name, MeasureSubject of) {
  const auto table = measure_table();
  const auto found = std::ranges::find_if(
      table, [&](const MeasureInfo& info) { return info.of == of && info.name == name; });
  return found == table.end() ? nullptr : &*found;
}

/// Parses the name of a measure. `text` is the whole measure, for messages; `rest` is its name, with the
/// component if it is a vector.
Measure parse_name(std::string_view text, std::string_view rest, MeasureSubject of) {
  if (const MeasureInfo* whole = find_measure(rest, of); whole && !whole->is_vector()) return {.info = whole};
  const std::size_t dot = rest.rfind('.');
  const MeasureInfo* info = find_measure(rest.substr(0, dot), of);
  if (info && info->is_vector()) {
    const std::string_view last = dot == std::string_view::npos ? "" : rest.substr(dot + 1);
    const auto found = std::find(std::begin(components), std::end(components), last);
    if (found == std::end(components)) fail(text, fmt::format("{} needs .x, .y, .z or .norm", info->name));
    return {.info = info, .component = static_cast<Component>(found - std::begin(components))};
  }
  std::vector<std::string_view> known;
  for (const MeasureInfo& m : measure_table())
    if (m.of == of) known.push_back(m.name);
  std::string hint = suggestion(rest, known);
  if (hint.empty() && info == nullptr) hint = suggestion(rest.substr(0, dot), known);
  if (hint.empty()) hint = " (scree plan --reference lists all measures)";
  fail(text, fmt::format("{} is unknown{}", rest, hint));
}

/// Returns the part of a measure that follows the name of the body or region. Fails if there is none.
std::string_view after_name(std::string_view text, std::string_view name, const char* example) {
  const auto end = static_cast<std::size_t>(name.data() - text.data()) + name.size();
  if (end >= text.size()) fail(text, fmt::format("it says nothing about {}, such as {}", name, example));
  return text.substr(end + 1);
}

Measure parse_of_body(std::string_view text, const Scene& scene) {
  const std::string_view name = first_word(text);
  const auto body = scene.body_names.find(std::string(name));
  const auto mesh = std::ranges::find(scene.meshes, name, &MeshBodies::name);
  if (mesh != scene.meshes.end()) {
    Measure measure = parse_name(text, after_name(text, name, ".force.z"), MeasureSubject::mesh);
    measure.body = mesh->bodies.first;
    measure.triangles = mesh->bodies.count;
    measure.to_place = mesh->place - scene.bodies.position[static_cast<std::size_t>(measure.body)];
    return measure;
  }
  if (body == scene.body_names.end()) {
    std::vector<std::string_view> known;
    for (const auto& [other, id] : scene.body_names) known.push_back(other);
    for (const MeshBodies& other : scene.meshes) known.push_back(other.name);
    for (const MeasureInfo& info : measure_table())
      if (info.of == MeasureSubject::run) known.push_back(first_word(info.name));
    fail(text, fmt::format("there is no body called {}{}", name, suggestion(name, known)));
  }
  Measure measure = parse_name(text, after_name(text, name, ".position.z"), MeasureSubject::body);
  measure.body = body->second;
  return measure;
}

Measure parse_of_region(std::string_view text, const Scene& scene) {
  const std::string_view rest = after_name(text, first_word(text), ".exit.flux");
  const std::string_view name = first_word(rest);
  const auto region = std::find_if(scene.regions.begin(), scene.regions.end(),
                                   [&](const Region& candidate) { return candidate.name == name; });
  if (region == scene.regions.end()) {
    std::vector<std::string_view> known;
    for (const Region& other : scene.regions) known.push_back(other.name);
    fail(text, fmt::format("there is no region called {}{}", name, suggestion(name, known)));
  }
  Measure measure = parse_name(text, after_name(text, name, ".count"), MeasureSubject::region);
  measure.region = static_cast<std::int32_t>(region - scene.regions.begin());
  return measure;
}

}  // namespace

bool is_of_overlaps(const Measure& measure) {
  const std::string_view word = first_word(measure.info->name);
  return measure.info->of == MeasureSubject::run && (word == "penetration" || word == "pairs");
}

bool is_of_forces(const Measure& measure) {
  const bool of_body = measure.info->of == MeasureSubject::body || measure.info->of == MeasureSubject::mesh;
  const std::string_view name = measure.info->name;
  return of_body && (name == "force" || name == "torque");
}

bool is_measure_word(std::string_view name) {
  return name == region_word || std::ranges::any_of(measure_table(), [&](const MeasureInfo& info) {
           return info.of == MeasureSubject::run && first_word(info.name) == name;
         });
}

Measure parse_measure(std::string_view text, const Scene& scene) {
  const std::string_view first = first_word(text);
  if (first == region_word) return parse_of_region(text, scene);
  return is_measure_word(first) ? parse_name(text, text, MeasureSubject::run) : parse_of_body(text, scene);
}

double evaluate(const Measure& measure, const Observation& observation,
                const std::function<BodyState(std::int32_t)>& body) {
  Measured measured{.run = observation, .body = nullptr, .mesh = nullptr, .region = nullptr};
  switch (measure.info->of) {
    case MeasureSubject::body: {
      const BodyState state = body(measure.body);
      measured.body = &state;
      return value_of(measure, measured);
    }
    case MeasureSubject::mesh: {
      const MeshLoad load = load_of_mesh(measure, body);
      measured.mesh = &load;
      return value_of(measure, measured);
    }
    case MeasureSubject::region:
      measured.region = &observation.regions.at(static_cast<std::size_t>(measure.region));
      return value_of(measure, measured);
    case MeasureSubject::run:
      return value_of(measure, measured);
  }
  return 0;
}

}  // namespace scree
