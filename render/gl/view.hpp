// What follows from the camera alone: where the eye is, how far it sees, where the light stands.
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

/// Lengths of the look are shares of `view`, so that a scene in mm and in m look the same.
struct View {
  Mat3 axes;  ///< right, up, forward
  Vec3 eye;
  Vec3 up;     ///< of the world, unit
  Vec3 focus;  ///< relative to the eye
  double tan_x, tan_y;
  double view;  ///< half height of what is seen at the focus (m)
  double near;  ///< depth of the near plane (m)
  double aspect;
  Vec3 to_light;  ///< unit

  View(const Camera& camera, double aspect_ratio);

  /// The body as the camera sees it; nothing where it is behind the near plane.
  std::optional<Disc> disc_of(const BodyTable& bodies, std::size_t body, int height) const;
};

/// The map from places relative to the eye to the shadow map, 0 to 1 in each coordinate, which covers the
/// bodies near what is seen.
class LightView {
 public:
  LightView(const BodyTable& bodies, const View& view, int map_size);

  std::array<Vec4f, 3> rows() const;
  double texel() const { return size_ / map_size_; }  ///< m
  /// Shadow map coordinates by which a penumbra widens per unit of map depth between caster and receiver.
  double spread() const;
  /// No body is nearer to the light than this map depth.
  double nearest() const { return nearest_; }

  /// The body as the light sees it.
  Disc disc_of(const BodyTable& bodies, std::size_t body) const;

 private:
  Mat3 axes_;  ///< across the light, and along its rays
  Vec3 eye_;
  Vec3 corner_;  ///< of the map's volume, along axes_ (m)
  double size_ = 0, depth_ = 0, nearest_ = 0;
  int map_size_;
};

}  // namespace scree::render::gl
