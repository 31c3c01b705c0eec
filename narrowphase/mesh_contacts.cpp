#include "narrowphase/mesh_contacts.hpp"

#include "core/tolerances.hpp"
#include "narrowphase/box_pair.hpp"
#include "narrowphase/convex_axes.hpp"
#include "narrowphase/convex_manifold.hpp"
#include "narrowphase/gjk.hpp"

#include <algorithm>
#include <array>

namespace scree {

namespace {

/// A part of a triangle: its face, an edge or a corner.
struct Part {
  enum class Kind { face, edge, corner } kind;
  int index;
};

/// The surroundings of a triangle in its mesh, queried with vectors in world axes.
struct Neighbourhood {
  const Surroundings& around;
  Mat3 axes;
  double side;  ///< side of the triangle on which the body is: 1 in front of it, -1 behind it

  Vec3 normal() const { return side * axes.col(2); }
  const Surroundings::Feature& feature(const Part& part) const {
    const auto k = static_cast<std::size_t>(part.index);
    return part.kind == Part::Kind::edge ? around.edges[k] : around.vertices[k];
  }
  /// Returns how far a unit normal is outside the cone of an edge or a corner; it counts as inside up to
  /// cone_slack.
  double beyond(const Part& part, const Vec3& n) const {
    const Vec3 local = axes.transpose() * n;
    double most = -HUGE_VAL;
    for (const Vec3& d : around.directions_of(feature(part))) most = std::max(most, local.dot(d));
    return most;
  }
  bool holds(const Part& part, const Vec3& n) const {
    return part.kind == Part::Kind::face ? n.dot(normal()) >= 1 - tolerance::cone_slack
                                         : beyond(part, n) <= tolerance::cone_slack;
  }
  bool owns(const Part& part) const { return part.kind == Part::Kind::face || feature(part).owned; }

  /// Returns whether the mesh ends at an edge.
  bool is_border(int edge) const { return around.edges[static_cast<std::size_t>(edge)].count == 1; }
  /// Returns whether the mesh ends or bends away from the face at an edge or a corner, so that the edge or
  /// corner bounds the region of contact on the face.
  bool is_sharp(const Part& part) const {
    const Vec3 up(0, 0, side);
    const Surroundings::Feature& f = feature(part);
    bool bends =
        is_border(part.index) || (part.kind == Part::Kind::corner && is_border((part.index + 2) % 3));
    for (const Vec3& d : around.directions_of(f)) {
      if (d.dot(up) > tolerance::cone_slack) return false;
      bends = bends || d.dot(up) < -tolerance::cone_slack;
    }
    return bends;
  }
  bool is_flat(int edge) const {
    const Surroundings::Feature& f = around.edges[static_cast<std::size_t>(edge)];
    return f.count > 1 && std::ranges::all_of(around.directions_of(f), [](const Vec3& d) {
             return std::abs(d.z()) <= tolerance::cone_slack;
           });
  }
};

/// Finds the point of a triangle nearest to another point (Ericson 2005, section 5.1.5), in the triangle's
/// frame, and returns the part of the triangle that it is on.
Part nearest_part(const Vec3& size, const Vec3& point, Vec3& nearest) {
  const std::array<Vec3, 3> corner = {triangle_corner(size, 0), triangle_corner(size, 1),
                                      triangle_corner(size, 2)};
  const auto inside = [&](std::size_t k) {
    const Vec3 way = corner[(k + 1) % 3] - corner[k], to = point - corner[k];
    return way.x() * to.y() - way.y() * to.x();
  };
  // A point that is over an edge or a corner up to rounding counts as such for all triangles there, of which
  // one owns the edge or corner.
  constexpr double rounding = tolerance::touching_gap;
  const double slack = rounding * 4 * size.x() * size.x();
  if (inside(0) > slack && inside(1) > slack && inside(2) > slack) {
    nearest = {point.x(), point.y(), 0};
    return {Part::Kind::face, 0};
  }
  Part part{};
  double least = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &from = corner[static_cast<std::size_t>(k)],
               &to = corner[static_cast<std::size_t>((k + 1) % 3)];
    const double share = (to - from).dot(point - from) / (to - from).squaredNorm();
    const bool at_from = share <= rounding, at_to = share >= 1 - rounding;
    const Vec3 at = at_from ? from : at_to ? to : Vec3(from + share * (to - from));
    const double square = (at - point).squaredNorm();
    if (square >= least) continue;
    least = square;
    nearest = at;
    part = at_from ? Part{Part::Kind::corner, k}
           : at_to ? Part{Part::Kind::corner, (k + 1) % 3}
                   : Part{Part::Kind::edge, k};
  }
  return part;
}

}  // namespace

