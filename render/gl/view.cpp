#include "render/gl/view.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

namespace scree::render::gl {

namespace {

/// The angular radius of the light, as a tangent. It is that of a large lamp rather than of the sun (0.005),
/// so that the softness of a shadow shows how far a body is from the surface that it shades.
constexpr double light_radius = 0.035;

/// Returns the radius of the largest disc about the centre that lies inside the body, at right angles to
/// `view` (unit). A face of a box intersects the plane of the disc at the face's distance from the centre
/// divided by the sine of the angle between the face's normal and the view.
double section_radius(const BodyTable& bodies, std::size_t body, const Vec3& view) {
  const Vec3& size = bodies.size[body];
  if (bodies.shape[body] == Shape::sphere) return size.x();
  const Vec3 along = bodies.orientation[body].conjugate() * view;
  return (size.array() / (1 - along.array().square()).max(1e-12).sqrt()).minCoeff();
}

}  // namespace

View::View(const Camera& camera, double aspect_ratio)
    : axes(axes_of(camera)),
      eye(camera.from),
      up(camera.up.normalized()),
      focus(camera.to - camera.from),
      tan_y(std::tan(0.5 * camera.fov * pi / 180)) {
  aspect = aspect_ratio;
  tan_x = tan_y * aspect;
  view = focus.norm() * tan_y;
  near = 0.01 * focus.norm();
  // The light comes from above, from the left, and from a little behind the camera, so that shadows fall to
  // the right and away.
  const Vec3 ahead = up.cross(axes.col(0));
  to_light = (up - 0.62 * axes.col(0) - 0.38 * ahead).normalized();
}

std::optional<Disc> View::disc_of(const BodyTable& bodies, std::size_t body, int height) const {
  const Vec3 at = bodies.position[body] - eye;
  const Vec3 p = axes.transpose() * at;
  const double radius = bounding_radius(bodies.shape[body], bodies.size[body]);
  if (p.z() + radius < near) return {};
  Disc disc{.body = static_cast<std::int32_t>(body)};
  if (p.z() - radius < near) {
    disc.outer = 4.0f * static_cast<float>(height) * static_cast<float>(std::max(aspect, 1.0));
    return disc;
  }
  const double focal = 0.5 * height / tan_y;
  disc.x = static_cast<float>(0.5 * height * aspect + focal * p.x() / p.z());
  disc.y = static_cast<float>(0.5 * height + focal * p.y() / p.z());
  // A point c + d of the ball, |d| <= r, is seen (d_x c_z - c_x d_z) / (c_z (c_z + d_z)) beside its centre.
  disc.outer = static_cast<float>(focal * radius * p.norm() / (p.z() * (p.z() - radius)));
  // The inner disc lies across the axis of the camera, at the depth of the centre: such a disc is seen as a
  // disc.
  disc.inner = static_cast<float>(focal * section_radius(bodies, body, axes.col(2)) / p.z());
  disc.near = static_cast<float>(p.z() - radius);
  disc.far = static_cast<float>(p.z());
  return disc;
}

LightView::LightView(const BodyTable& bodies, const View& v, int map_size)
    : eye_(v.eye), map_size_(map_size) {
  const Vec3 x = tangent_of(v.to_light);
  axes_ << x, v.to_light.cross(x), -v.to_light;
  // The volume is limited, so that one body far away does not take the resolution from all others.
  const double reach = 4 * v.view * std::max(1.0, v.aspect);
  const Vec3 focus = axes_.transpose() * v.focus;
  const auto add_to = [&](Eigen::AlignedBox3d& bounds, std::size_t k) {
    // Boundaries cast no shadows, because bodies inside them would lie in the dark. Meshes cast shadows, but
    // only where bodies need the map.
    if (is_surface(bodies.shape[k]) || bodies.mobility[k] == Mobility::absent) return;
    const Vec3 center = axes_.transpose() * (bodies.position[k] - eye_);
    const Vec3 radius = Vec3::Constant(bounding_radius(bodies.shape[k], bodies.size[k]));
    const Vec3 low = (center - radius).cwiseMax(focus - Vec3::Constant(reach));
    const Vec3 high = (center + radius).cwiseMin(focus + Vec3::Constant(reach));
    if ((low.array() <= high.array()).all()) bounds.extend(Eigen::AlignedBox3d(low, high));
  };
  using Range = tbb::blocked_range<std::size_t>;
  Eigen::AlignedBox3d bounds = tbb::parallel_reduce(
      Range(0, bodies.shape.size(), 8192), Eigen::AlignedBox3d(),
      [&](const Range& range, Eigen::AlignedBox3d part) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) add_to(part, k);
        return part;
      },
      [](const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) { return a.merged(b); });
  if (bounds.isEmpty()) bounds.extend(focus);
  // The size changes in steps and the corners are multiples of a texel, so that the edges of shadows stay
  // still while bodies move.
  const double least = 0.01 * v.view;
  // The map is a fifth larger than the bodies need, for penumbras.
  const double wanted = 1.2 * std::max({bounds.sizes().x(), bounds.sizes().y(), least});
  size_ = std::exp2(std::ceil(8 * std::log2(wanted)) / 8);
  corner_ = bounds.center() - Vec3::Constant(0.5 * size_);
  for (int axis = 0; axis < 2; ++axis) corner_[axis] = texel() * std::floor(corner_[axis] / texel());
  // Receivers in front of the first caster and behind the last one, such as the ground, must have depths in
  // the map too.
  depth_ = 2 * reach;
  corner_.z() = focus.z() - reach;
  nearest_ = (bounds.min().z() - corner_.z()) / depth_;
}

std::array<Vec4f, 3> LightView::rows() const {
  const Vec3 scale(1 / size_, 1 / size_, 1 / depth_);
  std::array<Vec4f, 3> rows;
  for (int axis = 0; axis < 3; ++axis) {
    rows[static_cast<std::size_t>(axis)] =
        packed(Vec3(axes_.col(axis) * scale[axis]), -corner_[axis] * scale[axis]);
  }
  return rows;
}

double LightView::spread() const { return light_radius * depth_ / size_; }

Disc LightView::disc_of(const BodyTable& bodies, std::size_t body) const {
  const Vec3 p = axes_.transpose() * (bodies.position[body] - eye_) - corner_;
  const double radius = bounding_radius(bodies.shape[body], bodies.size[body]);
  return {.x = static_cast<float>(p.x() / texel()),
          .y = static_cast<float>(p.y() / texel()),
          .outer = static_cast<float>(radius / texel()),
          .inner = static_cast<float>(section_radius(bodies, body, axes_.col(2)) / texel()),
          .near = static_cast<float>(p.z() - radius),
          .far = static_cast<float>(p.z()),
          .body = static_cast<std::int32_t>(body)};
}

}  // namespace scree::render::gl
