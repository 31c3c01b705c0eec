// The contact of two box edges: edges that cross, and the closest edges of boxes that face each other with
// edges or vertices.
#pragma once

#include "narrowphase/box_pair.hpp"

namespace scree {

namespace detail {

/// An edge of a box, relative to the first box's centre (world axes, m).
struct BoxEdge {
  Vec3 centre;
  Vec3 direction;  ///< unit vector
  double half;
  int axis;
  BoxFeature feature;
};

/// Returns the edge of a box that is parallel to `axis`, on the given sides of the two axes that follow it.
SCREE_HD inline BoxEdge box_edge(const BoxPair& pair, int box, int axis, double side1, double side2) {
  const int k1 = (axis + 1) % 3, k2 = (axis + 2) % 3;
  BoxEdge edge;
  edge.centre = side1 * pair.half[box][k1] * pair.axes[box].col(k1) +
                side2 * pair.half[box][k2] * pair.axes[box].col(k2);
  if (box == 1) edge.centre += pair.offset;
  edge.direction = pair.axes[box].col(axis);
  edge.half = pair.half[box][axis];
  edge.axis = axis;
  edge.feature = box_side(k1, side1) | box_side(k2, side2);
  return edge;
}

/// Returns edge e of the 12 edges of a box.
SCREE_HD inline BoxEdge box_edge(const BoxPair& pair, int box, int e) {
  return box_edge(pair, box, e % 3, e / 3 & 1 ? 1.0 : -1.0, e / 3 & 2 ? 1.0 : -1.0);
}

/// The place where two edges are closest: a coordinate along each edge, measured from its centre (m).
struct Closest {
  double along[2];
};

SCREE_HD inline double clamp_to(double x, double limit) { return fmax(-limit, fmin(limit, x)); }

/// Returns the closest points of two segments. It takes the closest points of their lines, clamps one to its
/// segment, and adjusts and clamps the other to match.
SCREE_HD inline Closest closest_points(const BoxEdge& a, const BoxEdge& b) {
  const Vec3 offset = b.centre - a.centre;
  const double cosine = a.direction.dot(b.direction);
  const double on_a = a.direction.dot(offset), on_b = b.direction.dot(offset);
  const double sine2 = a.direction.cross(b.direction).squaredNorm();
  const bool parallel = sine2 < tolerance::parallel_axes * tolerance::parallel_axes;
  const double s = parallel ? 0.0 : clamp_to((on_a - cosine * on_b) / sine2, a.half);
  const double t = clamp_to(cosine * s - on_b, b.half);
  return {{clamp_to(on_a + cosine * t, a.half), t}};
}

SCREE_HD inline Vec3 point_on(const BoxEdge& edge, double along) {
  return edge.centre + along * edge.direction;
}

/// Returns the feature at a coordinate along an edge: the edge itself, or a vertex if the coordinate is at an
/// end.
SCREE_HD inline BoxFeature feature_at(const BoxEdge& edge, double along) {
  return fabs(along) < edge.half ? edge.feature : edge.feature | box_side(edge.axis, along);
}

/// Returns the point midway between two points, each given relative to the first box's centre. The sum is
/// formed from each box's own position, so that it is the same if the bodies are swapped.
SCREE_HD inline Vec3 midpoint(const BoxPair& pair, const Vec3& on_a, const Vec3& on_b) {
  return 0.5 * ((pair.position[0] + on_a) + (pair.position[1] + (on_b - pair.offset)));
}

}  // namespace detail

/// Finds the contact of the two edges that meet along `axis`, which must be an axis of edges. Returns false
/// if the boxes are apart and the lines of the edges are closest outside the edges: then these edges are not
/// the closest features.
SCREE_HD inline bool edge_contact(const BoxPair& pair, const BoxAxis& axis, Manifold& out) {
  const int i = axis.index[0], j = axis.index[1];
  const Vec3 normal = normal_of(pair, axis);
  const auto edge_toward = [&pair](int box, int k, const Vec3& to) {
    return detail::box_edge(pair, box, k, sign_of(to.dot(pair.axes[box].col((k + 1) % 3))),
                            sign_of(to.dot(pair.axes[box].col((k + 2) % 3))));
  };
  const detail::BoxEdge a = edge_toward(0, i, normal), b = edge_toward(1, j, -normal);
  const detail::Closest closest = detail::closest_points(a, b);
  const bool at_end = fabs(closest.along[0]) >= a.half || fabs(closest.along[1]) >= b.half;
  if (at_end && axis.separation > 0.0) return false;
  set_single(
      out, normal,
      {detail::midpoint(pair, detail::point_on(a, closest.along[0]), detail::point_on(b, closest.along[1])),
       axis.separation, contact_feature(a.feature, b.feature)});
  return true;
}

namespace detail {

/// Returns which of the 12 edges of a box may come within `margin` of the other box, one bit for each edge.
/// If the other box's best face separates the boxes, the edges farther than the margin from that face are
/// left out.
SCREE_HD inline std::uint32_t edges_within(const BoxPair& pair, const BoxAxes& axes, int box, double margin) {
  const BoxAxis& face = axes.face[1 - box];
  constexpr std::uint32_t all = (1u << 12) - 1;
  if (!(face.separation > 0.0)) return all;
  const Vec3 normal = (box == 0 ? -1.0 : 1.0) * normal_of(pair, face);  // from the other box to this one
  const Vec3 slope = (pair.axes[box].transpose() * normal).cwiseProduct(pair.half[box]);
  const double lowest = -slope.cwiseAbs().sum();
  // The last term keeps the edges whose distance equals the margin but for rounding.
  const double most = lowest - face.separation + margin + tolerance::same_feature * pair.smallest;
  std::uint32_t within = 0;
  for (int e = 0; e < 12; ++e) {
    const int k = e % 3;
    const double of_sides = (e / 3 & 1 ? slope[(k + 1) % 3] : -slope[(k + 1) % 3]) +
                            (e / 3 & 2 ? slope[(k + 2) % 3] : -slope[(k + 2) % 3]);
    if (of_sides - fabs(slope[k]) <= most) within |= 1u << e;
  }
  return within;
}

}  // namespace detail

/// Finds the contact of boxes that are apart or just touch, and have no face over the other: the closest
/// points of their edges.
SCREE_HD inline bool closest_edges(const BoxPair& pair, const BoxAxes& axes, double margin, Manifold& out) {
  const BoxAxis& face = axes.better_face();
  const int box = face.box, other = 1 - box;
  // If a face separates the boxes, its owner is wholly behind it and the other box wholly in front of it, so
  // the closest point of the owner is on one of the 4 edges of the face.
  const double front = (box == 0 ? 1.0 : -1.0) * normal_of(pair, face).dot(pair.axes[box].col(face.index[0]));
  const BoxFeature candidates = face.separation > 0.0 ? box_side(face.index[0], front) : ~BoxFeature{0};
  const std::uint32_t own_within = detail::edges_within(pair, axes, box, margin);
  const std::uint32_t other_within = detail::edges_within(pair, axes, other, margin);

  double best = HUGE_VAL;
  detail::BoxEdge best_edge[2];
  detail::Closest best_at{};
  for (int e = 0; e < 12; ++e) {
    if ((own_within >> e & 1) == 0) continue;
    const detail::BoxEdge own = detail::box_edge(pair, box, e);
    if (!(own.feature & candidates)) continue;
    for (int f = 0; f < 12; ++f) {
      if ((other_within >> f & 1) == 0) continue;
      const detail::BoxEdge edge = detail::box_edge(pair, other, f);
      const detail::Closest at = detail::closest_points(own, edge);
      const Vec3 apart = point_on(edge, at.along[1]) - point_on(own, at.along[0]);
      if (apart.squaredNorm() >= best) continue;
      best = apart.squaredNorm();
      best_edge[box] = own;
      best_edge[other] = edge;
      best_at.along[box] = at.along[0];
      best_at.along[other] = at.along[1];
    }
  }
  const double gap = sqrt(best);
  if (gap > margin) return false;
  const Vec3 on_a = point_on(best_edge[0], best_at.along[0]);
  const Vec3 on_b = point_on(best_edge[1], best_at.along[1]);
  // Between boxes that almost touch, the closest points give no direction; the normal of the best axis is
  // then as good.
  const Vec3 normal = gap > tolerance::same_feature * pair.smallest
                          ? Vec3((on_b - on_a) / gap)
                          : normal_of(pair, axes.edges.separation > face.separation ? axes.edges : face);
  set_single(out, normal,
             {detail::midpoint(pair, on_a, on_b), gap,
              contact_feature(detail::feature_at(best_edge[0], best_at.along[0]),
                              detail::feature_at(best_edge[1], best_at.along[1]))});
  return true;
}

}  // namespace scree