bool sphere_triangle(const Solid& sphere, const Solid& triangle, const Surroundings& around,
                     const ContactReach& reach, Manifold& out) {
  const double radius = sphere.size.x();
  const Mat3 axes = triangle.orientation.toRotationMatrix();
  const Vec3 centre = axes.transpose() * (sphere.position - triangle.position);
  if (std::abs(centre.z()) - radius > reach.margin) return false;
  const Neighbourhood mesh{around, axes, sign_of(centre.z())};
  Vec3 nearest;
  const Part part = nearest_part(triangle.size, centre, nearest);
  const double distance = part.kind == Part::Kind::face ? std::abs(centre.z()) : (centre - nearest).norm();
  const double gap = distance - radius;
  if (gap > reach.margin) return false;
  const Vec3 up = part.kind == Part::Kind::face || !(distance > 0)
                      ? mesh.normal()
                      : Vec3(axes * ((centre - nearest) / distance));
  const bool touches = mesh.owns(part) && mesh.holds(part, up);
  if (!touches && !reach.hidden) return false;
  out.part = touches ? 0 : hidden_part;
  set_single(out, -up, {sphere.position - 0.5 * (radius + distance) * up, gap, only_feature});
  out.at_edge = part.kind != Part::Kind::face;
  return true;
}

namespace {

/// A convex body and a triangle, with positions relative to the triangle's middle.
class TrianglePair {
 public:
  TrianglePair(const ShapedSolid& body, const ShapeData* data, const Solid& triangle,
               const Surroundings& around, const ContactReach& reach)
      : origin_(triangle.position),
        body_(body, data, origin_),
        triangle_({Shape::triangle, triangle}, nullptr, origin_),
        mesh_{around, triangle_.axes(), sign_of(triangle_.axes().col(2).dot(body_.centre()))},
        reach_(reach),
        size_(body_.size()),
        slack_(tolerance::same_feature * size_) {}

  bool find(Manifold& out) {
    // The normals in this class point from the triangle to the body, and are reversed at the end.
    if (!search()) return false;
    const bool of_face = !clearly_better(allowed_.separation, face_.separation, size_);
    const bool found =
        of_face ? face_contact(out) || edge_contact(out) : edge_contact(out) || face_contact(out);
    if (!found && !(reach_.hidden && hidden_contact(out))) return false;
    out.normal = -out.normal;
    return true;
  }

 private:
  /// Finds the best directions. Returns false if one of them separates the two by more than the margin.
  bool search() {
    const Vec3 up = mesh_.normal();
    face_ = {up, separation_along(triangle_, body_, up), 0, mesh_.side > 0 ? 0 : 1};
    if (face_.separation > reach_.margin) return false;
    const ClosestPoints near = closest_points(triangle_, body_, Vec3::Zero(), tolerance::overlapping * size_,
                                              reach_.margin + body_.radius());
    if (near.apart && near.distance - body_.radius() > reach_.margin) return false;
    any_ = allowed_ = face_;
    const auto take = [&](const ConvexAxis& axis) {
      if (axis.separation > any_.separation) any_ = axis;
      if (axis.separation > allowed_.separation && is_allowed(axis.normal)) allowed_ = axis;
      return axis.separation <= reach_.margin;
    };
    const auto take_faces = [&](const ConvexAxis& axis) { return axis.owner == 0 || take(axis); };
    if (!visit_faces(triangle_, body_, take_faces)) return false;
    if (near.apart && near.distance > tolerance::clear_gap * size_)
      return take({near.normal, near.distance - body_.radius()});
    if (!visit_edges(triangle_, body_, take)) return false;
    if (body_.is_cylinder() && !take(ascend(triangle_, body_, any_, size_))) return false;
    if (near.apart && near.distance - body_.radius() > any_.separation + tolerance::touching_gap * size_)
      take({near.normal, near.distance - body_.radius()});
    return any_.separation <= reach_.margin;
  }

  /// Returns the part of the triangle that is farthest along a direction.
  Part part_toward(const Vec3& along) const {
    double height[3];
    for (int k = 0; k < 3; ++k) height[k] = triangle_.vertices()[static_cast<std::size_t>(k)].dot(along);
    const double top = std::max({height[0], height[1], height[2]});
    const double level = top - slack_;
    const bool at[3] = {height[0] >= level, height[1] >= level, height[2] >= level};
    if (at[0] && at[1] && at[2]) return {Part::Kind::face, 0};
    for (int k = 0; k < 3; ++k)
      if (at[k] && at[(k + 1) % 3]) return {Part::Kind::edge, k};
    return {Part::Kind::corner, at[0] ? 0 : at[1] ? 1 : 2};
  }

