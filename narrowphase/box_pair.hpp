// Two boxes and the 15 axes that can separate them (Gottschalk, Lin, Manocha 1996, sec. 5). Edge axes are
// true normalised cross products: the usual shortcut 1 - C_ij^2 for their length loses half of the digits.
#pragma once

#include "core/tolerances.hpp"
#include "narrowphase/solid.hpp"

namespace scree {

struct BoxPair {
  Vec3 position[2];
  Mat3 axes[2];  ///< columns are the axes of the box in the world
  Vec3 half[2];
  Vec3 offset;      ///< vector from the first centre to the second (m)
  Mat3 rotation;    ///< axes[0]^T axes[1]
  double smallest;  ///< smallest half extent of both boxes, to which tolerances are relative (m)

  SCREE_HD BoxPair(const Solid& a, const Solid& b)
      : position{a.position, b.position},
        axes{a.orientation.toRotationMatrix(), b.orientation.toRotationMatrix()},
        half{a.size, b.size},
        offset(b.position - a.position),
        rotation(axes[0].transpose() * axes[1]),
        smallest(fmin(a.size.minCoeff(), b.size.minCoeff())) {}

  /// Returns the signed distance of the boxes' projections on a unit direction (world axes, m); negative:
  /// overlap.
  SCREE_HD double separation_along(const Vec3& direction) const {
    return fabs(direction.dot(offset)) - half[0].dot((axes[0].transpose() * direction).cwiseAbs()) -
           half[1].dot((axes[1].transpose() * direction).cwiseAbs());
  }
};

/// A candidate separating axis: a face's normal, or the common normal of two edges.
struct BoxAxis {
  int box;            ///< owner of the face, 0 or 1; -1 for edges
  int index[2];       ///< face: the axis of its box, twice; edges: the axis of each box along its edge
  double separation;  ///< separation of the boxes along this axis (m)
};

/// The axes of each kind that separate two boxes most. If several do so equally, the first is taken.
struct BoxAxes {
  BoxAxis face[2];    ///< best face of the first and of the second box
  double next_face;   ///< largest separation along the other face normals (m)
  BoxAxis edges;      ///< best pair of edges that are not nearly parallel (tolerance::parallel_edges)
  BoxAxis any_edges;  ///< best pair of edges that are not parallel (tolerance::parallel_axes)
  double separation;  ///< largest separation along all 15 axes (m); negative: minus the penetration depth

  /// Returns the one of the two best faces that separates the boxes better.
  SCREE_HD const BoxAxis& better_face() const {
    return face[face[1].separation > face[0].separation ? 1 : 0];
  }
};

namespace detail {

/// Finds the face normal of one box that separates the boxes most. `next` is raised to the separation along
/// the second best normal of this box, if that is larger.
SCREE_HD inline void face_axis(const BoxPair& pair, int box, BoxAxis& best, double& next) {
  const Vec3 offset = pair.axes[box].transpose() * pair.offset;
  best.separation = -HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    double reach = pair.half[box][k];
    for (int m = 0; m < 3; ++m) {
      reach += pair.half[1 - box][m] * fabs(box == 0 ? pair.rotation(k, m) : pair.rotation(m, k));
    }
    const double separation = fabs(offset[k]) - reach;
    next = fmax(next, fmin(separation, best.separation));
    if (separation > best.separation) best = {box, {k, k}, separation};
  }
}

/// Tests the axis along edge i of the first box times edge j of the second. In the frame of the first box,
/// only the components of e_i x C_j along i1 and i2 are not 0, and the axis is exactly normal to both edges.
SCREE_HD inline void edge_axis(const BoxPair& pair, const Vec3& offset, int i, int j, BoxAxes& best) {
  const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
  const Mat3& C = pair.rotation;
  const double n1 = -C(i2, j), n2 = C(i1, j);
  const double reach_a = pair.half[0][i1] * fabs(n1) + pair.half[0][i2] * fabs(n2);
  const double reach_b = pair.half[1][j1] * fabs(n1 * C(i1, j1) + n2 * C(i2, j1)) +
                         pair.half[1][j2] * fabs(n1 * C(i1, j2) + n2 * C(i2, j2));
  const double apart = fabs(n1 * offset[i1] + n2 * offset[i2]) - (reach_a + reach_b);
  // `apart` is the separation times the length of the axis, which is at most 1: if it is negative, the
  // projections overlap by no less along the unit axis.
  if (apart < 0.0 && apart <= best.edges.separation) return;
  const double sine = sqrt(n1 * n1 + n2 * n2);
  if (sine < tolerance::parallel_axes) return;
  const double separation = apart / sine;
  best.separation = fmax(best.separation, separation);
  const BoxAxis axis = {-1, {i, j}, separation};
  if (separation > best.any_edges.separation) best.any_edges = axis;
  if (sine >= tolerance::parallel_edges && separation > best.edges.separation) best.edges = axis;
}

}  // namespace detail

/// Finds the best axes of two boxes. The search ends as soon as one axis separates the boxes by more than
/// `margin`; then `separation` > margin, and the other members have no meaning.
SCREE_HD inline BoxAxes separating_axes(const BoxPair& pair, double margin) {
  BoxAxes best;
  best.next_face = -HUGE_VAL;
  detail::face_axis(pair, 0, best.face[0], best.next_face);
  detail::face_axis(pair, 1, best.face[1], best.next_face);
  best.separation = fmax(best.face[0].separation, best.face[1].separation);
  best.edges = best.any_edges = {-1, {0, 0}, -HUGE_VAL};
  const Vec3 offset = pair.axes[0].transpose() * pair.offset;
  for (int ij = 0; ij < 9 && best.separation <= margin; ++ij) {
    detail::edge_axis(pair, offset, ij / 3, ij % 3, best);
  }
  return best;
}

/// Returns the unit normal of an axis, directed from the first box to the second.
SCREE_HD inline Vec3 normal_of(const BoxPair& pair, const BoxAxis& axis) {
  Vec3 normal;
  if (axis.box < 0) {
    normal = pair.axes[0].col(axis.index[0]).cross(pair.axes[1].col(axis.index[1])).normalized();
  } else {
    normal = pair.axes[axis.box].col(axis.index[0]);
  }
  return sign_of(normal.dot(pair.offset)) * normal;
}

/// Returns the advantage of a preferred axis with the given separation: another axis must separate the boxes
/// by this much more to replace it (m).
SCREE_HD inline double preference(double separation, double smallest) {
  return tolerance::axis_preference * fabs(separation) + tolerance::axis_preference_length * smallest;
}

/// Returns whether a separation is so much better than that of a preferred axis that its axis replaces it.
SCREE_HD inline bool clearly_better(double separation, double preferred, double smallest) {
  return separation > preferred + preference(preferred, smallest);
}

}  // namespace scree
