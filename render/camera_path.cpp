#include "render/camera_path.hpp"

#include <algorithm>

namespace scree::render {

Camera orbited(const Camera& camera, double angle) {
  Camera turned = camera;
  turned.from = camera.to + Eigen::AngleAxisd(angle, camera.up.normalized()) * Vec3(camera.from - camera.to);
  return turned;
}

Camera CameraPath::at(double time) const {
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), time,
                                      [](double t, const CameraKey& key) { return t < key.at; });
  if (after == keys_.begin()) return keys_.front().camera;
  if (after == keys_.end()) return keys_.back().camera;
  const CameraKey &a = *std::prev(after), &b = *after;
  const double length = b.at - a.at, s = (time - a.at) / length;
  // The velocity of a point at a key (m/s); zero at both ends of the path.
  const auto tangent = [&](auto key, Vec3 Camera::*point) {
    if (key == keys_.begin() || std::next(key) == keys_.end()) return Vec3(Vec3::Zero());
    const CameraKey &before = *std::prev(key), &next = *std::next(key);
    return Vec3((next.camera.*point - before.camera.*point) / (next.at - before.at));
  };
  const auto spline = [&](Vec3 Camera::*point) {
    const double ss = s * s, sss = ss * s;
    return Vec3((2 * sss - 3 * ss + 1) * (a.camera.*point) + (3 * ss - 2 * sss) * (b.camera.*point) +
                length * ((sss - 2 * ss + s) * tangent(std::prev(after), point) +
                          (sss - ss) * tangent(after, point)));
  };
  Camera camera = a.camera;
  camera.from = spline(&Camera::from);
  camera.to = spline(&Camera::to);
  camera.fov += (b.camera.fov - a.camera.fov) * s * s * (3 - 2 * s);
  return camera;
}

}  // namespace scree::render
