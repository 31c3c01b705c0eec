// Bodies that move as prescribed, whatever hits them.
#pragma once

#include "core/array.hpp"
#include "core/bodies.hpp"
#include "core/math.hpp"
#include "sim/scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace scree {

/// The way of one prescribed body: it turns with a pivot that moves along a line.
struct PrescribedPath {
  std::int32_t body;
  Vec3 pivot;        ///< at the start (m)
  Vec3 arm;          ///< from the pivot to the body's centre, at the start (m)
  Quat orientation;  ///< at the start
  Vec3 velocity;     ///< of the pivot (m/s)
  Vec3 spin;         ///< rad/s
  double start;      ///< s; the body appears then if it was not there before

  /// Puts the body, if it is there, where it is at a time (s), with the velocity that it has there. The turn
  /// is that of the start's pose, whole: nothing adds up over the steps, so the radius stays.
  SCREE_HD void place(double time, const BodyView& bodies) const {
    if (bodies.mobility[body] != Mobility::prescribed) return;
    const Quat turn = rotation_of((time - start) * spin);
    const Vec3 now = turn * arm;
    bodies.position[body] = pivot + (time - start) * velocity + now;
    bodies.orientation[body] = (turn * orientation).normalized();
    bodies.velocity[body] = velocity + spin.cross(now);
    bodies.spin[body] = spin;
  }
};

/// Of the scene's motions, in their order; all start at 0.
std::vector<PrescribedPath> prescribed_paths(const Scene& scene);

/// Places every prescribed body for a time (s).
template <class Space>
void place_prescribed(const Array<PrescribedPath, Space>& paths, double time, Bodies<Space>& bodies);

}  // namespace scree
