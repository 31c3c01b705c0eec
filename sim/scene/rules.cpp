// Rules that involve several keys of one section.
#include "sim/scene/rules.hpp"

#include "core/tolerances.hpp"
#include "sim/scene/particle_kinds.hpp"
#include "sim/scene/unit_quaternion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace scree {
namespace {

/// Fails if both keys are given, because they mean the same or contradict each other.
void exclude(const char* first, const char* second, const Node& node, Reader& reader) {
  const Node* item = node.find(second);
  if (!node.find(first) || !item) return;
  const Reader::Step step(reader, second);
  reader.fail(item->key_mark, fmt::format("cannot stand together with {}", first));
}

bool is_direction(const Vec3& v) {
  const double length = v.stableNorm();
  return length > 0 && std::isfinite(length);
}

/// Returns how many of the keys are given.
int given(std::initializer_list<const char*> keys, const Node& node) {
  int count = 0;
  for (const char* key : keys) count += node.find(key) != nullptr;
  return count;
}

void check_file_body(const BodyEntry& body, const Node& node, Reader& reader) {
  static constexpr std::array allowed = {"file",     "shape", "frame", "name",
                                         "material", "fixed", "from",  "until"};
  for (const Node& item : node.items) {
    const auto is_it = [&](const char* key) { return item.key == key; };
    if (std::ranges::any_of(allowed, is_it) || std::ranges::any_of(shape_words, is_it)) continue;
    const Reader::Step step(reader, item.key);
    reader.fail(item.key_mark, "does not go with a file, which says where its bodies are and how they move");
  }
  for (std::size_t k = 0; k < shape_words.size(); ++k) {
    exclude("shape", shape_words[k], node, reader);
    for (std::size_t l = 0; l < k; ++l) exclude(shape_words[l], shape_words[k], node, reader);
  }
  if (body.file.empty())
    reader.fail_at("file", node, "must be the path of a file of bodies or of a run's folder");
}

/// Fails if one of the keys is given. `why`: the message.
void refuse(std::initializer_list<const char*> keys, const char* why, const Node& node, Reader& reader) {
  for (const char* key : keys)
    if (const Node* item = node.find(key)) {
      const Reader::Step step(reader, key);
      reader.fail(item->key_mark, why);
    }
}

void check_plane_body(const Node& node, Reader& reader) {
  refuse({"mass", "at", "orientation", "rotate", "velocity", "spin", "fixed", "motion", "repeat", "scatter",
          "emit", "servo"},
         "does not go with a plane, which is fixed where its normal and offset say", node, reader);
}

void check_tube_body(const BodyEntry& body, const Node& node, Reader& reader) {
  refuse({"mass", "velocity", "spin", "scatter", "emit", "servo"},
         "does not go with a tube, which never moves freely", node, reader);
  if (!body.fixed.value_or(false) && !body.motion)
    reader.fail_at("tube", node, "never moves freely: give `fixed: true` or `motion`");
}

/// Fails unless the keyframes are in order of time.
template <class Key>
void require_order(const std::vector<Key>& keyframes, const Node& node, Reader& reader) {
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    const double before = keyframes[k - 1].at, at = keyframes[k].at;
    if (at <= before)
      reader.fail_at("keyframes", node,
                     fmt::format("must be in order of time, but {} s follows {} s", at, before));
  }
}

void check_orientation(const std::optional<std::array<double, 4>>& q, const Node& node, Reader& reader) {
  if (q && !unit_quaternion((*q)[0], Vec3((*q)[1], (*q)[2], (*q)[3])))
    reader.fail_at("orientation", node, "must not be zero");
}

/// Refuses the keys that keyframes replace: those of the position, and those of the orientation if the
/// keyframes have orientations.
void check_keyframed_body(const MotionEntry& motion, const Node& node, Reader& reader) {
  refuse({"at", "repeat", "scatter"}, "does not go with motion.keyframes, which say where the body is", node,
         reader);
  const MotionKeyEntry& first = motion.keyframes.front();
  if (first.orientation || first.rotate)
    refuse({"orientation", "rotate"}, "does not go with motion.keyframes that have orientations", node,
           reader);
}

void check_servo_body(const BodyEntry& body, const Node& node, Reader& reader) {
  if (!body.box) reader.fail_at("servo", node, "goes with a box alone");
  for (const char* other : {"fixed", "motion", "velocity", "spin", "scatter", "emit"})
    if (other != std::string_view("fixed") || body.fixed.value_or(false))
      exclude("servo", other, node, reader);
}

