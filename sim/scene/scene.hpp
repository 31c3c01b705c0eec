// A scene, read and checked: plain data from which the rest of sim works. The language is described by the
// table in keys.cpp, from which the parser, its messages, the JSON Schema and docs/scene.md are made.
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

/// The contact law of a pair of materials.
struct ContactLaw {
  double restitution = 0;
  double friction = 0;
  double rolling_friction = 0;  ///< tangent of the slope on which a ball starts to roll
};

/// The precision of impulses and of the velocities with which they are found; the state of bodies is in
/// double.
enum class Precision { double_precision, mixed };

struct TimeSettings {
  double end = 0;                    ///< s
  double step = 0;                   ///< s; the last step is shorter if `end` is no multiple
  std::optional<int> substeps = {};  ///< number of substeps per step; absent: chosen from overlaps
};

/// An oscillation: displacement and angle are multiplied by sin(2 pi frequency t + phase) - sin(phase), so
/// that it starts where the body is.
struct Oscillation {
  Vec3 displacement = Vec3::Zero();  ///< amplitude (m)
  Vec3 angle = Vec3::Zero();         ///< amplitude of the turn, a vector along its axis (rad)
  double frequency = 0;              ///< Hz
  double phase = 0;                  ///< rad

  double omega() const { return 2 * pi * frequency; }  ///< angular frequency (rad/s)
};

/// Position and orientation of a body at one time.
struct MotionKey {
  double at = 0;                 ///< time since the body appeared (s)
  Vec3 position = Vec3::Zero();  ///< position of the centre (m)
  std::optional<Quat> orientation = {};
};

/// Prescribed motion. Either the body spins constantly about a point that moves with constant velocity, and
/// both may oscillate besides; or the body moves from one keyframe to the next.
struct Motion {
  std::int32_t body = 0;
  Vec3 velocity = Vec3::Zero();    ///< m/s
  Vec3 spin = Vec3::Zero();        ///< rad/s
  std::optional<Vec3> about = {};  ///< point to turn about, at the start (m); absent: the body's centre
  std::optional<Oscillation> oscillate = {};
  std::vector<MotionKey> keyframes = {};  ///< in order of time, all with an orientation or none
};

/// A free body that a guide restricts to one axis, and that a constant force drives along this axis.
struct Servo {
  std::int32_t body = 0;
  Vec3 axis = Vec3::UnitZ();  ///< unit vector
  double force = 0;           ///< force along the axis, the only one besides those of contacts (N)
};

struct GravityKey {
  double at = 0;               ///< s
  Vec3 vector = Vec3::Zero();  ///< m/s^2
};

/// The change of gravity with time. One of the two members is given.
struct GravityTurn {
  std::optional<Vec3> spin = {};           ///< angular velocity of the vector, from t = 0 on (rad/s)
  std::vector<GravityKey> keyframes = {};  ///< in order of time; linear between them, constant outside
};

/// A range of bodies first, first + 1, ...: all bodies of one item of `bodies`, or one of them.
struct BodyRange {
  std::int32_t first = 0;
  std::int32_t count = 1;
};

/// The times from <= t < until (s), both taken at the step nearest to them; see TimeGrid::steps_in().
struct TimeSpan {
  double from = 0;
  double until = HUGE_VAL;
};

/// The time span in which bodies exist. Outside it they are not in the simulation at all.
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

/// A named closed box to measure in, its faces along the world's axes.
struct Region {
  std::string name;
  Vec3 from = Vec3::Zero();          ///< m
  Vec3 to = Vec3::Zero();            ///< m; greater than `from` in each component
  std::optional<bool> removes = {};  ///< true: free bodies are removed when their centre is in the box
};

/// Free bodies that appear one after another with their centres anywhere in a box. The n-th appears as soon
/// after start + n / rate as there is room.
struct Emitter {
  BodyRange bodies;          ///< in the order in which they appear
  Vec3 from = Vec3::Zero();  ///< corners of the box (m)
  Vec3 to = Vec3::Zero();
  double rate = 0;   ///< 1/s
  double start = 0;  ///< s
};

/// The treatment of a free body whose centre leaves the world.
enum class Leaving { stop, remove, ignore };

/// The closed box in which the scene expects its bodies to stay, its faces along the world's axes.
struct World {
  Vec3 from = Vec3::Zero();  ///< m
  Vec3 to = Vec3::Zero();    ///< m; greater than `from` in each component
  Leaving leaving = Leaving::stop;
};

enum class ResponseMode { standard, accurate };  ///< standard: `default` in the scene language

