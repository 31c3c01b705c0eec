#include "render/gl/frame_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree::render::gl {

namespace {

Vec4f packed(const Vec3& v, double w) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()),
          static_cast<float>(w)};
}

Vec4f packed(const Color& c, float w) { return {c.x(), c.y(), c.z(), w}; }

// What follows from the camera alone. Lengths of the look are shares of `view`, so that a scene in mm and in
// m look the same.
struct View {
  Mat3 axes;
  Vec3 eye, up, focus;  // focus relative to the eye
  double tan_x, tan_y;
  double view;    // half height of what is seen at the focus (m)
  Vec3 to_light;  // unit
};

View view_of(const Camera& camera, double aspect) {
  View v;
  v.axes = axes_of(camera);
  v.eye = camera.from;
  v.up = camera.up.normalized();
  v.focus = camera.to - camera.from;
  v.tan_y = std::tan(0.5 * camera.fov * pi / 180);
  v.tan_x = v.tan_y * aspect;
  v.view = v.focus.norm() * v.tan_y;
  // From above, the left, and a little behind the camera: shadows fall to the right and away.
  const Vec3 ahead = v.up.cross(v.axes.col(0));
  v.to_light = (v.up - 0.62 * v.axes.col(0) - 0.38 * ahead).normalized();
  return v;
}

// Colours of bodies in linear light.
class Painter {
 public:
  Painter(const Snapshot& snapshot, const Style& style)
      : bodies_(snapshot.bodies),
        color_by_(style.color_by),
        range_(style.range ? *style.range : value_range(snapshot, style.color_by)) {
    for (const Color& color : style.palette) palette_.push_back(linear_of(color));
    if (palette_.empty()) palette_.push_back(Color::Constant(0.5f));
  }

  Color operator()(std::size_t k) const {
    // Whatever the colours mean, fixed bodies stay in the background.
    static const Color stone = linear_of({0.72f, 0.71f, 0.69f});
    if (bodies_.mobility[k] == Mobility::fixed) return stone;
    if (color_by_ == ColorBy::material) {
      return tinted(palette_[static_cast<std::size_t>(bodies_.material[k]) % palette_.size()], bodies_.id[k]);
    }
    const double value = color_by_ == ColorBy::speed ? bodies_.velocity[k].norm()
                                                     : bounding_radius(bodies_.shape[k], bodies_.size[k]);
    return scale_color((value - range_[0]) / (range_[1] - range_[0]));
  }

 private:
  const BodyTable& bodies_;
  ColorBy color_by_;
  std::array<double, 2> range_;
  std::vector<Color> palette_;
};

enum class PlaneKind { ground, wall, hidden };

struct PlaneFace {
  Vec3 normal, point;  // the point next to the focus, relative to the eye
  PlaneKind kind;
};

PlaneFace face_of(const BodyTable& bodies, std::size_t k, const View& v) {
  PlaneFace face;
  face.normal = bodies.orientation[k] * Vec3::UnitZ();
  const double height = face.normal.dot(v.eye - bodies.position[k]);
  face.point = v.focus - face.normal * (height + face.normal.dot(v.focus));
  // Steeper than this, a plane in full would hide more than it shows.
  constexpr double wall_cosine = 0.25;
  face.kind = height <= 0                           ? PlaneKind::hidden
              : face.normal.dot(v.up) > wall_cosine ? PlaneKind::ground
                                                    : PlaneKind::wall;
  return face;
}

void append_sphere(std::vector<Vec4f>& texels, const BodyTable& bodies, std::size_t k, const View& v,
                   const Color& color) {
  const Quat& q = bodies.orientation[k];
  texels.push_back(packed(Vec3(bodies.position[k] - v.eye), bodies.size[k].x()));
  texels.push_back(packed(Vec3(q.vec()), q.w()));
  texels.push_back({});
  texels.push_back(packed(color, 0));
}

void append_box(std::vector<Vec4f>& texels, const BodyTable& bodies, std::size_t k, const View& v,
                const Color& color) {
  const Quat& q = bodies.orientation[k];
  texels.push_back(packed(Vec3(bodies.position[k] - v.eye), 0));
  texels.push_back(packed(Vec3(q.vec()), q.w()));
  texels.push_back(packed(bodies.size[k], 0));
  texels.push_back(packed(color, 0));
}

