// The motion of the camera: an orbit about a point, and a path through given keys.
#pragma once

#include "render/camera.hpp"

#include <vector>

namespace scree::render {

/// Returns the camera turned by `angle` (rad) about the axis through `to` along `up`, counter-clockwise seen
/// from above.
Camera orbited(const Camera& camera, double angle);

/// A camera at a given time.
struct CameraKey {
  double at = 0;  ///< time (s)
  Camera camera;
};

/// A path of the camera through the keys, at rest at both ends, with continuous velocity (C1). The places
/// follow a cubic Hermite spline with the tangents of Catmull and Rom 1974 for uneven times. The field of
/// view changes from key to key by a smoothstep, which cannot overshoot.
class CameraPath {
 public:
  /// `keys` must be at least one, by ascending time, no two at the same time, and all with the same `up`.
  explicit CameraPath(std::vector<CameraKey> keys) : keys_(std::move(keys)) {}

  Camera at(double time) const;

 private:
  std::vector<CameraKey> keys_;
};

}  // namespace scree::render
