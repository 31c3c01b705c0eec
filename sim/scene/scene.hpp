// A scene, read and checked: plain data that the rest of sim works from. The language is described by the
// table in keys.cpp, of which the parser, its messages, the JSON Schema and docs/scene.md are made.
#pragma once

#include "broadphase/settings.hpp"
#include "core/bodies.hpp"
#include "core/geometry.hpp"
#include "narrowphase/settings.hpp"
#include "scree/options.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

struct Material {
  std::string name;
  double density = 1000;   ///< kg/m^3
  double restitution = 0;  ///< 0 to 1
  double friction = 0;     ///< Coulomb's coefficient
};

/// How a pair of materials meets.
struct ContactLaw {
  double restitution = 0;
  double friction = 0;
  double rolling_friction = 0;  ///< of a ball on a plane: tangent of the slope on which it starts to roll
};

/// Of impulses and of the velocities that they are found with; the state is in double.
enum class Precision { double_precision, mixed };

struct TimeSettings {
  double end = 0;   ///< s
  double step = 0;  ///< s; the last step is shorter if `end` is no multiple
  std::optional<int> substeps =
      {};  ///< contacts are found and solved so often per step; absent: as overlaps ask
};

/// To and fro: a share of sin(2 pi frequency t + phase) - sin(phase), so that it starts where the body is.
struct Oscillation {
  Vec3 displacement = Vec3::Zero();  ///< m
  Vec3 angle = Vec3::Zero();         ///< turn vector (rad)
  double frequency = 0;              ///< Hz
  double phase = 0;                  ///< rad

  double omega() const { return 2 * pi * frequency; }  ///< rad/s
};

/// Where a body is at one time.
struct MotionKey {
  double at = 0;                 ///< since the body has appeared (s)
  Vec3 position = Vec3::Zero();  ///< of the centre (m)
  std::optional<Quat> orientation = {};
};

/// Prescribed motion: constant spin about a point that moves along with constant velocity, both of which may
/// oscillate besides; or from one key to the next.
struct Motion {
  std::int32_t body = 0;
  Vec3 velocity = Vec3::Zero();    ///< m/s
  Vec3 spin = Vec3::Zero();        ///< rad/s
  std::optional<Vec3> about = {};  ///< the point, at the start (m); absent: the body's centre
  std::optional<Oscillation> oscillate = {};
  std::vector<MotionKey> keyframes = {};  ///< by ascending time, all with an orientation or none; instead
                                          ///< of all that
};

/// A free body that a guide lets move along one axis alone, and that is driven along it by a constant force.
struct Servo {
  std::int32_t body = 0;
  Vec3 axis = Vec3::UnitZ();  ///< unit
  double force = 0;           ///< along the axis, all that moves the body but for contacts (N)
};

struct GravityKey {
  double at = 0;               ///< s
  Vec3 vector = Vec3::Zero();  ///< m/s^2
};

/// How gravity changes with time: one of the two is given.
struct GravityTurn {
  std::optional<Vec3> spin = {};           ///< of the vector, from t = 0 on (rad/s)
  std::vector<GravityKey> keyframes = {};  ///< by ascending time; straight between, constant outside
};

/// Bodies first, first + 1, ...: those of one item of `bodies`, or one of them.
struct BodyRange {
  std::int32_t first = 0;
  std::int32_t count = 1;
};

/// from <= t < until (s), both taken at the step nearest to them; see TimeGrid::steps_in().
struct TimeSpan {
  double from = 0;
  double until = HUGE_VAL;
};

/// When bodies exist. Outside the span they are not there at all.
struct Lifetime {
  BodyRange bodies;
  TimeSpan span;
};

/// A constant force on the centre of each of the bodies, and a torque on each, in the world frame. The bodies
/// are free ones.
struct AppliedForce {
  BodyRange on;
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 torque = Vec3::Zero();  ///< N m
  TimeSpan during;
};