void append_plane(std::vector<Vec4f>& texels, const PlaneFace& face, const View& v) {
  // One axis of the grid is level; on a level plane it is x, or y for a plane at right angles to x.
  const bool level = face.normal.dot(v.up) > 0.9999;
  const Vec3 world = std::abs(face.normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 across =
      level ? Vec3(world - world.dot(face.normal) * face.normal) : Vec3(v.up.cross(face.normal));
  const Vec3 a = (across.norm() > 0 ? across : tangent_of(face.normal)).normalized();
  const Vec3 b = face.normal.cross(a);
  // A power of ten, with some 8 to 80 cells over the height of the picture.
  const double cell = std::pow(10.0, std::floor(std::log10(v.view / 4)));
  // The grid passes through the world's origin; what is left of that in floats is the eye's place within ten
  // cells.
  const auto offset = [&](const Vec3& axis) { return std::fmod(axis.dot(v.eye), 10 * cell); };
  texels.push_back(packed(face.point, level ? 1 : 0));
  texels.push_back(packed(a, offset(a)));
  texels.push_back(packed(b, offset(b)));
  texels.push_back(packed(face.normal, cell));
}

// Rows of the map from places relative to the eye to the shadow map, covering the bodies near what is seen.
std::array<Vec4f, 3> shadow_rows(const BodyTable& bodies, const View& v, int shadow_size, double& texel) {
  const Vec3 x = tangent_of(v.to_light);
  Mat3 light;
  light << x, v.to_light.cross(x), -v.to_light;
  // One body far off must not take the resolution from all others.
  const double reach = 4 * v.view * std::max(1.0, v.tan_x / v.tan_y);
  const Vec3 focus = light.transpose() * v.focus;
  Eigen::AlignedBox3d bounds;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.shape[k] == Shape::plane || bodies.mobility[k] == Mobility::absent) continue;
    const Vec3 center = light.transpose() * (bodies.position[k] - v.eye);
    const Vec3 radius = Vec3::Constant(bounding_radius(bodies.shape[k], bodies.size[k]));
    const Vec3 low = (center - radius).cwiseMax(focus - Vec3::Constant(reach));
    const Vec3 high = (center + radius).cwiseMin(focus + Vec3::Constant(reach));
    if ((low.array() <= high.array()).all()) bounds.extend(Eigen::AlignedBox3d(low, high));
  }
  if (bounds.isEmpty()) bounds.extend(focus);
  // Sizes in steps and corners on multiples of a texel keep the edges of shadows still while bodies move.
  const double least = 0.01 * v.view;
  const double wanted = 1.05 * std::max({bounds.sizes().x(), bounds.sizes().y(), least});
  const double size = std::exp2(std::ceil(8 * std::log2(wanted)) / 8);
  texel = size / shadow_size;
  Vec3 corner = bounds.center() - Vec3::Constant(0.5 * size);
  for (int axis = 0; axis < 2; ++axis) corner[axis] = texel * std::floor(corner[axis] / texel);
  // Receivers in front of the first caster and behind the last one, on the ground, have depths as well.
  const double depth = 2 * bounds.sizes().z() + 4 * size;
  corner.z() = bounds.center().z() - 0.5 * depth;
  const Vec3 scale(1 / size, 1 / size, 1 / depth);
  std::array<Vec4f, 3> rows;
  for (int axis = 0; axis < 3; ++axis) {
    rows[static_cast<std::size_t>(axis)] =
        packed(Vec3(light.col(axis) * scale[axis]), -corner[axis] * scale[axis]);
  }
  return rows;
}

// How far away things still shade each other: a few sizes of a typical body, within what the picture shows
// well.
double occlusion_reach(const BodyTable& bodies, const View& v) {
  std::vector<double> sizes;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.mobility[k] != Mobility::fixed)
      sizes.push_back(bounding_radius(bodies.shape[k], bodies.size[k]));
  }
  if (sizes.empty()) return 0.1 * v.view;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::clamp(2 * *middle, 0.03 * v.view, 0.25 * v.view);
}

FrameUniforms uniforms_of(const BodyTable& bodies, const View& v, const Style& style, int width, int height,
                          int shadow_size) {
  FrameUniforms u{};
  const auto edge = [](const Vec3& axis, double tangent) {
    return packed(Vec3(axis * tangent), 1 / (tangent * tangent));
  };
  u.right = edge(v.axes.col(0), v.tan_x);
  u.up = edge(v.axes.col(1), v.tan_y);
  u.forward = packed(Vec3(v.axes.col(2)), 0.01 * v.focus.norm());
  double texel = 0;
  u.shadow = shadow_rows(bodies, v, shadow_size, texel);
  u.to_light = packed(v.to_light, texel);
  u.world_up = packed(v.up, 2 * v.tan_y / height);
  u.focus = packed(v.focus, 2.5 * v.view * std::max(1.0, v.tan_x / v.tan_y));
  u.zenith = packed(linear_of(style.zenith), static_cast<float>(occlusion_reach(bodies, v)));
  u.horizon = packed(linear_of(style.horizon), 0);
  u.extent = {0, width, height, 0};
  return u;
}

}  // namespace

FrameData frame_data(const Snapshot& snapshot, const Camera& camera, const Style& style, int width,
                     int height, int shadow_size) {
  const BodyTable& bodies = snapshot.bodies;
  const View v = view_of(camera, static_cast<double>(width) / height);
  const Painter paint(snapshot, style);
  FrameData data;
  data.uniforms = uniforms_of(bodies, v, style, width, height, shadow_size);
  data.texels.reserve(4 * bodies.shape.size());
  const auto count = [&data] { return static_cast<std::int32_t>(data.texels.size() / 4); };

  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.shape[k] == Shape::sphere) append_sphere(data.texels, bodies, k, v, paint(k));
  }
  data.uniforms.begin[0] = count();
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.shape[k] == Shape::box) append_box(data.texels, bodies, k, v, paint(k));
  }
  data.uniforms.begin[1] = count();
  std::vector<PlaneFace> faces;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.shape[k] == Shape::plane) faces.push_back(face_of(bodies, k, v));
  }
  for (const PlaneKind kind : {PlaneKind::ground, PlaneKind::wall, PlaneKind::hidden}) {
    for (const PlaneFace& face : faces) {
      if (face.kind == kind) append_plane(data.texels, face, v);
    }
    if (kind == PlaneKind::ground) data.uniforms.begin[2] = count();
    if (kind == PlaneKind::wall) data.uniforms.begin[3] = count();
  }
  data.uniforms.extent[0] = count();
  return data;
}

}  // namespace scree::render::gl
