#include "narrowphase/convex_body.hpp"

#include "core/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace scree {

namespace {

/// Returns a box whose vertices are at -1 and 1.
const Hull& unit_box() {
  static const Hull box = [] {
    std::array<Vec3, 8> corners;
    for (std::size_t c = 0; c < 8; ++c) corners[c] = Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1);
    return make_hull(corners);
  }();
  return box;
}

constexpr int disc_corners = 16;

bool is_along(const Vec3& normal, const Vec3& along) {
  return normal.dot(along) >= 1 - tolerance::face_cosine;
}

/// Returns whether an edge is nearly at right angles to a unit direction.
bool is_across(const Vec3& edge, const Vec3& direction) {
  return std::abs(edge.dot(direction)) <= tolerance::parallel_edges * edge.norm();
}

}  // namespace

ConvexBody::ConvexBody(const ShapedSolid& body, const ShapeData* data, const Vec3& origin)
    : centre_(body.solid.position - origin),
      axes_(body.solid.orientation.toRotationMatrix()),
      size_(smallest_size(body.shape, body.solid.size)),
      extent_(body.solid.size.maxCoeff()) {
  const Vec3& size = body.solid.size;
  switch (body.shape) {
    case Shape::sphere:
      kind_ = Kind::point;
      radius_ = size.x();
      vertices_[vertex_count_++] = centre_;
      break;
    case Shape::capsule:
      kind_ = Kind::segment;
      radius_ = size.x();
      edge_count_ = 1;
      for (const double side : {-1.0, 1.0})
        vertices_[vertex_count_++] = centre_ + side * (size.z() - size.x()) * axes_.col(2);
      break;
    case Shape::cylinder:
      kind_ = Kind::cylinder;
      disc_ = size.x();
      half_ = size.z();
      face_count_ = 2;
      edge_count_ = 1;
      break;
    case Shape::triangle:
      kind_ = Kind::triangle;
      face_count_ = 2;
      edge_count_ = 3;
      for (int k = 0; k < 3; ++k) vertices_[vertex_count_++] = centre_ + axes_ * triangle_corner(size, k);
      break;
    case Shape::polyhedron:
      take(*data->hull, Vec3::Ones());
      break;
    default:
      take(unit_box(), size);
      break;
  }
  if (kind_ == Kind::polytope) return;
  normals_[0] = axes_.col(2);
  normals_[1] = -axes_.col(2);
}

void ConvexBody::take(const Hull& hull, const Vec3& scale) {
  kind_ = Kind::polytope;
  hull_ = &hull;
  face_count_ = static_cast<int>(hull.faces.size());
  edge_count_ = static_cast<int>(hull.edges.size());
  for (const Vec3& v : hull.vertices) vertices_[vertex_count_++] = centre_ + axes_ * v.cwiseProduct(scale);
  for (int f = 0; f < face_count_; ++f) normals_[f] = axes_ * hull.faces[static_cast<std::size_t>(f)].normal;
}

/// Returns the point of a cylinder that is farthest along a direction. If a whole cap is farthest, the point
/// is at `middle` times the radius from the centre of the cap.
Vec3 ConvexBody::of_cylinder(const Vec3& along, double middle) const {
  const Vec3 local = axes_.transpose() * along;
  const double across = std::sqrt(local.x() * local.x() + local.y() * local.y());
  const Vec3 rim = across > 0 ? Vec3(disc_ / across * local.x(), disc_ / across * local.y(), 0)
                              : Vec3(middle * disc_, 0, 0);
  return centre_ + axes_ * (rim + (local.z() < 0 ? -half_ : half_) * Vec3::UnitZ());
}

Vec3 ConvexBody::support(const Vec3& along) const {
  if (is_cylinder()) return of_cylinder(along, 0);
  int best = 0;
  double farthest = vertices_[0].dot(along);
  for (int k = 1; k < vertex_count_; ++k) {
    const double far = vertices_[k].dot(along);
    if (far > farthest) {
      farthest = far;
      best = k;
    }
  }
  return vertices_[best];
}

Vec3 ConvexBody::corner(const Vec3& along) const {
  return is_cylinder() ? of_cylinder(along, 1) : support(along);
}