/// A named box to measure in, its faces along the world's axes; closed.
struct Region {
  std::string name;
  Vec3 from = Vec3::Zero();          ///< m
  Vec3 to = Vec3::Zero();            ///< m; greater in each component
  std::optional<bool> removes = {};  ///< free bodies whose centre comes into it are taken out
};

/// Free bodies that appear one after another, the n-th as soon after start + n / rate as there is room, with
/// their centres anywhere in a box.
struct Emitter {
  BodyRange bodies;          ///< in the order in which they appear
  Vec3 from = Vec3::Zero();  ///< corners of the box (m)
  Vec3 to = Vec3::Zero();
  double rate = 0;   ///< 1/s
  double start = 0;  ///< s
};

/// What becomes of a free body whose centre leaves the world.
enum class Leaving { stop, remove, ignore };

/// Where the scene expects its bodies to stay; closed, its faces along the world's axes.
struct World {
  Vec3 from = Vec3::Zero();  ///< m
  Vec3 to = Vec3::Zero();    ///< m; greater in each component
  Leaving leaving = Leaving::stop;
};

enum class ResponseMode { standard, accurate };  ///< standard: `default` in the scene language

struct ResponseSettings {
  ResponseMode mode = ResponseMode::standard;
  double quality = 1;               ///< by which overlaps and changes that are left are divided
  std::optional<int> iterations;    ///< most sweeps over the contacts per substep; absent: from their number
  std::optional<int> block_sweeps;  ///< sweeps over the points of a contact at each visit; absent: likewise
  std::optional<double> tolerance;  ///< share that sweeps change at which they stop; absent: by number
  bool warm_start = true;           ///< start from the last step's impulses
  std::optional<double> restitution_threshold;  ///< m/s; absent: from gravity, step and e
};

/// Features to compute; absent: only if the scene needs them.
struct ModelSettings {
  std::optional<bool> rotation;
  std::optional<bool> friction;
  std::optional<bool> rolling_friction;
  std::optional<bool> restitution;
  std::optional<bool> continuous;
};

enum class ColorBy { material, speed, size, kinetic_energy, force, level, id };
enum class Overlay { grid, pairs, forces };

/// A turn about the axis through the camera's `to` against gravity; one of the two is given.
struct OrbitSettings {
  std::optional<double> degrees;             ///< over the whole run
  std::optional<double> degrees_per_second;  ///< of simulated time
};

struct CameraKeySettings {
  double at = 0;             ///< s
  Vec3 from = Vec3::Zero();  ///< m
  Vec3 to = Vec3::Zero();    ///< m
  double fov = 40;           ///< vertical, degrees
};

struct CameraSettings {
  std::optional<Vec3> from;  ///< m; absent, together with `to`: chosen to see every body
  std::optional<Vec3> to;    ///< m
  double fov = 40;           ///< vertical, degrees
  std::optional<OrbitSettings> orbit;
  std::vector<CameraKeySettings> keyframes;  ///< instead of all that; by ascending time
};

struct RenderSettings {
  bool enabled = true;  ///< false if the scene has `render: false`
  int width = 1280;
  int height = 720;
  double fps = 30;                       ///< frames per simulated second
  std::optional<CameraSettings> camera;  ///< absent: chosen to see every body
  ColorBy color = ColorBy::material;
  std::optional<std::array<double, 2>>
      range;                       ///< of the colour scale, SI units; absent: guessed from the scene
  std::optional<bool> legend;      ///< absent: where there is room for it
  std::optional<bool> time_stamp;  ///< likewise
  std::vector<Overlay> overlay;
};

struct TrajectorySettings {
  std::optional<double> every = {};  ///< s; absent: a frame for each picture
  bool orientation = true;
  bool velocity = true;
  bool spin = false;
  bool in_double = false;             ///< real numbers in the file; else single
  std::optional<bool> contacts = {};  ///< and their forces, in a file of their own; absent: no
};

