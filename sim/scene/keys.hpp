// A scene as it is written, key for key, and the table that binds the keys to these structures.
#pragma once

#include "sim/scene/codec.hpp"
#include "sim/scene/distribution.hpp"
#include "sim/scene/scene.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace scree {

struct MaterialEntry : Material {
  std::optional<double> rolling_friction;
  const Node* node = nullptr;
};

struct ContactEntry {
  std::array<std::string, 2> between;
  std::optional<double> restitution;
  std::optional<double> friction;
  std::optional<double> rolling_friction;
  const Node* node = nullptr;
};

struct PlaneEntry {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0;
};

struct SphereEntry {
  Distribution<double> radius;
};

struct BoxEntry {
  Distribution<Vec3> size;  ///< full edge lengths
};

struct TubeEntry {
  double radius = 0;
  double length = 0;
};

struct CapsuleEntry {
  double radius = 0;
  double length = 0;  ///< length of the segment on the axis, without the round ends
};

struct CylinderEntry {
  double radius = 0;
  double length = 0;
};

struct PolyhedronEntry {
  std::optional<std::vector<Vec3>> points;
  std::string file;
  double scale = 1;
};

struct MeshEntry {
  std::string file;
  Vec3 scale = Vec3::Ones();
  Weld weld;
};

struct RotationEntry {
  Vec3 axis = Vec3::UnitZ();
  std::optional<double> degrees;
  std::optional<double> radians;
};

struct MotionKeyEntry {
  double at = 0;
  Vec3 position = Vec3::Zero();
  std::optional<std::array<double, 4>> orientation;
  std::optional<RotationEntry> rotate;
};

struct MotionEntry {
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();
  std::optional<Vec3> about;
  std::optional<Oscillation> oscillate;
  std::vector<MotionKeyEntry> keyframes;
};

struct ServoEntry {
  Vec3 axis = Vec3::UnitZ();
  double force = 0;
};

struct GravityEntry : GravityTurn {
  Vec3 vector = Vec3::Zero();
};

struct RepeatEntry {
  std::array<std::int64_t, 3> count{1, 1, 1};
  Vec3 spacing = Vec3::Zero();
  double jitter = 0;
};

struct ScatterEntry {
  std::int64_t count = 0;
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
};

struct EmitEntry : ScatterEntry {
  double rate = 0;
};

/// One item of `bodies`. It stands for many bodies if it repeats, scatters or emits, or if it has a file or a
/// mesh. A key that does not apply to the item (the velocity of a plane, say) must be absent.
struct BodyEntry {
  std::optional<PlaneEntry> plane;
  std::optional<SphereEntry> sphere;
  std::optional<BoxEntry> box;
  std::optional<TubeEntry> tube;
  std::optional<CapsuleEntry> capsule;
  std::optional<CylinderEntry> cylinder;
  std::optional<PolyhedronEntry> polyhedron;
  std::optional<MeshEntry> mesh;
  std::string file;
  std::optional<Shape> shape;         ///< shape of a file's bodies
  std::optional<std::int64_t> frame;  ///< number of the frame in a file
  std::string name;
  std::string material;
  std::optional<double> mass;
  std::optional<Vec3> at;
  std::optional<std::array<double, 4>> orientation;
  std::optional<RotationEntry> rotate;
  std::optional<Vec3> velocity;
  std::optional<Vec3> spin;
  std::optional<bool> fixed;
  std::optional<MotionEntry> motion;
  std::optional<ServoEntry> servo;
  std::optional<RepeatEntry> repeat;
  std::optional<ScatterEntry> scatter;
  std::optional<EmitEntry> emit;
  std::optional<double> from;
  std::optional<double> until;
  const Node* node = nullptr;
};

struct ForceEntry {
  std::string on;
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  double from = 0;
  std::optional<double> until;
  const Node* node = nullptr;
};

struct CheckEntry : Check {
  const Node* node = nullptr;
};

/// The ends of the cell of a periodic space along each periodic axis (m).
struct PeriodicEntry {
  std::optional<std::array<double, 2>> x, y, z;
  const Node* node = nullptr;

  const std::optional<std::array<double, 2>>& ends(int axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
};

struct SceneEntry {
  int format = 1;
  std::string name;
  std::string label;
  std::uint64_t seed = 0;
  int seeds = 1;
  GravityEntry gravity;
  TimeSettings time;
  std::vector<MaterialEntry> materials;
  std::vector<ContactEntry> contacts;
  std::vector<BodyEntry> bodies;
  std::vector<ForceEntry> forces;
  std::optional<PeriodicEntry> periodic;
  std::optional<World> world;
  std::vector<Region> regions;
  ResponseSettings response;
  BroadPhaseSettings broadphase;
  NarrowPhaseSettings narrowphase;
  Precision precision = Precision::double_precision;
  ModelSettings model;
  RenderSettings render;
  RecordSettings record;
  std::vector<CheckEntry> checks;
};

/// Returns the table of keys: every key of the scene language.
const Codec<SceneEntry>& scene_codec();

}  // namespace scree