Vec3 ConvexBody::edge(int e) const {
  if (kind_ == Kind::triangle) return vertices_[(e + 1) % 3] - vertices_[e];
  if (kind_ != Kind::polytope) return axes_.col(2);
  const Hull::Edge& edge = hull_->edges[static_cast<std::size_t>(e)];
  return vertices_[edge.to] - vertices_[edge.from];
}

const Vec3& ConvexBody::edge_start(int e) const {
  return kind_ == Kind::polytope ? vertices_[hull_->edges[static_cast<std::size_t>(e)].from] : vertices_[e];
}

/// Returns a cap as a polygon with its corners on the circle, one of them where the cap is farthest along the
/// direction.
Facing ConvexBody::cap_toward(const Vec3& along) const {
  const Vec3 local = axes_.transpose() * along;
  const double across = std::hypot(local.x(), local.y());
  const double start = across > tolerance::parallel_axes ? std::atan2(local.y(), local.x()) : 0.0;
  const double side = local.z() < 0 ? -1.0 : 1.0;
  Facing facing;
  for (int k = 0; k < disc_corners; ++k) {
    const double angle = start + side * k * (2 * pi / disc_corners);
    facing.add(centre_ + axes_ * Vec3(disc_ * std::cos(angle), disc_ * std::sin(angle), side * half_),
               side < 0 ? k : disc_corners + k);
  }
  return facing;
}

Facing ConvexBody::face_toward(const Vec3& along, int face) const {
  if (kind_ == Kind::cylinder) return cap_toward(along);
  Facing facing;
  if (kind_ == Kind::triangle) {
    for (const int k : face == 0 ? std::array{0, 1, 2} : std::array{0, 2, 1}) facing.add(vertices_[k], k);
    return facing;
  }
  for (const int v : hull_->corners_of(hull_->faces[static_cast<std::size_t>(face)]))
    facing.add(vertices_[v], v);
  return facing;
}

Facing ConvexBody::widest_toward(const Vec3& along) const {
  int best = -1;
  double most = 1 - tolerance::face_cosine;
  for (int f = 0; f < faces(); ++f) {
    const double cosine = normal(f).dot(along);
    // If several faces are equally close to the direction, the first is taken, whatever the noise.
    if (cosine > most + (best < 0 ? 0.0 : tolerance::same_feature)) {
      most = cosine;
      best = f;
    }
  }
  return best >= 0 && is_along(normal(best), along) ? face_toward(along, best) : edge_toward(along);
}

Facing ConvexBody::edge_toward(const Vec3& along) const {
  Facing facing;
  if (kind_ == Kind::cylinder) {
    const Vec3 at = support(along);
    const Vec3 axis = axes_.col(2);
    if (!is_across(axis, along)) {
      facing.add(at, 0);
      return facing;
    }
    const Vec3 rim = at - centre_ - axis.dot(at - centre_) * axis;
    facing.add(centre_ + rim - half_ * axis, 1);
    facing.add(centre_ + rim + half_ * axis, 2);
    return facing;
  }
  const Vec3 top = support(along);
  int best = -1;
  double least = tolerance::parallel_edges;
  for (int e = 0; e < edges(); ++e) {
    const int from = kind_ == Kind::polytope ? hull_->edges[static_cast<std::size_t>(e)].from : e;
    const int to = kind_ == Kind::polytope   ? hull_->edges[static_cast<std::size_t>(e)].to
                   : kind_ == Kind::triangle ? (e + 1) % 3
                                             : 1;
    const Vec3 way = vertices_[to] - vertices_[from];
    if (top != vertices_[from] && top != vertices_[to]) continue;
    const double slope = std::abs(way.dot(along)) / way.norm();
    if (slope <= least) {
      least = slope - tolerance::same_feature;
      best = e;
      facing.count = 0;
      facing.add(vertices_[from], from);
      facing.add(vertices_[to], to);
    }
  }
  if (best >= 0) return facing;
  for (int k = 0; k < vertex_count_; ++k)
    if (vertices_[k] == top) {
      facing.add(top, k);
      break;
    }
  return facing;
}

}  // namespace scree