struct RecordSettings {
  double metrics_every = 0.01;                   ///< s
  std::optional<TrajectorySettings> trajectory;  ///< absent: none
  double checkpoint_every = 60;                  ///< of wall time (s)
};

/// Where in the scene file something stands, for messages; counted from 1.
struct SourceMark {
  int line = 0;
  int column = 0;
};

enum class Reduce { none, max, min, mean, drift, range, crossings };

/// One line of the scene's own acceptance test.
struct Check {
  std::string measure;
  std::optional<double> at;                   ///< s; absent and no `over`: at the end
  std::optional<std::array<double, 2>> over;  ///< s
  Reduce reduce = Reduce::none;
  double level = 0;  ///< of `crossings`
  std::optional<double> expect;
  std::optional<double> tolerance;  ///< absolute
  std::optional<double> relative;
  std::optional<double> below;
  std::optional<double> above;
  std::optional<double> in_default_mode;  ///< in place of the one of tolerance, relative, below, above given
  std::optional<double> confidence;       ///< of the mean over the seeds; absent: every seed by itself
  SourceMark mark;
};

/// A mesh: its triangles are bodies that follow one another.
struct MeshBodies {
  std::string name;  ///< of the entry; may be empty
  std::string file;
  BodyRange bodies;
  Vec3 place;  ///< of the origin of its file (m), when it appears
  MeshReport report;
};

struct Scene {
  std::string name;
  std::string label;             ///< `long` scenes are left out of verify unless asked
  std::filesystem::path source;  ///< the file it was read from
  std::uint64_t seed = 0;
  int seeds = 1;                ///< runs of the ensemble that the checks are judged by: seed, seed + 1, ...
  Vec3 gravity = Vec3::Zero();  ///< m/s^2; at t = 0, if it turns
  std::optional<GravityTurn> gravity_turn;
  TimeSettings time;
  std::vector<Material> materials;
  std::vector<ContactLaw> laws;              ///< materials x materials, symmetric; see law()
  BodyTable bodies;                          ///< at t = 0, or when they appear; id[k] = k
  std::shared_ptr<const Geometry> geometry;  ///< of bodies whose shape is general; null if there are none
  std::vector<Lifetime> lifetimes;           ///< of those that are not there all the time, by ascending body
  std::vector<Emitter> emitters;             ///< of those that appear when there is room, by ascending body
  std::map<std::string, std::int32_t> body_names;  ///< named bodies, name[k] of a repeat included
  std::vector<MeshBodies> meshes;                  ///< by ascending bodies
  std::vector<Motion> motions;                     ///< of the prescribed bodies, by ascending body
  std::vector<Servo> servos;                       ///< by ascending body
  std::optional<World> world;                      ///< absent: without end
  std::vector<Region> regions;
  std::vector<AppliedForce> forces;  ///< besides gravity
  ResponseSettings response;
  BroadPhaseSettings broadphase;
  NarrowPhaseSettings narrowphase;
  Precision precision = Precision::double_precision;
  ModelSettings model;
  RenderSettings render;
  RecordSettings record;
  std::vector<Check> checks;
  std::string resolved;            ///< the scene as YAML with every default written out
  std::vector<std::string> notes;  ///< what was left out on reading, and what was understood without a word

  const ContactLaw& law(std::int32_t a, std::int32_t b) const {
    return laws[static_cast<std::size_t>(a) * materials.size() + static_cast<std::size_t>(b)];
  }
};

/// Reads and checks a scene file. Throws InputError: file:line:column, the key, what is allowed, and the
/// nearest known key where one is close. Nothing is written.
Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides = {});

/// The same from text; `name` stands for the file in messages. `memory`: what a run of the scene may take
/// (bytes); absent: what this machine has.
Scene parse_scene(const std::string& text, const std::filesystem::path& name,
                  const std::vector<Override>& overrides = {}, std::optional<double> memory = {});

/// The JSON Schema (draft 2020-12) of the scene language, as text.
std::string scene_schema();

/// docs/scene.md, as text.
std::string scene_reference();

}  // namespace scree
