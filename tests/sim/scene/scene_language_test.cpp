// Tests of the language as a whole: schema, reference, resolved scene and overrides, against independent
// readings.
#include "core/error.hpp"
#include "sim/scene/keys.hpp"
#include "sim/scene/measure.hpp"
#include "sim/scene/scene.hpp"
#include "tests/sim/scene/json_of.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

namespace scree {
namespace {

using Json = nlohmann::json;

// A scene with every key of this version, each with a value that is not its default.
const std::string full_scene = R"(format: 1
name: "full scene"
label: long
seed: 18446744073709551615
gravity: [0.5, -1e-3, -9.81]
time: {end: 6.0, step: 0.002, substeps: 3}
materials:
  glass: {density: 2500, restitution: 0.6, friction: 0.4}
  steel: {density: 7800, restitution: 0.9, friction: 0.1}
contacts:
  - {between: [steel, glass], friction: 0.3}
bodies:
  - {plane: {normal: [0, 1, 2], offset: -0.5}, name: floor, material: glass}
  - {box: {size: [1, 1, 0.1]}, rotate: {axis: [0, 1, 0], degrees: 26.565}, fixed: on, material: glass}
  - {sphere: {radius: 0.1}, name: puck, at: [0, 0, 3], velocity: [2, 0, 0], spin: [0, 1, 0], material: steel}
  - sphere: {radius: {uniform: [0.04, 0.06]}}
    name: bed
    repeat: {count: [2, 3, 4], spacing: [0.13, 0.13, 0.13], jitter: 0.005}
    mass: 0.25
    orientation: [2, 0, 0, 1]
    material: glass
  - box: {size: {uniform: [0.08, [0.1, 0.11, 0.12]]}}
    scatter: {count: 20, from: [0, 0, 5], to: [1, 1, 7]}
    material: glass
  - {sphere: {radius: {powerlaw: [0.01, 0.1, 2.5]}}, at: [9, 0, 0], material: glass}
  - {box: {size: {choose: [0.1, [1, 2, 3]]}}, at: [0, 9, 0], material: glass}
  - box: {size: [2, 0.1, 0.1]}
    name: paddle
    at: [0, 0, -4]
    rotate: {axis: [1, 1, 0], radians: 1}
    motion: {velocity: [0, 0, 1], spin: [0, 0, 3.14], about: [1, 0, -4]}
    from: 0.5
    until: 5
    material: glass
forces:
  - {on: puck, force: [1, 0, 0], torque: [0, 0.5, 0], from: 1, until: 2}
  - {on: bed, force: [0, 0, 1]}
regions:
  exit: {from: [-1, -1, -1], to: [1, 1, 0]}
response: {mode: default, iterations: 20, tolerance: 1e-6, warm_start: false, restitution_threshold: 0.25}
broadphase: {method: uniform_grid, levels: 4}
narrowphase: {box_box: ccd_gjk, convex: ccd_mpr, crosscheck: 0.25}
precision: double
model: {rotation: on, friction: off}
render: {size: [640, 480], fps: 60, camera: {from: [1, 2, 3], to: [0, 0, 0.5], fov: 50, orbit: {degrees: 90}}, color: speed, range: [0, 3],
         legend: off, time_stamp: on, overlay: [grid, forces]}
record: {metrics_every: 0.1, trajectory: false}
checks:
  - {measure: "bed[23].velocity.norm", at: 3.0, expect: 1.428571, tolerance: 1.0e-9}
  - {measure: puck.position.z, over: [1, 6], reduce: crossings, level: 0.1, expect: 3, relative: 0}
  - {measure: penetration.max, below: 1, above: -1}
)";

Scene parse(const std::string& text, const std::vector<Override>& overrides = {}) {
  return parse_scene(text, "scenes/test.yaml", overrides);
}

TEST(SceneLanguage, EveryKeyReachesTheScene) {
  const Scene scene = parse(full_scene);
  EXPECT_EQ(scene.name, "full scene");
  EXPECT_EQ(scene.label, "long");
  EXPECT_EQ(scene.seed, 18446744073709551615ull);
  EXPECT_EQ(scene.gravity, Vec3(0.5, -1e-3, -9.81));
  EXPECT_EQ(scene.time.end, 6);
  EXPECT_EQ(scene.time.step, 0.002);
  EXPECT_EQ(scene.time.substeps, 3);
  EXPECT_EQ(scene.bodies.count(), 1 + 1 + 1 + 24 + 20 + 1 + 1 + 1);
  EXPECT_EQ(scene.motions.at(0).about, Vec3(1, 0, -4));
  ASSERT_EQ(scene.lifetimes.size(), 1u);
  EXPECT_EQ(scene.lifetimes[0].bodies.first, 49);
  EXPECT_EQ(scene.lifetimes[0].span.from, 0.5);
  EXPECT_EQ(scene.lifetimes[0].span.until, 5);
  ASSERT_EQ(scene.forces.size(), 2u);
  EXPECT_EQ(scene.forces[0].torque, Vec3(0, 0.5, 0));
  EXPECT_EQ(scene.forces[1].on.count, 24);
  ASSERT_EQ(scene.regions.size(), 1u);
  EXPECT_EQ(scene.regions[0].name, "exit");
  EXPECT_EQ(scene.regions[0].to, Vec3(1, 1, 0));
  EXPECT_EQ(scene.response.iterations, 20);
  EXPECT_EQ(scene.response.tolerance, 1e-6);
  EXPECT_FALSE(scene.response.warm_start);
  EXPECT_EQ(scene.response.restitution_threshold, 0.25);
  EXPECT_EQ(scene.broadphase.method, BroadPhaseMethod::uniform_grid);
  EXPECT_EQ(scene.broadphase.levels, 4);
  EXPECT_EQ(scene.narrowphase.box_box, BoxBoxMethod::ccd_gjk);
  EXPECT_EQ(scene.narrowphase.convex, ConvexMethod::ccd_mpr);
  EXPECT_EQ(scene.narrowphase.crosscheck, 0.25);
  EXPECT_EQ(scene.model.rotation, true);
  EXPECT_EQ(scene.model.friction, false);
  EXPECT_EQ(scene.model.restitution, std::nullopt);
  EXPECT_TRUE(scene.render.enabled);
  EXPECT_EQ(scene.render.width, 640);
  EXPECT_EQ(scene.render.height, 480);
  EXPECT_EQ(scene.render.fps, 60);
  ASSERT_TRUE(scene.render.camera);
  EXPECT_EQ(scene.render.camera->from, Vec3(1, 2, 3));
  EXPECT_EQ(scene.render.camera->fov, 50);
  EXPECT_EQ(scene.render.camera->orbit->degrees, 90);
  EXPECT_EQ(scene.render.range, (std::array<double, 2>{0, 3}));
  EXPECT_EQ(scene.render.legend, false);
  EXPECT_EQ(scene.render.time_stamp, true);
  EXPECT_EQ(scene.render.overlay, (std::vector<Overlay>{Overlay::grid, Overlay::forces}));
  EXPECT_EQ(scene.render.color, ColorBy::speed);
  EXPECT_EQ(scene.record.metrics_every, 0.1);
  ASSERT_EQ(scene.checks.size(), 3u);
  EXPECT_EQ(scene.checks[0].measure, "bed[23].velocity.norm");
  EXPECT_EQ(scene.checks[0].at, 3.0);
  EXPECT_EQ(scene.checks[0].expect, 1.428571);
  EXPECT_EQ(scene.checks[0].tolerance, 1e-9);
  EXPECT_EQ(scene.checks[0].mark.line, 49);
  EXPECT_EQ(scene.checks[1].reduce, Reduce::crossings);
  EXPECT_EQ(scene.checks[1].level, 0.1);
  EXPECT_EQ((*scene.checks[1].over)[1], 6);
  EXPECT_EQ(scene.checks[1].relative, 0);
  EXPECT_EQ(scene.checks[2].below, 1);
  EXPECT_EQ(scene.checks[2].above, -1);
}

const std::string moving_scene = R"(format: 1
time: {end: 6.0, step: 0.002}
gravity: {vector: [0, 0, -9], spin: [0, 0.5, 0]}
materials: {glass: {density: 2500}}
bodies:
  - {sphere: {radius: 1}, at: [2, 0, 0], motion: {spin: [0, 0, 1], about: [0, 0, 0], oscillate: {displacement: [0, 0, 1], angle: [0, 0, 2], frequency: 0.5, phase: 1}}, material: glass}
  - {box: {size: 1}, rotate: {axis: [0, 0, 1], degrees: 90}, motion: {keyframes: [{at: 0.5, position: [0, 9, 0]}, {at: 2, position: [1, 9, 0]}]}, material: glass}
  - {box: {size: 1}, motion: {keyframes: [{at: 0, position: [0, 18, 0], orientation: [2, 0, 0, 0]}, {at: 1, position: [0, 18, 0], rotate: {axis: [1, 0, 0], radians: 1}}]}, material: glass}
  - {box: {size: 1}, at: [0, 0, 9], repeat: {count: [2, 1, 1], spacing: [3, 0, 0]}, mass: 4, servo: {axis: [0, 3, 4], force: -5}, material: glass}
render: false
)";

