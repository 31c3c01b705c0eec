// Tests of every kind of bad scene: the message names the place, the key and what is allowed.
#include "core/error.hpp"
#include "sim/scene/scene.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <tuple>

namespace scree {
namespace {

struct BadScene {
  const char* name;
  int line;
  int column;
  const char* fragment;
};

const std::filesystem::path folder = SCREE_SOURCE_DIR "/tests/data/bad";

// clang-format off
constexpr BadScene bad_scenes[] = {
    {"unknown_key", 7, 1, "gravitty: unknown key (did you mean gravity?)"},
    {"unknown_key_far", 7, 1, "bananas: unknown key (known here: format, name,"},
    {"unknown_key_deep", 6, 15, "bodies[0].sphere.radios: unknown key (did you mean radius?)"},
    {"wrong_type_number", 3, 22, "time.step: must be a number > 0 (s), not fast"},
    {"wrong_type_quoted", 3, 22, "time.step: must be a number > 0 (s), not \"0.01\", which is text: take the quotes away"},
    {"wrong_type_quoted_truth", 6, 34, "bodies[0].fixed: must be one of true, false, on, off, not \"true\", which is text: take the quotes away"},
    {"wrong_type_list", 7, 10, "gravity: must be a list of 3 numbers (m/s^2), or a map {vector, spin, keyframes}, not -9.81"},
    {"wrong_length", 7, 10, "gravity: must be a list of 3 numbers (m/s^2), not a list of 2"},
    {"wrong_type_map", 3, 7, "time: must be a map {end, step, substeps}, not a list of 2"},
    {"wrong_type_whole", 3, 38, "time.substeps: must be a whole number from 1 to 1000000, not 1.5"},
    {"no_value", 3, 13, "time.end: must be a number > 0 (s), not nothing"},
    {"top_is_list", 2, 1, "must be a map {format, name,"},
    {"radius_negative", 6, 23, "bodies[0].sphere.radius: must be a number > 0 (m), not -0.1"},
    {"radius_zero", 6, 23, "bodies[0].sphere.radius: must be a number > 0 (m), not 0"},
    {"radius_word", 6, 23, "must be a number > 0 (m), or a map {uniform, powerlaw, choose}, not big"},
    {"size_negative", 6, 22, "bodies[0].box.size[1]: must be a number > 0 (m), not -1"},
    {"size_zero", 6, 25, "bodies[0].box.size[2]: must be a number > 0 (m), not 0.0"},
    {"nan", 6, 41, "bodies[0].velocity[1]: must be a number (m/s), not .nan"},
    {"inf", 6, 32, "bodies[0].at[0]: must be a number (m), not .inf"},
    {"overflow", 6, 32, "bodies[0].at[0]: 1e999 is out of range"},
    {"missing_step", 3, 7, "time.step: is missing; it must be a number > 0 (s)"},
    {"missing_format", 2, 1, "format: is missing; it must be 1"},
    {"missing_material", 6, 5, "bodies[0].material: is missing"},
    {"missing_bodies", 2, 1, "bodies: is missing"},
    {"empty_bodies", 5, 9, "bodies: must be a list"},
    {"unknown_material", 6, 39, "bodies[0].material: there is no material glas (did you mean glass?)"},
    {"unknown_material_pair", 8, 23, "contacts[0].between: there is no material steel"},
    {"pair_twice", 9, 15, "the pair is listed already, at "},
    {"unknown_body", 8, 15, "checks[0].measure: bal.position.z is no measure: there is no body called bal (did you mean ball?)"},
    {"unknown_measure", 8, 15, "energy.totl is no measure: energy.totl is unknown (did you mean energy.total?)"},
    {"measure_component", 8, 15, "ball.velocity is no measure: velocity needs .x, .y, .z or .norm"},
    {"measure_region", 10, 15, "region.exti.flux is no measure: there is no region called exti (did you mean exit?)"},
    {"measure_of_region", 10, 15, "region.exit.mass is no measure: mass is unknown (scree plan --reference lists all measures)"},
    {"world_flat", 7, 33, "world.to: must be greater than `from` in each component, but -9 <= -9"},
    {"periodic_nothing", 7, 11, "periodic: needs x, y or z"},
    {"periodic_plane", 7, 13, "bodies[1].plane: must be parallel to x, which is periodic: its normal has a part of 1 along it"},
    {"periodic_region", 9, 31, "regions.long.to: must be at most a period, 10 m, beyond `from` along y: a body is there once"},
    {"periodic_reversed", 7, 27, "periodic.z: must be [low, high] with low < high"},
    {"periodic_too_short", 7, 28, "periodic.x: must be at least 4.4 m long, not 4.1 m: twice what the spheres around two of these bodies reach"},
    {"periodic_tube", 6, 12, "bodies[0].tube: does not go with `periodic`"},
    {"periodic_world", 8, 32, "world.to: must be at least a period, 10 m, beyond `from` along y: what leaves there comes in again"},
    {"world_word", 7, 53, "world.leaving: must be one of stop, remove, ignore, not removed (did you mean remove?)"},
    {"region_flat", 8, 39, "regions.exit.to: must be greater than `from` in each component, but 0 <= 0"},
    {"region_open", 8, 17, "regions.exit.to: is missing; it must be a list of 3 numbers (m)"},
    {"region_name", 8, 11, "regions.the exit: must be a name: a letter or _"},
    {"check_expects_nothing", 8, 5, "checks[0]: expects nothing; it needs expect, below or above"},
    {"check_mode_limit", 8, 66,
     "checks[0].in_default_mode: needs exactly one of tolerance, relative, below, above"},
    {"check_one_seed", 8, 51, "checks[0].confidence: needs seeds: 2 or more, at the top of the scene"},
    {"check_certain", 9, 51, "checks[0].confidence: must be between 0 and 1, neither of them"},
    {"check_no_tolerance", 8, 37, "checks[0].expect: needs tolerance or relative"},
    {"check_tolerance_alone", 8, 50, "checks[0].tolerance: needs expect"},
    {"check_over_no_reduce", 8, 35, "checks[0].over: needs reduce"},
    {"check_reduce_no_over", 8, 37, "checks[0].reduce: needs over"},
    {"check_at_and_over", 8, 36, "checks[0].over: cannot stand together with at"},
    {"check_beyond_end", 8, 33, "checks[0].at: must be at most the end, 1 s, not 2 s"},
    {"check_span_beyond_end", 8, 35, "checks[0].over: must end at the end, 1 s, or before, not at 2 s"},
    {"check_span_reversed", 8, 35, "checks[0].over: must be [start, end] with start <= end"},
    {"check_level", 8, 63, "checks[0].level: needs reduce: crossings"},
    {"duplicate_key", 6, 1, "seed: duplicate key, already given at 5:1"},
    {"duplicate_key_deep", 6, 28, "radius: duplicate key, already given at 6:15"},
    {"duplicate_material", 5, 3, "glass: duplicate key, already given at 4:3"},
    {"duplicate_name", 7, 35, "bodies[1].name: ball is the name of a body already, at "},
    {"reserved_name", 6, 35, "bodies[0].name: energy is a word of measures; choose another"},
    {"name_with_dot", 6, 35, "bodies[0].name: must be a name: a letter or _, then letters, digits, _ and -, not a.b"},
    {"scene_name", 7, 7, "name: must be a name without slashes, not starting with a dot"},
    {"truncated", 6, 1, "broken YAML: end of sequence flow not found"},
    {"broken", 5, 8, "broken YAML: illegal map value"},
    {"tab", 6, 1, "a tab in the indentation; YAML is indented with spaces"},
    {"control", 5, 7, "control character 0x04"},
    {"not_utf8", 5, 10, "byte 0xE9 is not UTF-8 text"},
    {"two_documents", 8, 1, "a second YAML document"},
    {"tag", 7, 7, "tag !seed (the scene language has no tags but those of YAML's core schema)"},
    {"tag_wrong", 7, 7, "the text is not what its tag tag:yaml.org,2002:int says"},
    {"alias_bomb", 6, 36, "aliases add more than 100000 nodes"},
    {"alias_loop", 2, 13, "an alias inside its own anchor"},
    {"deep", 2, 38, "nested deeper than 32 levels"},
    {"wrong_format", 2, 9, "format: must be 1, not 2"},
    {"axis_zero", 6, 37, "bodies[0].rotate.axis: must not be zero"},
    {"no_angle", 6, 30, "bodies[0].rotate: needs degrees or radians"},
    {"two_angles", 6, 61, "bodies[0].rotate.radians: cannot stand together with degrees"},
    {"orientation_zero", 6, 35, "bodies[0].orientation: must not be zero"},
    {"orientation_and_rotate", 6, 49, "bodies[0].rotate: cannot stand together with orientation"},
    {"normal_zero", 6, 22, "bodies[0].plane.normal: must not be zero"},
    {"plane_velocity", 6, 34, "bodies[0].velocity: does not go with a plane"},
    {"mesh_free", 6, 12, "bodies[0].mesh: never moves freely: give `fixed: true` or `motion`"},
    {"mesh_mass", 6, 56, "bodies[0].mass: does not go with a mesh, which is there once and never moves freely"},
    {"mesh_missing", 6, 12, "nowhere.obj: cannot be read: No such file or directory"},
    {"mesh_suffix", 6, 12, "mesh_free.yaml: is none of .obj, .stl and .ply"},
    {"mesh_number", 6, 12, "number.obj:3: needs three finite numbers, not `one`"},
    {"mesh_index", 6, 12, "index.obj:5: `4` is none of the 3 vertices so far"},
    {"mesh_lines", 6, 12, "lines.obj: has no triangle with an area"},
    {"mesh_stl_word", 6, 12, "word.stl:5: `vertices` is no word of an STL file"},
    {"mesh_stl_short", 6, 12, "short.stl: ends within a facet"},
    {"mesh_scale", 6, 49, "bodies[0].mesh.scale: must not be 0: nothing would be left of the mesh"},
    {"mesh_scale_axis", 6, 49, "bodies[0].mesh.scale: must not be 0: nothing would be left of the mesh"},
    {"mesh_weld", 6, 48, "bodies[0].mesh.weld: must be "},
    {"polyhedron_flat", 6, 18, "bodies[0].polyhedron: the points lie in a plane, or nearly"},
    {"polyhedron_few", 6, 27, "bodies[0].polyhedron.points: must be a list of"},
    {"polyhedron_nothing", 6, 18, "bodies[0].polyhedron: needs points or file"},
    {"polyhedron_both", 6, 73, "bodies[0].polyhedron.file: cannot stand together with points"},
    {"capsule_length", 6, 15, "bodies[0].capsule.length: is missing; it must be a number > 0 (m)"},
    {"cylinder_radius", 6, 25, "bodies[0].cylinder.radius: must be a number > 0 (m), not 0"},
    {"tube_and_capsule", 6, 12, "bodies[0].tube: holds spheres and boxes alone"},
    {"tube_free", 6, 12, "bodies[0].tube: never moves freely: give `fixed: true` or `motion`"},
    {"tube_mass", 6, 53, "bodies[0].mass: does not go with a tube, which never moves freely"},
    {"tube_velocity", 6, 40, "bodies[0].velocity: does not go with a tube"},
    {"tube_scatter", 6, 53, "bodies[0].scatter: does not go with a tube"},
    {"tube_radius", 6, 21, "bodies[0].tube.radius: must be a number > 0 (m), not 0"},
    {"tube_no_length", 6, 12, "bodies[0].tube.length: is missing; it must be a number > 0 (m)"},
    {"step_negative", 3, 22, "time.step: must be a number > 0 (s), not -0.01"},
    {"end_zero", 3, 13, "time.end: must be a number > 0 (s), not 0"},
    {"step_beyond_end", 3, 22, "time.step: must be at most the end, 1 s, not 2 s"},
    {"step_tiny", 3, 22, "time.step: is so short that the run would have more than 2^53 steps"},
    {"substeps_zero", 3, 38, "time.substeps: must be a whole number from 1 to 1000000, not 0"},
    {"fixed_velocity", 6, 40, "bodies[0].velocity: cannot stand together with fixed"},
    {"fixed_motion", 6, 40, "bodies[0].motion: cannot stand together with fixed"},
    {"motion_velocity", 6, 54, "bodies[0].velocity: cannot stand together with motion"},
    {"mass_zero", 6, 33, "bodies[0].mass: must be a number > 0 (kg), not 0"},
    {"mass_underflow", 6, 5, "bodies[0]: its mass and inertia are beyond what numbers can hold"},
    {"restitution_large", 4, 49, "materials.glass.restitution: must be a number from 0 to 1, not 1.1"},
    {"convex_word", 7, 23, "narrowphase.convex: must be one of auto, axes, ccd_gjk, ccd_mpr, not ccd_gkj (did you mean ccd_gjk?)"},
    {"crosscheck_share", 7, 27, "narrowphase.crosscheck: must be a number from 0 to 1, not 1.5"},
    {"friction_negative", 4, 46, "materials.glass.friction: must be a number >= 0, not -0.4"},
    {"no_shape", 6, 5, "bodies[0]: must have exactly one shape (plane, sphere, box, tube, capsule, cylinder, polyhedron or mesh), not none"},
    {"two_shapes", 6, 5, "bodies[0]: must have exactly one shape (plane, sphere, box, tube, capsule, cylinder, polyhedron or mesh), not 2"},
    {"bad_word", 7, 22, "broadphase.method: must be one of hierarchical_grid, alternative_grid, uniform_grid, sweep_and_prune, lbvh, brute_force, not brute_froce (did you mean brute_force?)"},
    {"uniform_reversed", 6, 33, "bodies[0].sphere.radius.uniform: must be [low, high] with low <= high"},
    {"powerlaw_zero", 6, 34, "bodies[0].sphere.radius.powerlaw: must be [min, max, exponent] with 0 < min <= max"},
    {"two_distributions", 6, 23, "bodies[0].sphere.radius: must have exactly one of uniform, powerlaw, choose"},
    {"choose_nothing", 6, 32, "bodies[0].sphere.radius.choose: must be a list"},
    {"repeat_zero", 6, 47, "bodies[0].repeat.count[1]: must be a whole number >= 1, not 0"},
    {"repeat_overflow", 6, 35, "bodies[0].repeat: the scene would have 7.29e+38 bodies"},
    {"too_many", 6, 35, "bodies[0].repeat: the scene would have 8000000000 bodies; at most 2147483647 are possible"},
    {"repeat_and_scatter", 6, 75, "bodies[0].scatter: cannot stand together with repeat"},
    {"scatter_reversed", 6, 68, "bodies[0].scatter.to: must be at least `from` in each component, but 0 < 1"},
    {"emit_until", 6, 29, "bodies[0].emit: cannot stand together with until"},
    {"emit_fixed", 6, 29, "bodies[0].emit: cannot stand together with fixed"},
    {"emit_and_scatter", 6, 29, "bodies[0].emit: cannot stand together with scatter"},
    {"emit_reversed", 6, 77, "bodies[0].emit.to: must be at least `from` in each component, but 0 < 1"},
    {"emit_no_rate", 6, 35, "bodies[0].emit.rate: is missing; it must be a number > 0 (1/s)"},
    {"emit_rate_zero", 6, 52, "bodies[0].emit.rate: must be a number > 0 (1/s), not 0"},
    {"emit_late", 6, 95, "bodies[0].from: must be before the end, 1 s, not 2 s"},
    {"scatter_full", 6, 36, "of 100 bodies fit without overlap; make the region larger or the bodies fewer or smaller, or list larger bodies first"},
    {"camera", 7, 18, "render.camera: `from` and `to` must not be the same point"},
    {"camera_from_alone", 7, 18, "render.camera: `from` and `to` must be given together, or neither"},
    {"orbit_twice", 7, 40, "render.camera.orbit.degrees_per_second: cannot stand together with degrees"},
    {"orbit_nothing", 7, 26, "render.camera.orbit: needs degrees or degrees_per_second"},
    {"keyframes_unsorted", 7, 30, "render.camera.keyframes: must be in order of time, but 0.5 s follows 1 s"},
    {"keyframes_and_fov", 7, 73, "render.camera.fov: cannot stand together with keyframes"},
    {"range_reversed", 7, 31, "render.range: must be [low, high] with low < high"},
    {"range_of_kinds", 7, 28, "render.range: needs a color that is a number"},
    {"overlay_word", 7, 20, "render.overlay[0]: must be one of grid, pairs, forces, not girds"},
    {"trajectory_every", 7, 30, "record.trajectory.every: must be a number > 0 (s), not 0"},
    {"mixed_accurate", 7, 12, "precision: cannot be mixed in the accurate mode, whose tolerance is beyond it"},
    {"body_beyond_end", 8, 65, "bodies[2].from: must be before the end, 1 s, not 1 s"},
    {"body_gone_first", 8, 77, "bodies[2].until: must be at least a step after from, 0.5 s, not 0.501 s"},
    {"check_absent", 10, 36, "checks[0].at: the body is not there at 0.7 s; see its from and until"},
    {"check_over_absent", 10, 38, "checks[0].over: the body is not there at 0 s; see its from and until"},
    {"file_missing", 8, 12, "bodies[2].file: "},
    {"file_folder", 8, 12, "is a folder without final.csv, which a run writes when it is done"},
    {"file_empty_path", 8, 12, "bodies[2].file: must be the path of a file of bodies or of a run's folder"},
    {"file_with_at", 8, 41, "bodies[2].at: does not go with a file"},
    {"file_with_shape", 8, 41, "bodies[2].plane: does not go with a file"},
    {"file_two_shapes", 6, 41, "bodies[0].box: cannot stand together with sphere"},
    {"shape_alone", 6, 6, "bodies[0].shape: goes with `file`; else the shape is a key of its own"},
    {"frame_alone", 6, 27, "bodies[0].frame: goes with `file`"},
    {"hint_diameter", 6, 15, "bodies[0].sphere.diameter: unknown key; write `radius`, half of it"},
    {"hint_half_size", 6, 12, "bodies[0].box.halfSize: unknown key; write `size: [x, y, z]`, full edges: twice of it"},
    {"hint_position", 6, 27, "bodies[0].position: unknown key; write `at: [x, y, z]`, in m"},
    {"hint_euler", 6, 22, "bodies[0].euler: unknown key; write `rotate: {axis: [0, 0, 1], degrees: 30}`"},
    {"hint_rpm", 6, 31, "bodies[0].motion.rpm: unknown key; write `spin`, a vector in rad/s: rpm times pi / 30"},
    {"hint_youngs_modulus", 4, 36, "materials.glass.youngs_modulus: unknown key; bodies are rigid: leave it out"},
    {"hint_dt", 3, 16, "time.dt: unknown key; write `step`, in seconds"},
    {"too_many_names", 8, 52, "bodies[2].repeat: a run of the scene's 1000000002 bodies needs "},
    {"scatter_too_many", 8, 53, "bodies[2].scatter: a run of the scene's 1000000002 bodies needs "},
    {"force_unknown_body", 9, 10, "forces[0].on: there is no body called bal (did you mean ball?)"},
    {"force_on_fixed", 9, 10, "forces[0].on: wall is not free; forces move free bodies alone"},
    {"force_nothing", 9, 5, "forces[0]: needs force or torque"},
    {"force_beyond_end", 9, 40, "forces[0].from: must be before the end, 1 s, not 2 s"},
    {"force_reversed", 9, 52, "forces[0].until: must be at least a step after from, 0.5 s, not 0.2 s"},
    {"force_scalar", 9, 23, "forces[0].force: must be a list of 3 numbers (N), not 3"},
    {"lattice_infinite", 6, 5, "bodies[0]: its place, orientation or motion is beyond what numbers can hold"},
    {"angle_infinite", 6, 5, "bodies[0]: its place, orientation or motion is beyond what numbers can hold"},
    {"motion_infinite", 6, 5, "bodies[0]: its place, orientation or motion is beyond what numbers can hold"},
    {"scatter_infinite", 6, 73, "bodies[0].scatter.to: is so far from `from` that numbers cannot hold the distance"},
    {"key_long", 3, 1, "a key longer than 200 bytes"},
    {"about_without_spin", 6, 43, "bodies[0].motion.about: needs a spin or oscillate.angle that is not zero"},
    {"oscillate_nothing", 6, 53, "bodies[0].motion.oscillate: needs a displacement or an angle that is not zero"},
    {"oscillate_no_frequency", 6, 53, "bodies[0].motion.oscillate.frequency: is missing; it must be a number > 0 (Hz)"},
    {"oscillate_across", 6, 70, "bodies[0].motion.oscillate: must have its angle parallel to the spin"},
    {"motion_keyframes_and_velocity", 6, 115, "bodies[0].motion.velocity: cannot stand together with keyframes"},
    {"motion_keyframes_none", 6, 53, "bodies[0].motion.keyframes: must be a list of items, each a map {at, position, orientation, rotate}, not a list of 0"},
    {"motion_keyframes_unsorted", 6, 53, "bodies[0].motion.keyframes: must be in order of time, but 1 s follows 1 s"},
    {"motion_keyframes_at", 6, 33, "bodies[0].at: does not go with motion.keyframes, which say where the body is"},
    {"motion_keyframes_rotate", 6, 33, "bodies[0].rotate: does not go with motion.keyframes that have orientations"},
    {"motion_keyframes_half", 6, 53, "bodies[0].motion.keyframes: must all have an orientation, or none"},
    {"motion_keyframes_orientation", 6, 96, "bodies[0].motion.keyframes[0].orientation: must not be zero"},
    {"servo_axis", 6, 47, "bodies[0].servo.axis: must not be zero"},
    {"servo_velocity", 6, 69, "bodies[0].velocity: cannot stand together with servo"},
    {"servo_sphere", 6, 34, "bodies[0].servo: goes with a box alone"},
    {"servo_mixed", 7, 12, "precision: cannot be mixed where a body is a servo"},
    {"force_on_servo", 8, 10, "forces[0].on: box is a servo, which has a force of its own"},
    {"gravity_no_spin", 5, 10, "gravity: needs vector and spin, or keyframes"},
    {"gravity_both", 5, 81, "gravity.spin: cannot stand together with keyframes"},
    {"gravity_unsorted", 5, 22, "gravity.keyframes: must be in order of time, but 0 s follows 1 s"},
};
// clang-format on

std::string message_of(const std::string& text, const std::vector<Override>& overrides = {}) {
  try {
    parse_scene(text, "test.yaml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

bool begins_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

class BadSceneFile : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneFile, IsRefusedAtItsPlace) {
  const auto& [name, line, column, fragment] = GetParam();
  const std::filesystem::path file = folder / (std::string(name) + ".yaml");
  try {
    read_scene(file);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string place =
        file.string() + ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
    const std::string first = std::string(error.what()).substr(0, std::string(error.what()).find('\n'));
    EXPECT_TRUE(begins_with(first, place)) << "not at " << place << "\n" << first;
    EXPECT_NE(first.find(fragment), std::string::npos) << fragment << "\n" << first;
  }
}

INSTANTIATE_TEST_SUITE_P(Files, BadSceneFile, testing::ValuesIn(bad_scenes),
                         [](const auto& bad) { return std::string(bad.param.name); });

TEST(BadScenes, EveryFileIsInTheTableAndOpensWithWhatIsWrong) {
  std::set<std::string> listed;
  for (const BadScene& scene : bad_scenes) listed.insert(scene.name);
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    found.insert(entry.path().stem().string());
    std::string line;
    std::getline(std::ifstream(entry.path()) >> std::ws, line);
    EXPECT_TRUE(begins_with(line, "# Wrong: ")) << entry.path();
  }
  EXPECT_EQ(listed, found);
}

TEST(BadScenes, SeveralErrorsAreToldAtOnce) {
  const std::string message =
      message_of("format: 1\ntime: {end: -1, stepp: 1}\nmaterials: {glass: {friction: -1}}\nbodies: []\n");
  EXPECT_NE(message.find("test.yaml:2:13: time.end: must be"), std::string::npos) << message;
  EXPECT_NE(message.find("test.yaml:2:17: time.stepp: unknown key (did you mean step?)"), std::string::npos);
  EXPECT_NE(message.find("test.yaml:3:31: materials.glass.friction: must be"), std::string::npos);
  EXPECT_NE(message.find("test.yaml:4:9: bodies: must be a list"), std::string::npos);
}

TEST(BadScenes, ManyErrorsAreCounted) {
  std::string text = "format: 1\ntime: {end: 1, step: 1}\nmaterials: {glass: {}}\nbodies:\n";
  for (int i = 0; i < 100; ++i) text += "  - {sphere: {radius: -1}, material: glass}\n";
  EXPECT_NE(message_of(text).find("and 92 more errors"), std::string::npos) << message_of(text);
}

TEST(BadScenes, EscapesThatAreReadAsHalfCharacters) {
  for (const char* escape : {"\\N", "\\_"})
    EXPECT_EQ(message_of(std::string("format: 1\nname: \"a") + escape + "\"\n"),
              "test.yaml:2:7: the escape \\N or \\_; write \\x85 or \\xA0");
}

// A comma is one byte of the file, but a body takes a thousand bytes of memory.
TEST(BadScenes, AThousandErrorsAreEnough) {
  const std::string text = "format: 1\nbodies: [" + std::string(1'000'000, ',') + "]\n";
  EXPECT_NE(message_of(text).find("and at least 99"), std::string::npos) << message_of(text);
}

TEST(BadScenes, CopiesThatAnchorsHoldAreBounded) {
  std::string text = "x";
  for (int i = 0; i < 4000; ++i) text += ", x";
  for (int i = 0; i < 30; ++i) text = "&a" + std::to_string(i) + " [" + text + "]";
  EXPECT_NE(message_of("a: " + text + "\n").find("anchors hold more than 100000 nodes"), std::string::npos);
  std::string aliases = "a: &a " + std::string(1'000'000, 'x') + "\nb: [*a";
  for (int i = 0; i < 10; ++i) aliases += ", *a";
  EXPECT_NE(message_of(aliases + "]\n").find("aliases add more than 10000000 bytes"), std::string::npos);
}

// Each byte is read a few times at most: a time in the square of the length would be minutes.
TEST(BadScenes, BlankLinesMayBeLong) {
  EXPECT_EQ(message_of(std::string(3'000'000, '\t') + "\n"), message_of(""));
}

TEST(BadScenes, MoreMaterialsThanTheirPairsAllow) {
  std::string text = "format: 1\ntime: {end: 1, step: 1}\nmaterials:\n";
  for (int i = 0; i < 1001; ++i) text += "  m" + std::to_string(i) + ": {}\n";
  EXPECT_EQ(message_of(text + "bodies:\n  - {sphere: {radius: 1}, material: m0}\n"),
            "test.yaml:4:3: materials: must be a map of at most 1000 names, not a map of 1001");
}

TEST(BadScenes, FilesThatAreNone) {
  const auto message = [](const std::filesystem::path& file) {
    try {
      read_scene(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message(folder / "absent.yaml"),
            (folder / "absent.yaml").string() + ": cannot be read: No such file or directory");
  EXPECT_EQ(message(folder), folder.string() + ": is a directory, not a scene file");
  EXPECT_EQ(message_of(""), "test.yaml:1:1: the file is empty; a scene begins with `format: 1`");
  EXPECT_EQ(message_of("# only a comment\n"), message_of(""));
}

// The refusal does not depend on the machine: 2e9 bodies with names of 10,000 letters need 2e13 bytes.
TEST(BadScenes, MoreBodiesThanMemoryAreRefusedBeforeAllocation) {
  const std::string message = message_of(
      "format: 1\ntime: {end: 1, step: 1}\nmaterials: {glass: {}}\nbodies:\n"
      "  - {sphere: {radius: 1}, material: glass, repeat: {count: [2000, 1000, 1000], spacing: [1, 1, 1]},"
      " name: " +
      std::string(10000, 'a') + "}\n");
  EXPECT_TRUE(
      begins_with(message, "test.yaml:5:52: bodies[0].repeat: a run of the scene's 2000000000 bodies needs "))
      << message;
  EXPECT_NE(message.find("iB of memory, but this machine has "), std::string::npos) << message;
}

TEST(BadScenes, MoreBodiesThanTheMemoryGivenAreRefused) {
  const std::string text =
      "format: 1\ntime: {end: 1, step: 1}\nmaterials: {glass: {}}\nbodies:\n"
      "  - {sphere: {radius: 1}, material: glass, repeat: {count: [9, 9, 9], spacing: [2, 2, 2]}}\n";
  EXPECT_EQ(parse_scene(text, "test.yaml", {}, 2e8).bodies.count(), 729);
  EXPECT_THROW(parse_scene(text, "test.yaml", {}, 1e8), InputError);
}

// A scene may hold any character in quotes, but its messages are read in terminals.
TEST(BadScenes, MessagesHoldNoControlCharacters) {
  const std::tuple<std::string, std::vector<Override>, std::string> cases[] = {
      {"\"\\e[2J\": 1\n", {}, "test.yaml:1:1: \\x1B[2J: unknown key (known"},
      {"format: \"1\\n\"\n", {}, "test.yaml:1:9: format: must be 1, not \"1\\x0A\"\n"},
      {"format: 1\n", {{"time.step", "[\x1b"}}, "--set time.step=[\\x1B: "},
  };
  for (const auto& [text, overrides, start] : cases)
    EXPECT_TRUE(begins_with(message_of(text, overrides), start)) << message_of(text, overrides);
}

// Any prefix of a scene, and any scene with one byte changed, must load or be refused, and do nothing else.
TEST(BadScenes, DamagedScenesLoadOrAreRefused) {
  const std::string text =
      "format: 1\nname: \"a\"\ntime: {end: 1, step: 0.5}\nmaterials: &m {glass: {friction: 0.5}}\n"
      "contacts: [{between: [glass, glass], friction: 1e-1}]\nbodies:\n"
      "  - {sphere: {radius: {uniform: [1, 2]}}, name: b, at: [0, 0, 1], material: glass}\n"
      "  - box: {size: 1}\n    scatter: {count: 3, from: [0, 0, 9], to: [9, 9, 19]}\n    material: glass\n"
      "model: {friction: off}\nchecks:\n- {measure: b.position.z, above: 0}\n";
  ASSERT_EQ(message_of(text), "no error");
  int refused = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    refused += message_of(text.substr(0, i)) != "no error";
    for (const char c : {'\0', '\t', '\n', ' ', '-', ':', '[', '}', '"', '&', '*', '9', 'x', '\x80'}) {
      std::string damaged = text;
      damaged[i] = c;
      refused += message_of(damaged) != "no error";
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace scree
