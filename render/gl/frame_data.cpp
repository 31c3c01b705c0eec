#include "render/gl/frame_data.hpp"

#include <algorithm>
#include <cmath>
#include <future>

namespace scree::render::gl {

namespace {

Vec4f packed_color(const Color& c, float w) { return {c.x(), c.y(), c.z(), w}; }

// Steeper than this (cosine), a plane in full would hide more than it shows.
constexpr double wall_cosine = 0.25;

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
  face.kind = height <= 0                           ? PlaneKind::hidden
              : face.normal.dot(v.up) > wall_cosine ? PlaneKind::ground
                                                    : PlaneKind::wall;
  return face;
}

// How far away things still shade each other: a few sizes of a typical body, within what the picture shows
// well.
double occlusion_reach(const BodyTable& bodies, const View& v) {
  std::vector<double> sizes;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (is_colored(bodies, k)) sizes.push_back(bounding_radius(bodies.shape[k], bodies.size[k]));
  }
  if (sizes.empty()) return 0.1 * v.view;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::clamp(2 * *middle, 0.03 * v.view, 0.25 * v.view);
}

FrameUniforms uniforms_of(const View& v, const LightView& light, const Style& style, int width, int height) {
  FrameUniforms u{};
  const auto edge = [](const Vec3& axis, double tangent) {
    return packed(Vec3(axis * tangent), 1 / (tangent * tangent));
  };
  u.right = edge(v.axes.col(0), v.tan_x);
  u.up = edge(v.axes.col(1), v.tan_y);
  u.forward = packed(Vec3(v.axes.col(2)), v.near);
  u.shadow = light.rows();
  u.to_light = packed(v.to_light, light.texel());
  u.world_up = packed(v.up, 2 * v.tan_y / height);
  u.focus = packed(v.focus, 2.5 * v.view * std::max(1.0, v.aspect));
  u.zenith = packed_color(linear_of(style.zenith), 0);
  u.horizon = packed_color(linear_of(style.horizon), 0);
  u.penumbra = {static_cast<float>(light.spread()), static_cast<float>(light.nearest()), 0, 0};
  u.extent = {0, width, height, 0};
  return u;
}

// Fills the texels, in the order that FrameUniforms::begin and ::after tell.
class Packing {
 public:
  Packing(const Frame& frame, const View& view, const Style& style, double cell, FrameData& data)
      : bodies_(frame.snapshot.bodies),
        view_(view),
        paint_(frame, style.color_by, style.range ? *style.range : value_range(frame, style.color_by),
               style.palette, style.muted),
        cell_(cell),
        data_(data) {}

  /// Those of the bodies that have the shape; returns where they end.
  std::int32_t append(Shape shape, const std::vector<std::int32_t>& bodies) {
    for (const std::int32_t body : bodies) {
      const auto k = static_cast<std::size_t>(body);
      if (bodies_.shape[k] == shape) append_solid(k);
    }
    return count();
  }

  std::int32_t append(PlaneKind kind, const std::vector<PlaneFace>& faces) {
    for (const PlaneFace& face : faces) {
      if (face.kind == kind) append_plane(face);
    }
    return count();
  }

 private:
  std::int32_t count() const { return static_cast<std::int32_t>(data_.texels.size() / 4); }

  void append_solid(std::size_t k) {
    const Quat& q = bodies_.orientation[k];
    const bool round = bodies_.shape[k] != Shape::box;
    data_.texels.push_back(packed(Vec3(bodies_.position[k] - view_.eye), round ? bodies_.size[k].x() : 0.0));
    data_.texels.push_back(packed(Vec3(q.vec()), q.w()));
    data_.texels.push_back(packed(bodies_.size[k], 0));
    data_.texels.push_back(packed_color(paint_(k), 0));
  }

  void append_plane(const PlaneFace& face) {
    // One axis of the grid is level; on a level plane it is x, or y for a plane at right angles to x.
    const bool level = face.normal.dot(view_.up) > 0.9999;
    const Vec3 world = std::abs(face.normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 across =
        level ? Vec3(world - world.dot(face.normal) * face.normal) : Vec3(view_.up.cross(face.normal));
    const Vec3 a = (across.norm() > 0 ? across : tangent_of(face.normal)).normalized();
    const Vec3 b = face.normal.cross(a);
    // The grid passes through the world's origin; what is left of that in floats is the eye's place within
    // ten cells.
    const auto offset = [&](const Vec3& axis) { return std::fmod(axis.dot(view_.eye), 10 * cell_); };
    data_.texels.push_back(packed(face.point, level ? 1 : 0));
    data_.texels.push_back(packed(a, offset(a)));
    data_.texels.push_back(packed(b, offset(b)));
    data_.texels.push_back(packed(face.normal, cell_));
  }

  const BodyTable& bodies_;
  const View& view_;
  Painter paint_;
  double cell_;
  FrameData& data_;
};

void append_line(std::vector<Vec4f>& texels, const Line& line, const View& v, int height) {
  // Lines keep their share of the picture, but never get too thin to be seen.
  const double width = std::max(line.width * static_cast<float>(height) / 720, 0.5f);
  texels.push_back(packed(Vec3(line.from - v.eye), width));
  texels.push_back(packed(Vec3(line.to - v.eye), line.where_hidden));
  texels.push_back(packed_color(line.color, 1));
}

}  // namespace

FrameData frame_data(const Frame& frame, const Camera& camera, const Style& style, int width, int height,
                     int shadow_size) {
  const BodyTable& bodies = frame.snapshot.bodies;
  const View v(camera, static_cast<double>(width) / height);
  const LightView light(bodies, v, shadow_size);
  FrameData data;
  data.uniforms = uniforms_of(v, light, style, width, height);
  data.uniforms.zenith[3] = static_cast<float>(occlusion_reach(bodies, v));

  std::vector<Disc> seen, lit;
  std::vector<std::int32_t> tubes;
  std::vector<PlaneFace> faces;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.mobility[k] == Mobility::absent) continue;
    if (bodies.shape[k] == Shape::plane) {
      faces.push_back(face_of(bodies, k, v));
    } else if (bodies.shape[k] == Shape::tube) {
      tubes.push_back(static_cast<std::int32_t>(k));
    } else {
      if (const std::optional<Disc> disc = v.disc_of(bodies, k, height)) seen.push_back(*disc);
      lit.push_back(light.disc_of(bodies, k));
    }
  }
  // The two take about as long, and most of the time of this function.
  auto casting = std::async(std::launch::async, [&] { return visible_discs(lit, shadow_size, shadow_size); });
  const std::vector<std::int32_t> shown = visible_discs(seen, width, height);
  const std::vector<std::int32_t> casters = casting.get();

  Packing packing(frame, v, style, style.cell.value_or(grid_cell(camera)), data);
  std::array<std::int32_t, 4>&begin = data.uniforms.begin, &after = data.uniforms.after;
  begin[0] = packing.append(Shape::sphere, shown);
  begin[1] = packing.append(Shape::box, shown);
  begin[2] = packing.append(Shape::tube, tubes);
  begin[3] = packing.append(PlaneKind::ground, faces);
  after[0] = packing.append(PlaneKind::wall, faces);
  after[1] = packing.append(PlaneKind::hidden, faces);
  after[2] = packing.append(Shape::sphere, casters);
  after[3] = packing.append(Shape::box, casters);
  for (const Line& line : frame.lines) append_line(data.lines, line, v, height);
  return data;
}

}  // namespace scree::render::gl
