// The camera of a picture: its place, its direction, and the choice of a camera that shows a whole scene.
#pragma once

#include "core/math.hpp"
#include "core/snapshot.hpp"

namespace scree::render {

struct Camera {
  Vec3 from = Vec3(3, -4, 2);  ///< place of the eye (m)
  Vec3 to = Vec3::Zero();      ///< point at the centre of the picture (m); must differ from `from`
  Vec3 up = Vec3::UnitZ();     ///< upward direction, of any length but 0; usually against gravity
  double fov = 40;             ///< vertical field of view (degrees)
};

/// The least cosine between a plane's normal and the vertical at which the plane is a floor. A steeper plane
/// is a wall: no body comes to rest on it, and drawn in full it would hide more than it shows.
inline constexpr double floor_cosine = 0.25;

/// Returns the camera's axes: right, up and forward as columns, orthonormal. The camera may look along `up`.
Mat3 axes_of(const Camera& camera);

/// Returns the direction against gravity, or z if there is no gravity.
Vec3 up_of(const Vec3& gravity);

/// Returns the nearest camera, looking down at a slant, that sees every moving body where it is and where it
/// would land on a plane, and all fixed bodies that are no larger than the group of the moving ones. `aspect`
/// is width / height, `fov` as in Camera.
Camera frame_all(const Snapshot& snapshot, const Vec3& gravity, double aspect, double fov = 40);

/// Returns the width of the cells of the grid on planes (m). It is a power of ten, chosen so that some 8 to
/// 80 cells fit into the height of the picture.
double grid_cell(const Camera& camera);

}  // namespace scree::render
