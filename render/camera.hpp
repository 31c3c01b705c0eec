// Where a picture is taken from.
#pragma once

#include "core/math.hpp"
#include "core/snapshot.hpp"

namespace scree::render {

struct Camera {
  Vec3 from = Vec3(3, -4, 2);  ///< m
  Vec3 to = Vec3::Zero();      ///< m; not `from`
  Vec3 up = Vec3::UnitZ();     ///< any length but 0; usually against gravity
  double fov = 40;             ///< vertical, degrees
};

/// The camera's axes: right, up and forward as columns, orthonormal. Looking along `up` is allowed.
Mat3 axes_of(const Camera& camera);

/// The direction against gravity; z where there is none.
Vec3 up_of(const Vec3& gravity);

/// The nearest camera, looking down at a slant, that sees every moving body where it is and where it would
/// land on a plane, and the fixed bodies that are no larger than that group. `aspect` is width / height,
/// `fov` as in Camera.
Camera frame_all(const Snapshot& snapshot, const Vec3& gravity, double aspect, double fov = 40);

/// Width of the cells of the grid on planes: a power of ten (m), some 8 to 80 of them over the height of the
/// picture.
double grid_cell(const Camera& camera);

}  // namespace scree::render
