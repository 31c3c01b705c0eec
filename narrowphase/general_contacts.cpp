#include "narrowphase/general_contacts.hpp"

#include "core/tolerances.hpp"
#include "narrowphase/convex_axes.hpp"
#include "narrowphase/convex_manifold.hpp"
#include "narrowphase/mesh_contacts.hpp"

#include <algorithm>

namespace scree {

namespace {

/// Finds the contact of a body with the half space below a plane: all corners within the margin; for a
/// cylinder, the corners of the feature that faces the plane.
bool convex_plane(const ConvexBody& body, const Solid& plane, const Vec3& origin, double margin,
                  Manifold& out) {
  const Vec3 up = plane.orientation * Vec3::UnitZ();
  const double height = up.dot(plane.position - origin);
  const double slack = tolerance::same_feature * body.size();
  SharedPoints shared;
  const auto add = [&](const Vec3& at, int name) {
    const double gap = up.dot(at) - height - body.radius();
    if (gap <= margin)
      shared.add({SharedPoint::Kind::corner_of_a, name, -1, at - (body.radius() + 0.5 * gap) * up, gap});
  };
  if (body.is_cylinder()) {
    const Facing facing = body.widest_toward(-up);
    for (const Corner& c : facing.corners()) add(c.at, c.name);
  } else {
    int name = 0;
    for (const Vec3& v : body.vertices()) add(v, name++);
  }
  return take_points(shared, -up, origin, margin, slack, out);
}

bool sphere_capsule(const Solid& sphere, const Solid& capsule, double margin, Manifold& out) {
  const Vec3 axis = capsule.orientation * Vec3::UnitZ();
  const Vec3 offset = sphere.position - capsule.position;
  const double half = capsule.size.z() - capsule.size.x();
  const Vec3 across = offset - std::clamp(axis.dot(offset), -half, half) * axis;
  const double distance = across.norm();
  const double gap = distance - sphere.size.x() - capsule.size.x();
  if (gap > margin) return false;
  const Vec3 outward = distance > 0 ? Vec3(across / distance) : tangent_of(axis);
  out.part = 0;
  set_single(out, -outward, {sphere.position - (sphere.size.x() + 0.5 * gap) * outward, gap, only_feature});
  return true;
}

bool convex_convex(const ConvexBody& a, const ConvexBody& b, const Vec3& origin, double margin,
                   Manifold& out) {
  const double size = std::min(a.size(), b.size());
  ConvexAxes axes;
  return best_axes(a, b, margin, size, axes) && contact_along(a, b, axes, margin, size, origin, out);
}

/// Finds the contact of two shapes that are in the order of Shape.
bool ordered(const ShapedSolid& a, const ShapeData* data_a, const ShapedSolid& b, const ShapeData* data_b,
             const ContactReach& reach, Manifold& out) {
  if (b.shape == Shape::triangle) {
    if (a.shape == Shape::sphere) return sphere_triangle(a.solid, b.solid, *data_b->surroundings, reach, out);
    return convex_triangle(a, data_a, b.solid, *data_b->surroundings, reach, out);
  }
  if (a.shape == Shape::triangle) {
    if (!convex_triangle(b, data_b, a.solid, *data_a->surroundings, reach, out)) return false;
    out.normal = -out.normal;
    return true;
  }
  if (a.shape == Shape::sphere && b.shape == Shape::capsule)
    return sphere_capsule(a.solid, b.solid, reach.margin, out);
  const Vec3 origin = is_boundary(a.shape) ? b.solid.position : a.solid.position;
  if (a.shape == Shape::plane) {
    if (!convex_plane(ConvexBody(b, data_b, origin), a.solid, origin, reach.margin, out)) return false;
    out.normal = -out.normal;
    return true;
  }
  return convex_convex(ConvexBody(a, data_a, origin), ConvexBody(b, data_b, origin), origin, reach.margin,
                       out);
}

}  // namespace

int find_general_contacts(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes,
                          const ContactReach& reach, Manifold* out) {
  if (is_surface(a.shape) && is_surface(b.shape)) return 0;
  if (a.shape <= b.shape) return ordered(a, shapes.a, b, shapes.b, reach, *out) ? 1 : 0;
  if (!ordered(b, shapes.b, a, shapes.a, reach, *out)) return 0;
  out->normal = -out->normal;
  return 1;
}

}  // namespace scree
