// The contact of a box's face with another box: the other box's most opposed face is clipped to the first
// one.
#pragma once

#include "narrowphase/box_pair.hpp"

namespace scree {

namespace detail {

/// A corner of the polygon that the two faces share, in the frame of the reference box.
struct ClipPoint {
  double at[2];      ///< coordinates along the edges of the reference face (m)
  double height;     ///< height over the reference face, which is the gap (m)
  BoxFeature own;    ///< feature of the reference box
  BoxFeature other;  ///< feature of the other box
};

struct ClipPolygon {
  int count = 0;
  ClipPoint point[8];  // clipping at a side adds at most one corner to those of a quadrilateral
};

/// Cuts a convex polygon to its part on the inner side of at[d] * side = limit (Sutherland, Hodgman 1974).
/// `scratch` holds the points of the polygon before the cut.
SCREE_HD inline void clip(ClipPolygon& polygon, int d, double side, double limit, BoxFeature cut,
                          ClipPolygon& scratch) {
  double beyond[8];
  bool any = false;
  for (int k = 0; k < polygon.count; ++k) {
    beyond[k] = side * polygon.point[k].at[d] - limit;
    any = any || beyond[k] > 0.0;
  }
  if (!any) return;
  scratch.count = polygon.count;
  for (int k = 0; k < polygon.count; ++k) scratch.point[k] = polygon.point[k];
  polygon.count = 0;
  for (int k = 0; k < scratch.count; ++k) {
    const int next = k + 1 < scratch.count ? k + 1 : 0;
    const ClipPoint& p = scratch.point[k];
    const ClipPoint& q = scratch.point[next];
    if (beyond[k] <= 0.0) polygon.point[polygon.count++] = p;
    if ((beyond[k] <= 0.0) == (beyond[next] <= 0.0)) continue;
    const double share = beyond[k] / (beyond[k] - beyond[next]);
    ClipPoint& c = polygon.point[polygon.count++];
    for (int e = 0; e < 2; ++e) c.at[e] = p.at[e] + share * (q.at[e] - p.at[e]);
    c.height = p.height + share * (q.height - p.height);
    c.own = (p.own & q.own) | cut;
    c.other = p.other & q.other;
  }
}

/// Returns twice the area of the triangle a, b, c, positive if counterclockwise.
SCREE_HD inline double area(const ClipPoint& a, const ClipPoint& b, const ClipPoint& c) {
  return (b.at[0] - a.at[0]) * (c.at[1] - a.at[1]) - (b.at[1] - a.at[1]) * (c.at[0] - a.at[0]);
}

/// Moves a point to place `slot`: the first of the later points whose value exceeds all values before it by
/// more than the tolerance, so that noise does not choose among equals.
template <class Value>
SCREE_HD void select(ClipPolygon& polygon, int slot, double slack, Value value) {
  int best = slot;
  double best_value = value(polygon.point[slot]);
  for (int k = slot + 1; k < polygon.count; ++k) {
    const double v = value(polygon.point[k]);
    if (v > best_value + slack) {
      best = k;
      best_value = v;
    }
  }
  const ClipPoint chosen = polygon.point[best];
  for (int k = best; k > slot; --k) polygon.point[k] = polygon.point[k - 1];
  polygon.point[slot] = chosen;
}

/// Orders points by their features, so that the order does not depend on where the clipping began.
SCREE_HD inline void sort_by_feature(ClipPolygon& polygon) {
  for (int k = 1; k < polygon.count; ++k) {
    const ClipPoint p = polygon.point[k];
    int to = k;
    for (; to > 0 && contact_feature(p.own, p.other) <
                         contact_feature(polygon.point[to - 1].own, polygon.point[to - 1].other);
         --to) {
      polygon.point[to] = polygon.point[to - 1];
    }
    polygon.point[to] = p;
  }
}

/// Keeps 4 points: the deepest, the one farthest from it, and the two that add most area.
SCREE_HD inline void reduce(ClipPolygon& polygon, double smallest) {
  sort_by_feature(polygon);
  if (polygon.count <= Manifold::max_points) return;
  const double slack = tolerance::same_feature * smallest;
  const ClipPoint* p = polygon.point;
  select(polygon, 0, slack, [](const ClipPoint& c) { return -c.height; });
  const auto distance = [p](const ClipPoint& c) {
    const double x = c.at[0] - p[0].at[0], y = c.at[1] - p[0].at[1];
    return sqrt(x * x + y * y);
  };
  select(polygon, 1, slack, distance);
  const double area_slack = slack * distance(p[1]);
  select(polygon, 2, area_slack, [p](const ClipPoint& c) { return fabs(area(p[0], p[1], c)); });
  const double turn = area(p[0], p[1], p[2]) < 0.0 ? -1.0 : 1.0;
  select(polygon, 3, area_slack, [p, turn](const ClipPoint& c) {
    const double beyond_01 = -turn * area(p[0], p[1], c);
    const double beyond_12 = -turn * area(p[1], p[2], c);
    const double beyond_20 = -turn * area(p[2], p[0], c);
    return fmax(beyond_01, fmax(beyond_12, beyond_20));
  });
  polygon.count = Manifold::max_points;
  sort_by_feature(polygon);
}

/// A face of the other box, in the frame of the reference box.
struct IncidentFace {
  Mat3 axes;    ///< axes of the other box
  Vec3 centre;  ///< centre of the face
  int axis;
  double side;
};

/// Returns the face of the other box that is most opposed to the reference face (axis k, side).
SCREE_HD inline IncidentFace incident_face(const BoxPair& pair, int box, int k, double side) {
  const int other = 1 - box;
  IncidentFace face;
  if (box == 0) {
    face.axes = pair.rotation;
  } else {
    face.axes = pair.rotation.transpose();
  }
  face.axis = 0;
  for (int m = 1; m < 3; ++m) {
    // If a box on its edge opposes two faces equally, the first of them is taken, whatever the noise.
    if (fabs(face.axes(k, m)) > fabs(face.axes(k, face.axis)) + tolerance::same_feature) face.axis = m;
  }
  face.side = -side * sign_of(face.axes(k, face.axis));
  const Vec3 offset = box == 0 ? pair.offset : Vec3(-pair.offset);
  face.centre = pair.axes[box].transpose() * offset +
                face.side * pair.half[other][face.axis] * face.axes.col(face.axis);
  return face;
}

/// Returns the incident face's corners in the coordinates of the reference face, which has axis k.
SCREE_HD inline ClipPolygon corners(const BoxPair& pair, int box, int k, double side,
                                    const IncidentFace& face) {
  const int u = (k + 1) % 3, w = (k + 2) % 3;
  const int m1 = (face.axis + 1) % 3, m2 = (face.axis + 2) % 3;
  constexpr double around[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  ClipPolygon polygon;
  for (const auto& corner : around) {
    const Vec3 at = face.centre + corner[0] * pair.half[1 - box][m1] * face.axes.col(m1) +
                    corner[1] * pair.half[1 - box][m2] * face.axes.col(m2);
    polygon.point[polygon.count++] = {
        {at[u], at[w]},
        side * at[k] - pair.half[box][k],
        box_side(k, side),
        box_side(face.axis, face.side) | box_side(m1, corner[0]) | box_side(m2, corner[1])};
  }
  return polygon;
}

}  // namespace detail

/// Finds the contact of the face `axis` with the other box. Returns false if no part of the opposed face lies
/// over it within the margin. The gap of a point is its height over the face; its position is halfway down.
SCREE_HD inline bool face_contact(const BoxPair& pair, const BoxAxis& axis, double margin, Manifold& out) {
  const int box = axis.box, k = axis.index[0];
  const int across[2] = {(k + 1) % 3, (k + 2) % 3};
  const Mat3& axes = pair.axes[box];
  const Vec3& half = pair.half[box];
  out.normal = normal_of(pair, axis);
  const double side = sign_of((box == 0 ? 1.0 : -1.0) * out.normal.dot(axes.col(k)));

  detail::ClipPolygon polygon =
      detail::corners(pair, box, k, side, detail::incident_face(pair, box, k, side));
  detail::ClipPolygon scratch;
  for (int d = 0; d < 2; ++d) {
    const double limit = half[across[d]] + tolerance::same_feature * pair.smallest;
    for (const double s : {-1.0, 1.0}) detail::clip(polygon, d, s, limit, box_side(across[d], s), scratch);
  }
  int within = 0;
  for (int c = 0; c < polygon.count; ++c) {
    if (polygon.point[c].height <= margin) polygon.point[within++] = polygon.point[c];
  }
  polygon.count = within;
  detail::reduce(polygon, pair.smallest);

  out.count = polygon.count;
  for (int c = 0; c < polygon.count; ++c) {
    const detail::ClipPoint& p = polygon.point[c];
    Vec3 local;
    local[k] = side * (half[k] + 0.5 * p.height);
    // A vertex may count as over the face although it is just beside it; it is moved onto the face, so that
    // positions never leave the reference face.
    for (int d = 0; d < 2; ++d) local[across[d]] = fmax(-half[across[d]], fmin(half[across[d]], p.at[d]));
    const BoxFeature first = box == 0 ? p.own : p.other, second = box == 0 ? p.other : p.own;
    out.points[c] = {pair.position[box] + axes * local, p.height, contact_feature(first, second)};
  }
  return out.count > 0;
}

}  // namespace scree
