// The contact of two boxes: first the axis that separates them best is found, then the contact along it.
#pragma once

#include "narrowphase/box_edges.hpp"
#include "narrowphase/box_face.hpp"
#include "narrowphase/box_pair.hpp"

namespace scree {

namespace detail {

SCREE_HD inline double smallest_gap(const Manifold& manifold) {
  double gap = manifold.points[0].gap;
  for (int k = 1; k < manifold.count; ++k) gap = fmin(gap, manifold.points[k].gap);
  return gap;
}

/// Returns whether the boxes overlap by less than the margin along the normals of two faces, as they do at an
/// edge or a corner.
SCREE_HD inline bool is_at_edge(const BoxPair& pair, const BoxAxes& axes, double margin) {
  if (axes.next_face >= -margin) return true;
  const double cosine = fabs(pair.rotation(axes.face[0].index[0], axes.face[1].index[0]));
  return fmin(axes.face[0].separation, axes.face[1].separation) >= -margin &&
         cosine < 1.0 - tolerance::face_cosine;
}

/// Adds to a contact of one point the points within the margin that lie over the face that separates the
/// boxes better. Boxes that lie nearly flat on one another touch at one point, where two edges cross, and
/// rotate about it: within a substep they meet at the other end of these edges. All points share the normal
/// of the contact, so the normal of the face must not be far from it.
SCREE_HD inline void add_points_over_face(const BoxPair& pair, const BoxAxes& axes, double margin,
                                          Manifold& out) {
  const BoxAxis& face = axes.better_face();
  const double cosine = normal_of(pair, face).dot(out.normal);
  Manifold over;
  if (cosine < tolerance::over_face_cosine || !face_contact(pair, face, margin * cosine, over)) return;
  const ContactPoint first = out.points[0];
  const auto distance = [&](int k) { return (over.points[k].position - first.position).squaredNorm(); };
  int nearest = 0;
  for (int k = 1; k < over.count; ++k)
    if (distance(k) < distance(nearest)) nearest = k;
  const bool is_full = over.count == Manifold::max_points;
  for (int k = 0; k < over.count; ++k) {
    const ContactPoint& point = over.points[k];
    if ((k == nearest && is_full) || point.feature == first.feature) continue;
    out.points[out.count++] = {point.position, point.gap / cosine, point.feature};
  }
}

/// Finds the contact as contact_along() does, but does not set Manifold::at_edge.
SCREE_HD inline bool feature_contact(const BoxPair& pair, const BoxAxes& axes, const BoxAxis& face,
                                     double margin, Manifold& out) {
  const auto with_points_over_face = [&](bool found) {
    if (found) add_points_over_face(pair, axes, margin, out);
    return found;
  };
  // Nearly parallel edges are never chosen in place of a face, but their axis counts in axes.separation: if
  // that is clearly better than axes.edges, the edges of axes.edges are not close either.
  if (clearly_better(axes.edges.separation, face.separation, pair.smallest) &&
      !clearly_better(axes.separation, axes.edges.separation, pair.smallest) &&
      with_points_over_face(edge_contact(pair, axes.edges, out)))
    return true;
  const double close = axes.separation + preference(axes.separation, pair.smallest);
  // At a margin of 0 rounding must not lose the points of boxes that just touch.
  const double touching = tolerance::touching_gap * pair.smallest;
  const double within = fmax(margin, touching);
  const BoxAxis* faces[2] = {&face, &axes.face[1 - face.box]};
  for (const BoxAxis* reference : faces) {
    if (clearly_better(axes.separation, reference->separation, pair.smallest)) continue;
    if (face_contact(pair, *reference, within, out) && detail::smallest_gap(out) <= close) return true;
  }
  const double of_edges = axes.any_edges.separation;
  const bool has_edges = of_edges > -HUGE_VAL;
  if (axes.separation <= 0.0 && has_edges && !clearly_better(axes.separation, of_edges, pair.smallest))
    return with_points_over_face(edge_contact(pair, axes.any_edges, out));
  if (axes.separation >= -touching) {
    // Boxes that just touch at the rim of a face may have no point over it.
    if (with_points_over_face(closest_edges(pair, axes, within, out))) return true;
    if (axes.separation > 0.0) return false;
  }
  if (face_contact(pair, face, margin, out)) return true;
  return axes.separation < -touching && has_edges &&
         with_points_over_face(edge_contact(pair, axes.any_edges, out));
}

}  // namespace detail

/// Finds the contact of two boxes for a given choice of reference face: the contact of the face, or of the
/// edges if they are clearly better. No state is kept from step to step: the preferences of clearly_better()
/// hold the choice steady instead.
///
/// A face must have a point as close as the axes say the boxes are. If the other box's lowest vertex is
/// beside the face, an edge or a vertex is closer and takes the face's place. For boxes that are apart, such
/// a contact is one point with the true distance and direction: the separation along an axis would only be a
/// lower bound, and its normal would stop boxes that pass beside each other.
SCREE_HD inline bool contact_along(const BoxPair& pair, const BoxAxes& axes, const BoxAxis& face,
                                   double margin, Manifold& out) {
  const bool found = detail::feature_contact(pair, axes, face, margin, out);
  out.at_edge = detail::is_at_edge(pair, axes, margin);
  return found;
}

SCREE_HD inline const BoxAxis& preferred_face(const BoxPair& pair, const BoxAxes& axes) {
  return axes.face[clearly_better(axes.face[1].separation, axes.face[0].separation, pair.smallest) ? 1 : 0];
}

SCREE_HD inline bool box_box(const Solid& a, const Solid& b, double margin, Manifold& out) {
  const BoxPair pair(a, b);
  const BoxAxes axes = separating_axes(pair, margin);
  if (axes.separation > margin) return false;
  return contact_along(pair, axes, preferred_face(pair, axes), margin, out);
}

}  // namespace scree