void check_mesh_body(const BodyEntry& body, const Node& node, Reader& reader) {
  refuse({"mass", "velocity", "spin", "repeat", "scatter", "emit"},
         "does not go with a mesh, which is there once and never moves freely", node, reader);
  if (!body.fixed.value_or(false) && !body.motion)
    reader.fail_at("mesh", node, "never moves freely: give `fixed: true` or `motion`");
  if (body.motion && !body.motion->keyframes.empty())
    reader.fail_at("motion", node,
                   "of a mesh has no keyframes: they say where one body is, and a mesh is many");
}

/// Fails unless the keys `from` and `to` are the lower and the upper corner of a box.
void check_corners(const Vec3& from, const Vec3& to, const Node& node, Reader& reader) {
  for (int k = 0; k < 3; ++k)
    if (!(from[k] < to[k]))
      reader.fail_at(
          "to", node,
          fmt::format("must be greater than `from` in each component, but {} <= {}", to[k], from[k]));
}

}  // namespace

void check_time(const TimeSettings& time, const Node& node, Reader& reader) {
  if (time.step > time.end)
    reader.fail_at("step", node, fmt::format("must be at most the end, {} s, not {} s", time.end, time.step));
  // Up to this number of steps, step numbers are exact in doubles and in 64-bit integers.
  if (time.end / time.step > 0x1p53)
    reader.fail_at("step", node, "is so short that the run would have more than 2^53 steps");
}

void check_plane(const PlaneEntry& plane, const Node& node, Reader& reader) {
  if (!is_direction(plane.normal)) reader.fail_at("normal", node, "must not be zero");
}

void check_mesh(const MeshEntry& mesh, const Node& node, Reader& reader) {
  if ((mesh.scale.array() == 0).any())
    reader.fail_at("scale", node, "must not be 0: nothing would be left of the mesh");
}

void check_polyhedron(const PolyhedronEntry&, const Node& node, Reader& reader) {
  exclude("points", "file", node, reader);
  if (given({"points", "file"}, node) == 0) reader.fail(node.mark, "needs points or file");
}

void check_rotation(const RotationEntry& rotation, const Node& node, Reader& reader) {
  if (!is_direction(rotation.axis)) reader.fail_at("axis", node, "must not be zero");
  exclude("degrees", "radians", node, reader);
  if (given({"degrees", "radians"}, node) == 0) reader.fail(node.mark, "needs degrees or radians");
}

void check_oscillation(const Oscillation& oscillation, const Node& node, Reader& reader) {
  if (oscillation.displacement.isZero(0) && oscillation.angle.isZero(0))
    reader.fail(node.mark, "needs a displacement or an angle that is not zero");
}

void check_motion_key(const MotionKeyEntry& key, const Node& node, Reader& reader) {
  exclude("orientation", "rotate", node, reader);
  check_orientation(key.orientation, node, reader);
}

void check_motion(const MotionEntry& motion, const Node& node, Reader& reader) {
  for (const char* other : {"velocity", "spin", "about", "oscillate"})
    exclude("keyframes", other, node, reader);
  require_order(motion.keyframes, node, reader);
  const auto turns = [](const MotionKeyEntry& key) { return key.orientation || key.rotate; };
  if (std::ranges::any_of(motion.keyframes, turns) && !std::ranges::all_of(motion.keyframes, turns))
    reader.fail_at("keyframes", node, "must all have an orientation, or none");
  const Vec3 swing = motion.oscillate ? motion.oscillate->angle : Vec3(Vec3::Zero());
  if (motion.about && motion.spin.isZero(0) && swing.isZero(0))
    reader.fail_at("about", node, "needs a spin or oscillate.angle that is not zero");
  if (swing.cross(motion.spin).norm() > tolerance::same_direction * swing.norm() * motion.spin.norm())
    reader.fail_at("oscillate", node, "must have its angle parallel to the spin");
}

void check_servo(const ServoEntry& servo, const Node& node, Reader& reader) {
  if (!is_direction(servo.axis)) reader.fail_at("axis", node, "must not be zero");
}

