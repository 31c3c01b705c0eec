// The data that depend on the camera: place of the eye, extent of the view, direction and shadow map of the
// light.
#pragma once

#include "render/camera.hpp"
#include "render/frame.hpp"
#include "render/gl/visible.hpp"

#include <array>
#include <optional>

namespace scree::render::gl {

using Vec4f = std::array<float, 4>;

inline Vec4f packed(const Vec3& v, double w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()),
          static_cast<float>(w)};
}

/// The view of a camera. Distances that affect the look are shares of `view`, so that a scene in mm and one
/// in m look the same.
struct View {
  Mat3 axes;  ///< axes of the camera: right, up, forward
  Vec3 eye;
  Vec3 up;     ///< upward direction of the world, unit
  Vec3 focus;  ///< place of the focus relative to the eye
  double tan_x, tan_y;
  double view;  ///< half the height of the visible region at the focus (m)
  double near;  ///< depth of the near plane (m)
  double aspect;
  Vec3 to_light;  ///< direction to the light, unit

  View(const Camera& camera, double aspect_ratio);

  /// Returns the disc of a body in the camera's picture, or nothing if the body is behind the near plane.
  std::optional<Disc> disc_of(const BodyTable& bodies, std::size_t body, int height) const;
};

/// The map from places relative to the eye to the shadow map, with coordinates from 0 to 1. The shadow map
/// covers the bodies near the visible region.
class LightView {
 public:
  LightView(const BodyTable& bodies, const View& view, int map_size);

  std::array<Vec4f, 3> rows() const;
  double texel() const { return size_ / map_size_; }  ///< width of a texel (m)
  /// Returns the width, in shadow map coordinates, that a penumbra gains per unit of map depth between caster
  /// and receiver.
  double spread() const;
  /// Returns a lower bound of the bodies' map depths.
  double nearest() const { return nearest_; }

  /// Returns the disc of a body in the light's picture.
  Disc disc_of(const BodyTable& bodies, std::size_t body) const;

 private:
  Mat3 axes_;  ///< two axes across the light, and one along its rays
  Vec3 eye_;
  Vec3 corner_;  ///< corner of the map's volume, along axes_ (m)
  double size_ = 0, depth_ = 0, nearest_ = 0;
  int map_size_;
};

}  // namespace scree::render::gl
