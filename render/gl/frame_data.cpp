#include "render/gl/frame_data.hpp"

#include "render/gl/facets.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>

namespace scree::render::gl {

namespace {

/// Calls work(k) for each k below `count`, with chunks in parallel.
template <class Work>
void for_each(std::size_t count, Work work) {
  constexpr std::size_t chunk = 8192;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, chunk), [&](const auto& range) {
    for (std::size_t k = range.begin(); k < range.end(); ++k) work(k);
  });
}

/// Returns the values of the optionals that `of(k)` returns for k below `count`, in order.
template <class T, class Of>
std::vector<T> collect(std::size_t count, Of of) {
  constexpr std::size_t chunk = 16384;
  std::vector<std::vector<T>> parts((count + chunk - 1) / chunk);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t p) {
    for (std::size_t k = p * chunk; k < std::min((p + 1) * chunk, count); ++k)
      if (const std::optional<T> item = of(k)) parts[p].push_back(*item);
  });
  std::vector<std::size_t> first(parts.size() + 1, 0);
  for (std::size_t p = 0; p < parts.size(); ++p) first[p + 1] = first[p] + parts[p].size();
  std::vector<T> all(first.back());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t p) {
    std::ranges::copy(parts[p], all.begin() + static_cast<std::ptrdiff_t>(first[p]));
  });
  return all;
}

Vec4f packed_color(const Color& c, float w) { return {c.x(), c.y(), c.z(), w}; }

enum class PlaneKind { ground, wall, hidden };

struct PlaneFace {
  Vec3 normal, point;  // `point` is the point of the plane nearest to the focus, relative to the eye
  PlaneKind kind;
};

PlaneFace face_of(const BodyTable& bodies, std::size_t k, const View& v) {
  PlaneFace face;
  face.normal = bodies.orientation[k] * Vec3::UnitZ();
  const double height = face.normal.dot(v.eye - bodies.position[k]);
  face.point = v.focus - face.normal * (height + face.normal.dot(v.focus));
  face.kind = height <= 0                             ? PlaneKind::hidden
              : face.normal.dot(v.up) >= floor_cosine ? PlaneKind::ground
                                                      : PlaneKind::wall;
  return face;
}

