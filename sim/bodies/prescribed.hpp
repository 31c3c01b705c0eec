// Bodies that move as prescribed, whatever impulses act on them.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/math.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// A key of a path: a pose of a body, and the way from it to the next key. The way is a cubic (Hermite's)
/// along each axis, and three turns, one after another, by the cumulative Bernstein polynomials (Kim, Kim and
/// Shin 1995, "A general construction scheme for unit quaternion curves with simple high order derivatives").
struct PathKey {
  double at;  ///< time since the start of the path (s)
  Vec3 position;
  Vec3 velocity;  ///< m/s
  Quat orientation;
  /// Turns to the next key, in the order in which they are made (rad); 0 in the last key.
  Vec3 turns[3] = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

/// The pose of a body, and its velocities.
struct PathPoint {
  Vec3 position, velocity;
  Quat orientation;
  Vec3 spin;
};

/// Returns the point of a path at a time (s) between two keys.
SCREE_HD inline PathPoint point_between(const PathKey& from, const PathKey& to, double time) {
  const double h = to.at - from.at;
  const double u = (time - from.at) / h;
  const double v = 1 - u;
  const double weight = u * u * (3 - 2 * u);
  PathPoint point;
  point.position = from.position + weight * (to.position - from.position) +
                   (h * u * v) * (v * from.velocity - u * to.velocity);
  point.velocity = (6 * u * v / h) * (to.position - from.position) + (v * (1 - 3 * u)) * from.velocity +
                   (u * (3 * u - 2)) * to.velocity;
  const double share[3] = {1 - v * v * v, weight, u * u * u};
  const double rate[3] = {3 * v * v / h, 6 * u * v / h, 3 * u * u / h};
  point.orientation = from.orientation;
  point.spin.setZero();
  for (int k = 0; k < 3; ++k) {
    const Quat turn = rotation_of(share[k] * from.turns[k]);
    point.orientation = turn * point.orientation;
    point.spin = turn * point.spin + rate[k] * from.turns[k];
  }
  point.orientation.normalize();
  return point;
}

/// Returns the point at a time (s) of a path with `count` keys in the order of time. The body is at rest at
/// the first key before that key's time, and at the last key after that key's time.
SCREE_HD inline PathPoint point_at(const PathKey* keys, std::int32_t count, double time) {
  std::int32_t after = 0;
  for (std::int32_t end = count; after < end;) {
    const std::int32_t middle = (after + end) / 2;
    if (keys[middle].at <= time)
      after = middle + 1;
    else
      end = middle;
  }
  if (after > 0 && after < count) return point_between(keys[after - 1], keys[after], time);
  const PathKey& rest = keys[after == 0 ? 0 : count - 1];
  return {rest.position, Vec3::Zero(), rest.orientation, Vec3::Zero()};
}

/// The path of one prescribed body. Either the body turns with a pivot that moves along a line, and both may
/// oscillate besides; or it goes from key to key.
struct PrescribedPath {
  BodyNumber body;
  Vec3 pivot;                        ///< position of the pivot at the start (m)
  Vec3 arm;                          ///< vector from the pivot to the body's centre, at the start (m)
  Quat orientation;                  ///< orientation of the body at the start
  Vec3 velocity;                     ///< velocity of the pivot, without the oscillation (m/s)
  Vec3 spin;                         ///< spin of the body, without the oscillation (rad/s)
  double start;                      ///< start of the path (s); the body appears then if it was absent before
  Vec3 displacement = Vec3::Zero();  ///< amplitude of the pivot (m)
  Vec3 angle = Vec3::Zero();         ///< amplitude of the turn (rad)
  double omega = 0;                  ///< rad/s; 0: nothing oscillates
  double phase = 0;                  ///< rad
  std::int32_t first_key = 0;
  std::int32_t key_count = 0;

  /// Sets the pose and the velocities that the body has at a time (s), unless it is absent. The pose at the
  /// start is turned by the whole angle at once: no errors add up over the steps, so the radius stays.
  SCREE_HD void place(double time, ConstView<PathKey> keys, const BodyView& bodies) const {
    const std::int32_t k = bodies.place(body);
    if (bodies.mobility[k] != Mobility::prescribed) return;
    const PathPoint point = key_count > 0 ? point_at(keys.data() + first_key, key_count, time - start)
                                          : point_of_pivot(time - start);
    bodies.position[k] = point.position;
    bodies.orientation[k] = point.orientation;
    bodies.velocity[k] = point.velocity;
    bodies.spin[k] = point.spin;
  }

 private:
  SCREE_HD PathPoint point_of_pivot(double time) const {
    Vec3 moved = time * velocity;
    Vec3 turned = time * spin;
    Vec3 pivot_velocity = velocity;
    Vec3 body_spin = spin;
    if (omega > 0) {
      const double share = sin(omega * time + phase) - sin(phase);
      const double rate = omega * cos(omega * time + phase);
      moved += share * displacement;
      turned += share * angle;
      pivot_velocity += rate * displacement;
      body_spin += rate * angle;
    }
    const Quat turn = rotation_of(turned);
    const Vec3 now = turn * arm;
    return {pivot + moved + now, pivot_velocity + body_spin.cross(now), (turn * orientation).normalized(),
            body_spin};
  }
};

/// The paths of all prescribed bodies, and the keys to which they refer.
struct PathTable {
  std::vector<PrescribedPath> paths;
  std::vector<PathKey> keys;
};

/// Returns the paths of the scene's motions, in their order; all start at t = 0.
PathTable prescribed_paths(const Scene& scene);

/// Finds ResponseParameters::prescribed_acceleration of a scene (m/s^2).
double prescribed_acceleration(const Scene& scene);

/// A PathTable in a space.
template <class Space>
struct PrescribedPaths {
  Array<PrescribedPath, Space> paths;
  Array<PathKey, Space> keys;

  explicit PrescribedPaths(const PathTable& table) {
    copy(paths, table.paths);
    copy(keys, table.keys);
  }
};

/// Sets the pose and the velocities of every prescribed body at a time (s).
template <class Space>
void place_prescribed(const PrescribedPaths<Space>& paths, double time, Bodies<Space>& bodies);

}  // namespace scree
