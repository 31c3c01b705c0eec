// The directions that can separate two convex bodies, and the search for the best one.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/convex_body.hpp"

namespace scree {

/// A unit direction from the first body to the second, and the separation of the bodies along it.
struct ConvexAxis {
  Vec3 normal = Vec3::Zero();
  double separation = -HUGE_VAL;  ///< separation (m); negative: overlap
  int owner = -1;                 ///< owner of the face with this normal, 0 or 1; -1: not a face's normal
  int face = 0;
};

namespace detail {

/// Calls visit() with both directions along the common normal of each pair of edges, for two bodies that are
/// no polytopes: their edges have no adjacent faces by which a pair could be ruled out.
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

/// Calls visit() with the common normals of the edges of a body and those of a polytope. An edge of the
/// polytope faces a direction if the direction lies on the arc between the normals of its two faces. The two
/// edges can separate the bodies only where this arc crosses the great circle at right angles to the other
/// edge. If the first body is a polytope too, its own arc must cross there as well (the arcs cross: Gregorius
/// 2013, "The separating axis test between convex polyhedra").
template <class Visit>
bool visit_polytope_edges(const ConvexBody& a, const ConvexBody& b, Visit& visit) {
  double toward[ConvexBody::most_faces];  // components of b's normals along an edge of a
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

/// Calls visit(axis) with each face's normal (visit_faces) and each common normal of two edges (visit_edges),
/// until it returns false. For polytopes that overlap, the best of these axes is the best of all directions.
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

/// Climbs from an axis to one that separates the bodies more. The bodies are moved apart along the axis until
/// their nearest points give a direction, which cannot separate them less. The climb ends where the
/// separation no longer grows.
ConvexAxis ascend(const ConvexBody& a, const ConvexBody& b, const ConvexAxis& from, double size);

/// The result of the search for the best axis.
struct ConvexAxes {
  ConvexAxis face;  ///< best axis of the faces; owner -1 if there are no faces
  ConvexAxis best;  ///< best axis of all directions
};

/// Finds the best axes. Returns false if the bodies are farther apart than `margin` (m). `size` is the length
/// to which tolerances are relative (m).
bool best_axes(const ConvexBody& a, const ConvexBody& b, double margin, double size, ConvexAxes& out);

}  // namespace scree
