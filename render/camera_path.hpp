// How the camera moves.
#pragma once

#include "render/camera.hpp"

#include <vector>

namespace scree::render {

/// Turns the camera about the axis through `to` along `up`: counter-clockwise seen from above.
Camera orbited(const Camera& camera, double angle);

/// A camera at a time.
struct CameraKey {
  double at = 0;  ///< s
  Camera camera;
};

/// A way through the keys, at rest at both ends, its velocity continuous (C1): places go along a cubic
/// Hermite spline with the tangents of Catmull and Rom 1974 for uneven times, the field of view in smooth
/// steps, which cannot overshoot.
class CameraPath {
 public:
  /// `keys`: at least one, by ascending time, no two at once; all with the same `up`.
  explicit CameraPath(std::vector<CameraKey> keys) : keys_(std::move(keys)) {}

  Camera at(double time) const;

 private:
  std::vector<CameraKey> keys_;
};

}  // namespace scree::render