struct ResponseSettings {
  ResponseMode mode = ResponseMode::standard;
  double quality = 1;               ///< divisor of the overlaps and of the impulse changes that may be left
  std::optional<int> iterations;    ///< most sweeps per substep; absent: from the number of contacts
  std::optional<int> block_sweeps;  ///< sweeps over a manifold per visit; absent: from the number of contacts
  std::optional<double> tolerance;  ///< relative change that ends sweeps; absent: from the number of contacts
  bool warm_start = true;           ///< start from the last step's impulses
  std::optional<double> restitution_threshold;  ///< least bouncing speed (m/s); absent: from gravity, step, e
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

/// A turn of the camera about the axis through its `to` against gravity. One of the two members is given.
struct OrbitSettings {
  std::optional<double> degrees;             ///< angle over the whole run (degrees)
  std::optional<double> degrees_per_second;  ///< angular speed (degrees per second of simulated time)
};

struct CameraKeySettings {
  double at = 0;             ///< s
  Vec3 from = Vec3::Zero();  ///< m
  Vec3 to = Vec3::Zero();    ///< m
  double fov = 40;           ///< vertical field of view (degrees)
};

struct CameraSettings {
  std::optional<Vec3> from;  ///< position (m); absent, together with `to`: chosen to see every body
  std::optional<Vec3> to;    ///< m
  double fov = 40;           ///< vertical field of view (degrees)
  std::optional<OrbitSettings> orbit;
  std::vector<CameraKeySettings> keyframes;  ///< in order of time; they replace the members above
};

struct RenderSettings {
  bool enabled = true;  ///< false if the scene has `render: false`
  int width = 1280;
  int height = 720;
  double fps = 30;                       ///< frames per simulated second
  std::optional<CameraSettings> camera;  ///< absent: chosen to see every body
  ColorBy color = ColorBy::material;
  std::optional<std::array<double, 2>> range;  ///< ends of the colour scale (SI units); absent: guessed
  std::optional<bool> legend;                  ///< absent: where there is room for it
  std::optional<bool> time_stamp;              ///< absent: where there is room for it
  std::vector<Overlay> overlay;
};

struct TrajectorySettings {
  std::optional<double> every = {};  ///< time between frames (s); absent: a frame for each picture
  bool orientation = true;
  bool velocity = true;
  bool spin = false;
  bool in_double = false;             ///< true: real numbers in the file are double, else single
  std::optional<bool> contacts = {};  ///< contacts and their forces, in a file of their own; absent: no
};

struct RecordSettings {
  double metrics_every = 0.01;                   ///< s
  std::optional<TrajectorySettings> trajectory;  ///< absent: no trajectory is written
  double checkpoint_every = 60;                  ///< wall time between checkpoints (s)
};

/// A line and column of the scene file, for messages; both are counted from 1.
struct SourceMark {
  int line = 0;
  int column = 0;
};

enum class Reduce { none, max, min, mean, drift, range, crossings };

/// One line of the scene's own acceptance test.
struct Check {
  std::string measure;
  std::optional<double> at;                   ///< time (s); absent without `over`: the end of the run
  std::optional<std::array<double, 2>> over;  ///< s
  Reduce reduce = Reduce::none;
  double level = 0;  ///< the level that Reduce::crossings counts
  std::optional<double> expect;
  std::optional<double> tolerance;  ///< absolute tolerance
  std::optional<double> relative;
  std::optional<double> below;
  std::optional<double> above;
  std::optional<double> in_default_mode;  ///< in the default mode replaces the one of tolerance, relative,
                                          ///< below, above that is given
  std::optional<double> confidence;       ///< probability of the interval of the mean over the seeds; absent:
                                          ///< every seed is judged by itself
  SourceMark mark;
};

/// A mesh, whose triangles are bodies that follow one another.
struct MeshBodies {
  std::string name;  ///< name of the entry; may be empty
  std::string file;
  BodyRange bodies;
  Vec3 place;  ///< position of the origin of the mesh's file (m), when the mesh appears
  MeshReport report;
};

struct Scene {
  std::string name;
  std::string label;             ///< `long` scenes are left out of verify unless asked
  std::filesystem::path source;  ///< the file from which the scene was read
  std::uint64_t seed = 0;
  int seeds = 1;                ///< number of runs by which the checks are judged: seed, seed + 1, ...
  Vec3 gravity = Vec3::Zero();  ///< m/s^2; at t = 0, if it changes
  std::optional<GravityTurn> gravity_turn;
  TimeSettings time;
  std::vector<Material> materials;
  std::vector<ContactLaw> laws;              ///< materials x materials, symmetric; see law()
  BodyTable bodies;                          ///< state at t = 0, or when the bodies appear; id[k] = k
  std::shared_ptr<const Geometry> geometry;  ///< geometry of general shapes; null if there are none
  std::vector<Lifetime> lifetimes;  ///< lifetimes of bodies that do not exist all the time, by ascending body
  std::vector<Emitter> emitters;    ///< emitters of bodies that appear when there is room, by ascending body
  std::map<std::string, std::int32_t> body_names;  ///< named bodies, name[k] of a repeat included
  std::vector<MeshBodies> meshes;                  ///< in the order of their bodies
  std::vector<Motion> motions;                     ///< motions of the prescribed bodies, by ascending body
  std::vector<Servo> servos;                       ///< by ascending body
  std::optional<World> world;                      ///< absent: without bounds
  std::vector<Region> regions;
  std::vector<AppliedForce> forces;  ///< forces besides gravity
  ResponseSettings response;
  BroadPhaseSettings broadphase;
  NarrowPhaseSettings narrowphase;
  Precision precision = Precision::double_precision;
  ModelSettings model;
  RenderSettings render;
  RecordSettings record;
  std::vector<Check> checks;
  std::string resolved;            ///< the scene as YAML with every default written out
  std::vector<std::string> notes;  ///< sentences about what was left out on reading, and what was assumed

  const ContactLaw& law(std::int32_t a, std::int32_t b) const {
    return laws[static_cast<std::size_t>(a) * materials.size() + static_cast<std::size_t>(b)];
  }
};

/// Reads and checks a scene file. Throws InputError with file:line:column, the key, what is allowed, and the
/// nearest known key if one is near. Writes nothing.
Scene read_scene(const std::filesystem::path& file, const std::vector<Override>& overrides = {});

/// Parses and checks the text of a scene, as read_scene() does. `name` is the name of the file in messages.
/// `memory`: the memory that a run of the scene may take (bytes); absent: that of this machine.
Scene parse_scene(const std::string& text, const std::filesystem::path& name,
                  const std::vector<Override>& overrides = {}, std::optional<double> memory = {});

/// Returns the JSON Schema (draft 2020-12) of the scene language as text.
std::string scene_schema();

/// Returns the text of docs/scene.md.
std::string scene_reference();

}  // namespace scree
