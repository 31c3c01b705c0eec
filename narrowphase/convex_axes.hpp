// The directions that can part two convex bodies, and the one that does best.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/convex_body.hpp"

namespace scree {

/// A unit direction from the first body to the second, and how far apart they are along it.
struct ConvexAxis {
  Vec3 normal = Vec3::Zero();
  double separation = -HUGE_VAL;  ///< m; negative: overlap
  int owner = -1;                 ///< whose face's normal it is, 0 or 1; -1: no face's
  int face = 0;
};

namespace detail {

/// Edges of which one at least has no faces beside it: both ways along their common normal.
template <class Visit>
bool visit_free_edges(const ConvexBody& a, const ConvexBody& b, Visit& visit) {
  for (int e = 0; e < a.edges(); ++e) {
    for (int f = 0; f < b.edges(); ++f) {
      const Vec3 along_a = a.edge(e), along_b = b.edge(f);
      const Vec3 normal = along_a.cross(along_b);
      const double length = normal.norm();
      if (!(length > tolerance::parallel_axes * along_a.norm() * along_b.norm())) continue;
      for (const double side : {-1.0, 1.0}) {
        const Vec3 direction = side / length * normal;
        if (!visit(ConvexAxis{direction, separation_along(a, b, direction)})) return false;
      }
    }
  }
  return true;
}

/// The edges of a body with those of a polytope. An edge of the polytope is what faces a direction if that
/// lies on the arc between the normals of its faces, and only where the arc passes the great circle at right
/// angles to the other edge can the two part the bodies; where the first body is a polytope too, its own arc
/// must pass there (the arcs cross: Gregorius 2013, "The separating axis test between convex polyhedra").
template <class Visit>
bool visit_polytope_edges(const ConvexBody& a, const ConvexBody& b, Visit& visit) {
  double toward[ConvexBody::most_faces];  // of b's normals, along an edge of a
  for (int e = 0; e < a.edges(); ++e) {
    const Vec3 along_a = a.edge(e);
    for (int f = 0; f < b.faces(); ++f) toward[f] = b.normal(f).dot(along_a);
    for (int f = 0; f < b.edges(); ++f) {
      const auto [left, right] = b.faces_at(f);
      if (!(toward[left] * toward[right] < 0)) continue;
      const Vec3 along_b = b.edge(f);
      if (a.is_polytope()) {
        const auto [left_a, right_a] = a.faces_at(e);
        const double to_left = a.normal(left_a).dot(along_b), to_right = a.normal(right_a).dot(along_b);
        if (!(to_left * to_right < 0 && toward[left] * to_right < 0)) continue;
      }
      Vec3 normal = along_a.cross(along_b);
      const double length = normal.norm();
      if (!(length > tolerance::parallel_axes * along_a.norm() * along_b.norm())) continue;
      normal /= (normal.dot(b.normal(left) + b.normal(right)) < 0 ? 1 : -1) * length;
      const double separation = normal.dot(b.edge_start(f)) - b.radius() - a.reach(normal);
      if (!visit(ConvexAxis{normal, separation})) return false;
    }
  }
  return true;
}

}  // namespace detail

/// Calls visit(axis) with each face's normal and each common normal of two edges, until it returns false. For
/// polytopes that overlap the best of them is the best of all directions.
template <class Visit>
bool visit_faces(const ConvexBody& a, const ConvexBody& b, Visit&& visit) {
  for (int f = 0; f < a.faces(); ++f) {
    const Vec3 normal = a.normal(f);
    if (!visit(ConvexAxis{normal, separation_along(a, b, normal), 0, f})) return false;
  }
  for (int f = 0; f < b.faces(); ++f) {
    const Vec3 normal = -b.normal(f);
    if (!visit(ConvexAxis{normal, separation_along(a, b, normal), 1, f})) return false;
  }
  return true;
}
template <class Visit>
bool visit_edges(const ConvexBody& a, const ConvexBody& b, Visit&& visit) {
  if (b.is_polytope()) return detail::visit_polytope_edges(a, b, visit);
  if (!a.is_polytope()) return detail::visit_free_edges(a, b, visit);
  const auto turned = [&](const ConvexAxis& axis) {
    return visit(ConvexAxis{-axis.normal, axis.separation});
  };
  return detail::visit_polytope_edges(b, a, turned);
}

/// From an axis to one that parts the bodies more: they are moved apart along it, until the nearest points
/// tell a direction, which cannot part them less. It ends where that is the same.
ConvexAxis ascend(const ConvexBody& a, const ConvexBody& b, const ConvexAxis& from, double size);

/// What the search for the best axis has found.
struct ConvexAxes {
  ConvexAxis face;  ///< the best of the faces; owner -1 if there are none
  ConvexAxis best;  ///< of all directions
};

/// False if the bodies are farther apart than `margin` (m). `size`: what tolerances are relative to (m).
bool best_axes(const ConvexBody& a, const ConvexBody& b, double margin, double size, ConvexAxes& out);

}  // namespace scree