// Returns the distance over which bodies shade each other (ambient occlusion, m): a few sizes of a typical
// body, within limits relative to the size of the view.
double occlusion_reach(const BodyTable& bodies, const View& v) {
  // If there are many bodies, a sample is taken: its median is as typical.
  const std::size_t stride = 1 + bodies.shape.size() / 100000;
  std::vector<double> sizes;
  for (std::size_t k = 0; k < bodies.shape.size(); k += stride) {
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

// Fills the texels, in the order that FrameUniforms::begin and ::after describe. The vector is overwritten in
// place, because to make a vector of a gigabyte takes longer than to fill it.
class Packing {
 public:
  Packing(const Frame& frame, const View& view, const Style& style, double cell, std::vector<Vec4f>& texels)
      : bodies_(frame.snapshot.bodies),
        view_(view),
        paint_(frame, style.color_by, style.range ? *style.range : value_range(frame, style.color_by),
               style.palette, style.muted),
        cell_(cell),
        texels_(texels) {}
  ~Packing() { texels_.resize(4 * packed_); }

  /// Appends those of the given bodies that have the shape. Returns the index after the last of them.
  std::int32_t append(Shape shape, const std::vector<std::int32_t>& bodies) {
    const std::vector<std::int32_t> alike = collect<std::int32_t>(bodies.size(), [&](std::size_t n) {
      const std::int32_t body = bodies[n];
      return bodies_.shape[static_cast<std::size_t>(body)] == shape ? std::optional(body) : std::nullopt;
    });
    Vec4f* const first = room_for(alike.size());
    for_each(alike.size(),
             [&](std::size_t n) { set_solid(static_cast<std::size_t>(alike[n]), first + 4 * n); });
    return static_cast<std::int32_t>(packed_);
  }

  void append_facets(const Frame& frame) {
    std::vector<Vec4f> facets;
    for (std::size_t k = 0; k < bodies_.shape.size(); ++k)
      if (is_general(bodies_.shape[k]) && bodies_.mobility[k] != Mobility::absent)
        facets_of(frame, k, view_.eye, paint_(k), facets);
    std::ranges::copy(facets, room_for(facets.size() / 4));
  }

  std::int32_t append(PlaneKind kind, const std::vector<PlaneFace>& faces) {
    for (const PlaneFace& face : faces) {
      if (face.kind == kind) set_plane(face, room_for(1));
    }
    return static_cast<std::int32_t>(packed_);
  }

 private:
  /// Returns room for the texels of that many bodies. The pointer is valid until the next call.
  Vec4f* room_for(std::size_t bodies) {
    const std::size_t first = 4 * packed_;
    packed_ += bodies;
    if (texels_.size() < 4 * packed_) texels_.resize(4 * packed_);
    return texels_.data() + first;
  }

  void set_solid(std::size_t k, Vec4f* texels) const {
    const Quat& q = bodies_.orientation[k];
    const bool round = bodies_.shape[k] != Shape::box;
    texels[0] = packed(Vec3(bodies_.position[k] - view_.eye), round ? bodies_.size[k].x() : 0.0);
    texels[1] = packed(Vec3(q.vec()), q.w());
    texels[2] = packed(bodies_.size[k], 0);
    texels[3] = packed_color(paint_(k), 0);
  }

  void set_plane(const PlaneFace& face, Vec4f* texels) const {
    // One axis of the grid is level. On a level plane it is x, or y if the plane is at right angles to x.
    const bool level = face.normal.dot(view_.up) > 0.9999;
    const Vec3 world = std::abs(face.normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 across =
        level ? Vec3(world - world.dot(face.normal) * face.normal) : Vec3(view_.up.cross(face.normal));
    const Vec3 a = (across.norm() > 0 ? across : tangent_of(face.normal)).normalized();
    const Vec3 b = face.normal.cross(a);
    // The grid passes through the world's origin. Its phase relative to the eye is the eye's place modulo ten
    // cells, which floats can hold.
    const auto offset = [&](const Vec3& axis) { return std::fmod(axis.dot(view_.eye), 10 * cell_); };
    texels[0] = packed(face.point, level ? 1 : 0);
    texels[1] = packed(a, offset(a));
    texels[2] = packed(b, offset(b));
    texels[3] = packed(face.normal, cell_);
  }

  const BodyTable& bodies_;
  const View& view_;
  Painter paint_;
  double cell_;
  std::vector<Vec4f>& texels_;
  std::size_t packed_ = 0;  // number of bodies packed so far
};

/// The bodies of a frame, by the way in which they are drawn.
struct Shown {
  std::vector<std::int32_t> solids;   ///< spheres and boxes that the camera sees
  std::vector<std::int32_t> casters;  ///< spheres and boxes that the light sees
  std::vector<std::int32_t> tubes;
  std::vector<PlaneFace> faces;
};

Shown shown_in(const BodyTable& bodies, const View& v, const LightView& light, int height, int width,
               int shadow_size, Hidden hidden) {
  Shown shown;
  for (std::size_t k = 0; k < bodies.shape.size(); ++k) {
    if (bodies.mobility[k] == Mobility::absent) continue;
    if (bodies.shape[k] == Shape::plane) shown.faces.push_back(face_of(bodies, k, v));
    if (bodies.shape[k] == Shape::tube) shown.tubes.push_back(static_cast<std::int32_t>(k));
  }
  const std::size_t count = bodies.shape.size();
  const auto is_solid = [&](std::size_t k) {
    return bodies.mobility[k] != Mobility::absent && !is_boundary(bodies.shape[k]) &&
           !is_general(bodies.shape[k]);
  };
  const auto seen = [&](std::size_t k) {
    return is_solid(k) ? v.disc_of(bodies, k, height) : std::optional<Disc>();
  };
  const auto lit = [&](std::size_t k) {
    return is_solid(k) ? std::optional(light.disc_of(bodies, k)) : std::optional<Disc>();
  };
  if (hidden == Hidden::drawn) {
    const auto body_of = [](std::size_t k, bool chosen) {
      return chosen ? std::optional(static_cast<std::int32_t>(k)) : std::nullopt;
    };
    shown.solids =
        collect<std::int32_t>(count, [&](std::size_t k) { return body_of(k, seen(k).has_value()); });
    shown.casters = collect<std::int32_t>(count, [&](std::size_t k) { return body_of(k, is_solid(k)); });
    return shown;
  }
  // The two calls take about the same time, and together most of the time of a frame's data.
  tbb::parallel_invoke(
      [&] { shown.solids = visible_discs(collect<Disc>(count, seen), width, height); },
      [&] { shown.casters = visible_discs(collect<Disc>(count, lit), shadow_size, shadow_size); });
  return shown;
}

void append_line(std::vector<Vec4f>& texels, const Line& line, const View& v, int height) {
  // The width of a line is a fixed share of the picture's height, but never too small to be visible.
  const double width = std::max(line.width * static_cast<float>(height) / 720, 0.5f);
  texels.push_back(packed(Vec3(line.from - v.eye), width));
  texels.push_back(packed(Vec3(line.to - v.eye), line.where_hidden));
  texels.push_back(packed_color(line.color, 1));
}

}  // namespace

void set_frame_data(const Frame& frame, const Camera& camera, const Style& style, int width, int height,
                    int shadow_size, Hidden hidden, FrameData& data) {
  const BodyTable& bodies = frame.snapshot.bodies;
  const View v(camera, static_cast<double>(width) / height);
  const LightView light(bodies, v, shadow_size);
  data.uniforms = uniforms_of(v, light, style, width, height);
  data.uniforms.zenith[3] = static_cast<float>(occlusion_reach(bodies, v));

  const Shown shown = shown_in(bodies, v, light, height, width, shadow_size, hidden);
  Packing packing(frame, v, style, style.cell.value_or(grid_cell(camera)), data.texels);
  std::array<std::int32_t, 4>&begin = data.uniforms.begin, &after = data.uniforms.after;
  begin[0] = packing.append(Shape::sphere, shown.solids);
  begin[1] = packing.append(Shape::box, shown.solids);
  begin[2] = packing.append(Shape::tube, shown.tubes);
  begin[3] = packing.append(PlaneKind::ground, shown.faces);
  after[0] = packing.append(PlaneKind::wall, shown.faces);
  after[1] = packing.append(PlaneKind::hidden, shown.faces);
  after[2] = packing.append(Shape::sphere, shown.casters);
  after[3] = packing.append(Shape::box, shown.casters);
  packing.append_facets(frame);
  data.lines.clear();
  for (const Line& line : frame.lines) append_line(data.lines, line, v, height);
}

}  // namespace scree::render::gl