void check_gravity(const GravityEntry& gravity, const Node& node, Reader& reader) {
  exclude("keyframes", "vector", node, reader);
  exclude("keyframes", "spin", node, reader);
  require_order(gravity.keyframes, node, reader);
  if (gravity.keyframes.empty() && given({"vector", "spin"}, node) != 2)
    reader.fail(node.mark, "needs vector and spin, or keyframes");
}

void check_scatter(const ScatterEntry& scatter, const Node& node, Reader& reader) {
  for (int k = 0; k < 3; ++k)
    if (scatter.from[k] > scatter.to[k])
      reader.fail_at("to", node,
                     fmt::format("must be at least `from` in each component, but {} < {}", scatter.to[k],
                                 scatter.from[k]));
  if (!(scatter.to - scatter.from).allFinite())
    reader.fail_at("to", node, "is so far from `from` that numbers cannot hold the distance");
}

void check_emit(const EmitEntry& emit, const Node& node, Reader& reader) {
  check_scatter(emit, node, reader);
}

void check_body(const BodyEntry& body, const Node& node, Reader& reader) {
  if (node.find("file")) return check_file_body(body, node, reader);
  refuse({"shape"}, "goes with `file`; else the shape is a key of its own, as in `sphere: {radius: 0.1}`",
         node, reader);
  refuse({"frame"}, "goes with `file`", node, reader);
  const int shapes =
      given({"plane", "sphere", "box", "tube", "capsule", "cylinder", "polyhedron", "mesh"}, node);
  if (shapes != 1)
    reader.fail(node.mark,
                fmt::format("must have exactly one shape (plane, sphere, box, tube, capsule, cylinder, "
                            "polyhedron or mesh), not {}",
                            shapes == 0 ? "none" : std::to_string(shapes)));
  if (body.material.empty()) reader.fail_at("material", node, "is missing; it must be one of `materials`");
  if (body.plane) return check_plane_body(node, reader);
  if (body.tube) check_tube_body(body, node, reader);
  if (body.mesh) check_mesh_body(body, node, reader);
  exclude("orientation", "rotate", node, reader);
  exclude("motion", "velocity", node, reader);
  exclude("motion", "spin", node, reader);
  exclude("repeat", "scatter", node, reader);
  exclude("at", "scatter", node, reader);
  for (const char* key : {"at", "repeat", "scatter", "motion", "until"}) exclude(key, "emit", node, reader);
  if (body.fixed.value_or(false)) exclude("fixed", "emit", node, reader);
  if (body.fixed.value_or(false))
    for (const char* key : {"motion", "velocity", "spin"}) exclude("fixed", key, node, reader);
  check_orientation(body.orientation, node, reader);
  if (body.motion && !body.motion->keyframes.empty()) check_keyframed_body(*body.motion, node, reader);
  if (body.servo) check_servo_body(body, node, reader);
}

void check_force(const ForceEntry&, const Node& node, Reader& reader) {
  if (given({"force", "torque"}, node) == 0) reader.fail(node.mark, "needs force or torque");
}

void check_region(const Region& region, const Node& node, Reader& reader) {
  check_corners(region.from, region.to, node, reader);
}

void check_world(const World& world, const Node& node, Reader& reader) {
  check_corners(world.from, world.to, node, reader);
}

void check_orbit(const OrbitSettings&, const Node& node, Reader& reader) {
  exclude("degrees", "degrees_per_second", node, reader);
  if (given({"degrees", "degrees_per_second"}, node) == 0)
    reader.fail(node.mark, "needs degrees or degrees_per_second");
}

void check_keyframe(const CameraKeySettings& key, const Node& node, Reader& reader) {
  if (key.from == key.to) reader.fail(node.mark, "`from` and `to` must not be the same point");
}

void check_camera(const CameraSettings& camera, const Node& node, Reader& reader) {
  for (const char* other : {"from", "to", "fov", "orbit"}) exclude("keyframes", other, node, reader);
  if (camera.from.has_value() != camera.to.has_value())
    reader.fail(node.mark, "`from` and `to` must be given together, or neither");
  if (camera.from && *camera.from == *camera.to)
    reader.fail(node.mark, "`from` and `to` must not be the same point");
  require_order(camera.keyframes, node, reader);
}