TEST(SceneLanguage, MotionsServosAndTurningGravityReachTheScene) {
  const Scene scene = parse(moving_scene);
  EXPECT_EQ(scene.gravity, Vec3(0, 0, -9));
  ASSERT_TRUE(scene.gravity_turn);
  EXPECT_EQ(scene.gravity_turn->spin, Vec3(0, 0.5, 0));
  ASSERT_EQ(scene.motions.size(), 3u);
  const Oscillation& oscillation = scene.motions[0].oscillate.value();
  EXPECT_EQ(oscillation.displacement, Vec3(0, 0, 1));
  EXPECT_EQ(oscillation.angle, Vec3(0, 0, 2));
  EXPECT_EQ(oscillation.frequency, 0.5);
  EXPECT_EQ(oscillation.phase, 1);
  const double rate = pi * std::cos(1.0);
  EXPECT_LT((scene.bodies.spin[0] - Vec3(0, 0, 1 + 2 * rate)).norm(), 1e-14);
  EXPECT_LT((scene.bodies.velocity[0] - Vec3(0, 2 * (1 + 2 * rate), rate)).norm(), 1e-14);
  EXPECT_EQ(scene.motions[1].keyframes[1].at, 2);
  EXPECT_FALSE(scene.motions[1].keyframes[1].orientation);
  EXPECT_EQ(scene.bodies.position[1], Vec3(0, 9, 0));
  EXPECT_NEAR(scene.bodies.orientation[1].z(), std::sqrt(0.5), 1e-15);
  EXPECT_EQ(scene.motions[2].keyframes[0].orientation->w(), 1);
  EXPECT_NEAR(scene.motions[2].keyframes[1].orientation->x(), std::sin(0.5), 1e-15);
  ASSERT_EQ(scene.servos.size(), 2u);
  EXPECT_EQ(scene.servos[1].body, 4);
  EXPECT_LT((scene.servos[1].axis - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  EXPECT_EQ(scene.servos[1].force, -5);
  EXPECT_EQ(scene.bodies.mobility[4], Mobility::free);
  EXPECT_EQ(scene.bodies.inverse_mass[4], 0.25);
  EXPECT_EQ(scene.bodies.inverse_inertia[4], Vec3(0, 0, 0));
  const Scene again = parse(scene.resolved);
  EXPECT_EQ(again.resolved, scene.resolved);
  EXPECT_EQ(hash_of(again.bodies), hash_of(scene.bodies));
  EXPECT_EQ(again.motions[2].keyframes[1].orientation->coeffs(),
            scene.motions[2].keyframes[1].orientation->coeffs());
}

TEST(SceneLanguage, AbsentKeysTakeTheirDefaults) {
  const Scene scene = parse(
      "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {}}\nbodies: [{sphere: {radius: 1}, "
      "material: "
      "glass}]\nrender: false\n");
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.materials[0].density, 1000);
  EXPECT_FALSE(scene.render.enabled);
  EXPECT_FALSE(scene.render.camera);
  EXPECT_EQ(scene.broadphase.levels, 0);
  EXPECT_EQ(scene.bodies.velocity[0], Vec3(0, 0, 0));
  EXPECT_EQ(scene.bodies.orientation[0].coeffs(), Quat::Identity().coeffs());
}

TEST(ResolvedScene, ParsesBackToTheSameScene) {
  const Scene scene = parse(full_scene);
  const Scene again = parse(scene.resolved);
  EXPECT_EQ(again.resolved, scene.resolved);
  EXPECT_EQ(hash_of(again.bodies), hash_of(scene.bodies));
  EXPECT_EQ(again.body_names, scene.body_names);
  ASSERT_EQ(again.laws.size(), scene.laws.size());
  for (std::size_t i = 0; i < scene.laws.size(); ++i) {
    EXPECT_EQ(again.laws[i].friction, scene.laws[i].friction);
    EXPECT_EQ(again.laws[i].restitution, scene.laws[i].restitution);
  }
  ASSERT_EQ(again.motions.size(), 1u);
  EXPECT_EQ(again.motions[0].body, scene.motions[0].body);
  EXPECT_EQ(again.motions[0].spin, scene.motions[0].spin);
}

TEST(ResolvedScene, WritesDefaultsOut) {
  const std::string resolved =
      parse(
          "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {}}\nbodies: [{sphere: {radius: 1}, "
          "material: glass}]\n")
          .resolved;
  for (const char* part :
       {"name: test\n", "gravity: [0, 0, 0]\n", "time: {end: 1, step: 0.1, substeps: auto}\n",
        "  glass: {density: 1000, restitution: 0, friction: 0}\n",
        "at: [0, 0, 0], orientation: [1, 0, 0, 0], velocity: [0, 0, 0], spin: [0, 0, 0], fixed: false",
        "broadphase: {method: hierarchical_grid, levels: auto}\n", "restitution_threshold: auto",
        "camera: auto"})
    EXPECT_NE(resolved.find(part), std::string::npos) << part << "\n" << resolved;
  EXPECT_EQ(parse(resolved).resolved, resolved);
}

TEST(ResolvedScene, IsASceneWhateverIsNamedAndHowever) {
  const auto resolved = [](const std::string& material, const std::string& rest) {
    return parse("format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {" + material +
                 ": {}}\nbodies: [{sphere: {radius: 1}, material: " + material + "}]\n" + rest)
        .resolved;
  };
  for (const std::string& text :
       {resolved("\"null\"", ""), resolved("true", ""), resolved(std::string(200, 'm'), ""),
        resolved("glass", "name: \"\\x7F, \\\"#\\\": \\u2028\\u0085\"\n"),
        resolved("glass", "render: {camera: {keyframes: [{at: 0, from: [1, 0, 0], to: [0, 0, 0]}]}}\n")})
    EXPECT_EQ(parse(text).resolved, text);
}

TEST(ResolvedScene, OfEmittersIsAScene) {
  const std::string resolved =
      parse(
          "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {}}\nbodies: [{box: {size: 1}, material: "
          "glass, emit: {count: 3, rate: 5, from: [0, 0, 0], to: [9, 9, 9]}, velocity: [0, 0, "
          "-1]}]\nregions: "
          "{sink: {from: [0, 0, -9], to: [9, 9, -8], removes: true}}\n")
          .resolved;
  EXPECT_EQ(parse(resolved).resolved, resolved);
}

/// Calls f(path, key) for every key of the table.
void visit_keys(const Type& type, const std::function<void(const SectionType&, const KeyType&)>& f) {
  if (type.section)
    for (const KeyType& key : type.section->keys) {
      f(*type.section, key);
      visit_keys(key.type, f);
    }
  for (const Type& part : type.parts) visit_keys(part, f);
}

// Validates a value by the few keywords that the schema uses; written from the specification (draft 2020-12).
bool is_valid(const Json& value, const Json& schema) {
  if (schema.contains("anyOf")) {
    int fits = 0;
    for (const Json& part : schema["anyOf"]) fits += is_valid(value, part);
    return fits > 0;
  }
  if (schema.contains("enum")) {
    for (const Json& word : schema["enum"])
      if (word == value) return true;
    return false;
  }
  const std::string type = schema["type"];
  if (type == "string") return value.is_string();
  if (type == "integer" && !value.is_number_integer()) return false;
  if (type == "integer" || type == "number") {
    if (!value.is_number()) return false;
    const double x = value;
    return !(schema.contains("minimum") && x < schema["minimum"].get<double>()) &&
           !(schema.contains("maximum") && x > schema["maximum"].get<double>()) &&
           !(schema.contains("exclusiveMinimum") && x <= schema["exclusiveMinimum"].get<double>()) &&
           !(schema.contains("exclusiveMaximum") && x >= schema["exclusiveMaximum"].get<double>());
  }
  if (type == "array") {
    if (!value.is_array() || value.size() < schema.value("minItems", 0u)) return false;
    if (schema.contains("maxItems") && value.size() > schema["maxItems"].get<std::size_t>()) return false;
    for (const Json& item : value)
      if (!is_valid(item, schema["items"])) return false;
    return true;
  }
  if (!value.is_object()) return false;
  for (const auto& [key, item] : value.items()) {
    const bool known = schema.contains("properties") && schema["properties"].contains(key);
    if (!known && schema["additionalProperties"] == false) return false;
    if (!is_valid(item, known ? schema["properties"][key] : schema["additionalProperties"])) return false;
  }
  if (schema.contains("required"))
    for (const Json& key : schema["required"])
      if (!value.contains(key.get<std::string>())) return false;
  return true;
}

TEST(SceneSchema, AcceptsScenesAndRefusesBadOnes) {
  const Json schema = Json::parse(scene_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  const Json full = json_of(parse_document(full_scene));
  EXPECT_TRUE(is_valid(full, schema));
  EXPECT_TRUE(is_valid(json_of(parse_document(parse(full_scene).resolved)), schema));

  const auto refuses = [&](const char* pointer, const Json& value) {
    Json changed = full;
    changed[Json::json_pointer(pointer)] = value;
    return !is_valid(changed, schema);
  };
  EXPECT_TRUE(refuses("/gravitty", 1));
  EXPECT_TRUE(refuses("/format", 2));
  EXPECT_TRUE(refuses("/time/step", 0));
  EXPECT_TRUE(refuses("/time/step", "fast"));
  EXPECT_TRUE(refuses("/materials/glass/restitution", 1.5));
  EXPECT_TRUE(refuses("/bodies/2/sphere/radius", -1));
  EXPECT_TRUE(refuses("/bodies/2/at", Json{1, 2}));
  EXPECT_TRUE(refuses("/precision", "half"));
  EXPECT_TRUE(refuses("/bodies", Json::array()));
  Json incomplete = full;
  incomplete.erase("time");
  EXPECT_FALSE(is_valid(incomplete, schema));
}

TEST(SceneSchema, NamesEveryKeyOfThisVersionAndNoLaterOne) {
  const std::string text = scene_schema();
  const std::string flat = Json::parse(text).dump();
  visit_keys(scene_codec().type, [&](const SectionType&, const KeyType& key) {
    if (key.presence == Presence::future) return;
    EXPECT_NE(flat.find('"' + key.name + "\":"), std::string::npos) << key.name;
  });
  EXPECT_FALSE(Json::parse(text)["properties"].contains("crosscheck"));
}

TEST(SceneReference, IsTheCommittedPage) {
  const std::string file = SCREE_SOURCE_DIR "/docs/scene.md";
  if (std::getenv("SCREE_WRITE")) std::ofstream(file) << scene_reference();
  std::stringstream page;
  page << std::ifstream(file).rdbuf();
  EXPECT_TRUE(page.str() == scene_reference()) << "SCREE_WRITE=1 writes it anew";
}

TEST(SceneReference, NamesEveryKeyAndMeasureAndItsExampleLoads) {
  const std::string page = scene_reference();
  visit_keys(scene_codec().type, [&](const SectionType& section, const KeyType& key) {
    EXPECT_FALSE(key.help.empty()) << section.name << ": " << key.name;
    EXPECT_NE(page.find('`' + key.name), std::string::npos) << key.name;
  });
  for (const MeasureInfo& info : measure_table())
    EXPECT_NE(page.find(info.name), std::string::npos) << info.name;
  const std::size_t start = page.find("```yaml\n") + 8;
  EXPECT_EQ(parse(page.substr(start, page.find("```", start) - start)).bodies.count(), 52);
}

TEST(Override, ChangesValuesOfAnyDepth) {
  const Scene scene = parse(full_scene, {{"time.step", "0.001"},
                                         {"bodies[2].velocity[0]", "3"},
                                         {"materials.steel.density", "8000"},
                                         {"gravity", "[0, 0, -1]"},
                                         {"checks[2].below", "2"},
                                         {"bodies[3].sphere.radius", "{choose: [0.05]}"},
                                         {"name", "other"}});
  EXPECT_EQ(scene.time.step, 0.001);
  EXPECT_EQ(scene.bodies.velocity[2], Vec3(3, 0, 0));
  EXPECT_EQ(scene.materials[1].density, 8000);
  EXPECT_EQ(scene.gravity, Vec3(0, 0, -1));
  EXPECT_EQ(scene.checks[2].below, 2);
  EXPECT_EQ(scene.bodies.size[3].x(), 0.05);
  EXPECT_EQ(scene.name, "other");
}

TEST(Override, CreatesWhatTheTableKnows) {
  const std::string text =
      "format: 1\ntime: {end: 1, step: 0.1}\nmaterials: {glass: {}}\nbodies: [{sphere: {radius: 1}, "
      "material: "
      "glass}]\nmodel: auto\n";
  const Scene scene = parse(text, {{"response.iterations", "7"},
                                   {"gravity[2]", "-9.81"},
                                   {"bodies[0].velocity[1]", "4"},
                                   {"model.friction", "off"},
                                   {"render.camera.fov", "30"}});
  EXPECT_EQ(scene.response.iterations, 7);
  EXPECT_EQ(scene.gravity, Vec3(0, 0, -9.81));
  EXPECT_EQ(scene.bodies.velocity[0], Vec3(0, 4, 0));
  EXPECT_EQ(scene.model.friction, false);
  ASSERT_TRUE(scene.render.camera);
  EXPECT_EQ(scene.render.camera->fov, 30);
  EXPECT_EQ(scene.render.camera->from, CameraSettings{}.from);
}

TEST(Override, NamesTheUnknownPartOfThePath) {
  const auto message = [](const char* path, const char* value) {
    try {
      parse(full_scene, {{path, value}});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message("tim.step", "1"), "--set tim.step=1: the scene has no tim (did you mean time?)");
  EXPECT_EQ(message("time.stepp", "1"), "--set time.stepp=1: time has no stepp (did you mean step?)");
  EXPECT_EQ(message("time.step.x", "1"), "--set time.step.x=1: time.step has no keys, so there is no x");
  EXPECT_EQ(message("bodies.ball", "1"),
            "--set bodies.ball=1: bodies is a list, so there is no ball: write bodies[0], bodies[1], ...");
  EXPECT_EQ(message("time[0]", "1"), "--set time[0]=1: time is no list");
  EXPECT_EQ(message("bodies[8].mass", "1"), "--set bodies[8].mass=1: bodies has 8 items, so there is no [8]");
  EXPECT_EQ(message("bodies[-1].mass", "1"), "--set bodies[-1].mass=1: [-1].mass is no index such as [2]");
  EXPECT_EQ(message("materials.glas.density", "1"),
            "--set materials.glas.density=1: materials has no glas (did you mean glass?)");
  EXPECT_EQ(message("crosscheck.of", "1"),
            "--set crosscheck.of=1: crosscheck is part of the scene language but not in this version");
  EXPECT_EQ(message("time..step", "1"), "--set time..step=1: the path has an empty part");
  EXPECT_EQ(message("", "1"), "--set =1: the path has an empty part");
  EXPECT_EQ(message("time.step", "[1"), "--set time.step=[1: broken YAML: end of sequence flow not found");
  EXPECT_EQ(message("time.step", "-1"), "--set time.step=-1: time.step: must be a number > 0 (s), not -1");
  EXPECT_EQ(message("bodies[2].material", "gold"),
            "--set bodies[2].material=gold: bodies[2].material: there is no material gold");
}

}  // namespace
}  // namespace scree