  bool is_allowed(const Vec3& normal) const {
    const Part part = part_toward(normal);
    return part.kind != Part::Kind::face && mesh_.holds(part, normal);
  }

  /// Finds the contact on the face. Its points are corners of the body that are over the face and, where the
  /// mesh ends or bends away, points on the edges and corners of the face.
  bool face_contact(Manifold& out) {
    SharedPoints shared;
    share_face(triangle_.face_toward(face_.normal, face_.face), face_.normal,
               body_.widest_toward(-face_.normal), true, radii_, slack_, shared);
    SharedPoints kept;
    for (int k = 0; k < shared.count; ++k)
      if (counts_on_face(shared.point[k])) kept.add(shared.point[k]);
    return take_points(kept, face_.normal, origin_, reach_.margin, slack_, out);
  }

  bool counts_on_face(const SharedPoint& p) const {
    using Kind = SharedPoint::Kind;
    if (p.kind == Kind::corner_of_a) return mesh_.is_sharp({Part::Kind::corner, p.name_a});
    if (p.kind == Kind::crossing) return mesh_.is_sharp({Part::Kind::edge, edge_from(p.name_a)});
    // A point at a flat edge counts only on the face of that edge's owner, unless the body ends at the edge:
    // then a plane along the body's side separates it from the triangle beyond. `ends` is twice the gap that
    // counts as closed, so that no point falls between the two rules.
    const double ends = 2 * tolerance::closed_gap * size_;
    for (int k = 0; k < 3; ++k) {
      const Vec3& from = triangle_.vertices()[static_cast<std::size_t>(k)];
      const Vec3 way = triangle_.vertices()[static_cast<std::size_t>((k + 1) % 3)] - from;
      const Vec3 inward = triangle_.axes().col(2).cross(way).normalized();
      if (!mesh_.around.edges[static_cast<std::size_t>(k)].owned && mesh_.is_flat(k) &&
          inward.dot(p.position - from) <= slack_ && body_.reach(-inward) + inward.dot(from) > ends)
        return false;
    }
    return true;
  }

  /// Returns the edge that begins at a corner, in counterclockwise order as the face is seen from the body.
  int edge_from(int corner) const { return mesh_.side > 0 ? corner : (corner + 2) % 3; }

  /// Finds the contact on an edge or a corner of the mesh, along the best of the directions in its cone.
  bool edge_contact(Manifold& out) {
    // If another direction shows the bodies to be farther apart, they do not touch at this edge or corner.
    const bool elsewhere = any_.separation > 0 ? any_.separation > allowed_.separation + slack_
                                               : clearly_better(any_.separation, allowed_.separation, size_);
    if (allowed_.normal == face_.normal || elsewhere) return false;
    const Part part = part_toward(allowed_.normal);
    if (!mesh_.owns(part)) return false;
    Facing own;
    own.add(corner(part.index), part.index);
    if (part.kind == Part::Kind::edge) own.add(corner((part.index + 1) % 3), (part.index + 1) % 3);
    const Vec3 normal = allowed_.normal;
    SharedPoints shared;
    if (allowed_.owner == 1)
      share_face(body_.face_toward(-normal, allowed_.face), -normal, own, false, radii_, slack_, shared);
    if (shared.count == 0) share_edges(own, body_.edge_toward(-normal), normal, radii_, shared);
    for (int k = 0; k < shared.count; ++k)
      shared.point[k].gap = std::max(shared.point[k].gap, allowed_.separation);
    return take_points(shared, normal, origin_, reach_.margin, slack_, out);
  }

  bool hidden_contact(Manifold& out) const {
    const Vec3 at = body_.support(-any_.normal) - (body_.radius() + 0.5 * any_.separation) * any_.normal;
    out.part = hidden_part;
    set_single(out, any_.normal, {origin_ + at, any_.separation, only_feature});
    return true;
  }

  const Vec3& corner(int k) const { return triangle_.vertices()[static_cast<std::size_t>(k)]; }

  Vec3 origin_;
  ConvexBody body_, triangle_;
  Neighbourhood mesh_;
  ContactReach reach_;
  double size_, slack_;
  double radii_[2] = {0, body_.radius()};
  ConvexAxis face_, allowed_, any_;
};

}  // namespace

bool convex_triangle(const ShapedSolid& body, const ShapeData* data, const Solid& triangle,
                     const Surroundings& around, const ContactReach& reach, Manifold& out) {
  return TrianglePair(body, data, triangle, around, reach).find(out);
}

}  // namespace scree