void check_render(const RenderSettings& render, const Node& node, Reader& reader) {
  if (!render.range) return;
  if ((*render.range)[0] >= (*render.range)[1])
    reader.fail_at("range", node, "must be [low, high] with low < high");
  if (render.color == ColorBy::material || render.color == ColorBy::level || render.color == ColorBy::id)
    reader.fail_at("range", node, "needs a color that is a number: speed, size, kinetic_energy or force");
}

namespace {

void check_bounds(const CheckEntry& check, const Node& node, Reader& reader) {
  exclude("tolerance", "relative", node, reader);
  if (given({"expect", "below", "above"}, node) == 0)
    reader.fail(node.mark, "expects nothing; it needs expect, below or above");
  if (check.expect && !check.tolerance && !check.relative)
    reader.fail_at("expect", node, "needs tolerance or relative");
  for (const char* key : {"tolerance", "relative"})
    if (!check.expect && node.find(key)) reader.fail_at(key, node, "needs expect");
  if (check.in_default_mode && given({"tolerance", "relative", "below", "above"}, node) != 1)
    reader.fail_at("in_default_mode", node, "needs exactly one of tolerance, relative, below, above");
  if ((check.tolerance || check.relative) && check.in_default_mode.value_or(0) < 0)
    reader.fail_at("in_default_mode", node, "must be >= 0 in place of tolerance or relative");
  if (check.confidence && (*check.confidence <= 0 || *check.confidence >= 1))
    reader.fail_at("confidence", node, "must be between 0 and 1, neither of them");
}

void check_reduction(const CheckEntry& check, const Node& node, Reader& reader) {
  exclude("at", "over", node, reader);
  if (check.over && check.reduce == Reduce::none) reader.fail_at("over", node, "needs reduce");
  if (!check.over && check.reduce != Reduce::none) reader.fail_at("reduce", node, "needs over");
  if (check.over && (*check.over)[0] > (*check.over)[1])
    reader.fail_at("over", node, "must be [start, end] with start <= end");
  if (node.find("level") && check.reduce != Reduce::crossings)
    reader.fail_at("level", node, "needs reduce: crossings");
}

}  // namespace

void check_check(const CheckEntry& check, const Node& node, Reader& reader) {
  check_bounds(check, node, reader);
  check_reduction(check, node, reader);
}

template <class T>
void check_distribution(const Distribution<T>& sizes, const Node& node, Reader& reader) {
  if (given({"uniform", "powerlaw", "choose"}, node) != 1)
    reader.fail(node.mark, "must have exactly one of uniform, powerlaw, choose");
  if (sizes.uniform) {
    const auto& [low, high] = *sizes.uniform;
    bool ordered;
    if constexpr (std::is_same_v<T, double>) {
      ordered = low <= high;
    } else {
      ordered = (low.array() <= high.array()).all();
    }
    if (!ordered) reader.fail_at("uniform", node, "must be [low, high] with low <= high");
  }
  if (sizes.powerlaw) {
    const auto& [low, high, exponent] = *sizes.powerlaw;
    if (!(low > 0 && low <= high))
      reader.fail_at("powerlaw", node, "must be [min, max, exponent] with 0 < min <= max");
  }
}

void check_precision(const SceneEntry& scene, const Node& node, Reader& reader) {
  if (scene.precision == Precision::mixed && scene.response.mode == ResponseMode::accurate)
    reader.fail_at("precision", node, "cannot be mixed in the accurate mode, whose tolerance is beyond it");
  const bool servo =
      std::ranges::any_of(scene.bodies, [](const BodyEntry& body) { return body.servo.has_value(); });
  if (scene.precision == Precision::mixed && servo)
    reader.fail_at("precision", node, "cannot be mixed where a body is a servo");
}

template void check_distribution(const Distribution<double>&, const Node&, Reader&);
template void check_distribution(const Distribution<Vec3>&, const Node&, Reader&);

TimeSpan time_span(double from, const std::optional<double>& until, const TimeGrid& grid, const Node& node,
                   Reader& reader) {
  const TimeSpan span{from, until.value_or(HUGE_VAL)};
  const double end = grid.time(grid.last());
  if (from >= end)
    reader.fail_at("from", node, fmt::format("must be before the end, {} s, not {} s", end, from));
  const TimeGrid::Steps steps = grid.steps_in(span);
  if (steps.first >= steps.end)
    reader.fail_at("until", node,
                   fmt::format("must be at least a step after from, {} s, not {} s", from, span.until));
  return span;
}

}  // namespace scree
