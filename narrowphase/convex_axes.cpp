#include "narrowphase/convex_axes.hpp"

#include "core/tolerances.hpp"
#include "narrowphase/gjk.hpp"

namespace scree {

namespace {

ConvexAxis centre_axis(const ConvexBody& a, const ConvexBody& b) {
  Vec3 direction = b.centre() - a.centre();
  direction = direction.isZero(0) ? Vec3(Vec3::UnitX()) : Vec3(direction.stableNormalized());
  return {direction, separation_along(a, b, direction)};
}

/// Calls visit() with the directions at right angles to each body's own z axis (of a cylinder, its axis) that
/// point toward the other body's centre and away from it.
template <class Visit>
bool visit_radial(const ConvexBody& a, const ConvexBody& b, Visit& visit) {
  const Vec3 offset = b.centre() - a.centre();
  for (const ConvexBody* body : {&a, &b}) {
    const Vec3 axis = body->axes().col(2);
    const Vec3 across = offset - axis.dot(offset) * axis;
    // If the offset is along the axis, all directions at right angles to it are equivalent.
    const Vec3 outward = across.isZero(0) ? tangent_of(axis) : Vec3(across.stableNormalized());
    for (const double side : {-1.0, 1.0}) {
      const Vec3 direction = side * outward;
      if (!visit(ConvexAxis{direction, separation_along(a, b, direction)})) return false;
    }
  }
  return true;
}

}  // namespace

ConvexAxis ascend(const ConvexBody& a, const ConvexBody& b, const ConvexAxis& from, double size) {
  constexpr int most_steps = 32;
  ConvexAxis best = from;
  for (int step = 0; step < most_steps; ++step) {
    const double cores = best.separation + a.radius() + b.radius();
    const double shift = std::max(tolerance::clear_distance * size - cores, 0.0);
    const ClosestPoints near = closest_points(a, b, shift * best.normal, tolerance::overlapping * size);
    if (!near.apart) break;
    const double separation = separation_along(a, b, near.normal);
    if (!(separation > best.separation)) break;
    const bool settled = separation - best.separation <= tolerance::touching_gap * size;
    best = {near.normal, separation};
    if (settled) break;
  }
  return best;
}

bool best_axes(const ConvexBody& a, const ConvexBody& b, double margin, double size, ConvexAxes& out) {
  out = {};
  const double radii = a.radius() + b.radius();
  const ClosestPoints near =
      closest_points(a, b, Vec3::Zero(), tolerance::overlapping * size, margin + radii);
  if (near.apart && near.distance - radii > margin) return false;
  const auto take = [&](const ConvexAxis& axis) {
    if (axis.separation > out.best.separation) out.best = axis;
    return axis.separation <= margin;
  };
  const auto take_face = [&](const ConvexAxis& axis) {
    if (axis.separation > out.face.separation) out.face = axis;
    return take(axis);
  };
  if (!visit_faces(a, b, take_face)) return false;
  // From this distance on, the nearest points give the direction to rounding, and no other axis is needed.
  const bool clear = near.apart && near.distance > tolerance::clear_gap * size;
  if (clear) return take({near.normal, near.distance - radii});
  const bool round = a.is_cylinder() || b.is_cylinder();
  if (!visit_edges(a, b, take)) return false;
  if (out.best.separation == -HUGE_VAL || round) take(centre_axis(a, b));
  const double rounding = tolerance::touching_gap * size;
  if (round) {
    ConvexAxis first = ascend(a, b, out.best, size);
    if (near.apart) {
      // At so small a distance the direction of the nearest points has few digits, but the ascent may have
      // ended at another local maximum.
      const ConvexAxis seen{near.normal, separation_along(a, b, near.normal)};
      if (seen.separation > first.separation + tolerance::same_feature * size)
        first = ascend(a, b, seen, size);
    }
    if (!take(first)) return false;
    if (first.separation > -tolerance::shallow_overlap * size) return true;
    // If bodies overlap deeply, there are several directions that are better than all around them; the ascent
    // starts from each candidate.
    const auto climb = [&](const ConvexAxis& axis) { return take(ascend(a, b, axis, size)); };
    return visit_faces(a, b, climb) && visit_edges(a, b, climb) && visit_radial(a, b, climb);
  }
  if (near.apart && near.distance - radii > out.best.separation + rounding)
    return take({near.normal, near.distance - radii});
  return out.best.separation <= margin;
}

}  // namespace scree
