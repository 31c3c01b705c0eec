// The body data that a pair function gets, and the names of the features of a box.
#pragma once

#include "core/math.hpp"
#include "narrowphase/contact.hpp"

#include <cstdint>

namespace scree {

/// A shape in place. `size` is as in Shape (m).
struct Solid {
  Vec3 position;
  Quat orientation;
  Vec3 size;
};

// Every pair function has the form
//   bool pair(const Solid& a, const Solid& b, double margin, Manifold& out)
// It returns whether a and b have contact points with gaps of at most `margin`, and sets normal (from a to
// b), count and points of `out`. Where one normal is not enough, the form is
//   int pair(const Solid& a, const Solid& b, double margin, Manifold* out)
// It returns the number of manifolds that it sets, `part` included, at most max_pair_manifolds. The offset b
// - a is formed in double before anything else: far from the origin, only the digits that the positions
// themselves have lost are lost.

/// Returns the sign of x, never 0.
SCREE_HD inline double sign_of(double x) { return x < 0.0 ? -1.0 : 1.0; }

/// A vertex, edge or face of a box, as two bits for each axis: 0 free, 1 the negative side, 2 the positive
/// side. A vertex leaves no axis free, an edge leaves one, a face two. So `p & q` is the smallest feature
/// that holds both.
using BoxFeature = std::uint32_t;

SCREE_HD inline BoxFeature box_side(int axis, double side) { return (side < 0.0 ? 1u : 2u) << (2 * axis); }

/// Returns the name of a contact of feature `a` of the first body with feature `b` of the second. A pair of
/// features has one name, whichever body gave the reference face.
SCREE_HD inline std::uint32_t contact_feature(BoxFeature a, BoxFeature b) { return a << 6 | b; }

struct BoxCorner {
  Vec3 position;
  BoxFeature feature;
};

/// Returns corner c of the 8 corners of a box with the given axes: bit k of c chooses the side along axis k.
SCREE_HD inline BoxCorner box_corner(const Solid& box, const Mat3& axes, int c) {
  BoxCorner corner{box.position, 0};
  for (int k = 0; k < 3; ++k) {
    const double side = c >> k & 1 ? 1.0 : -1.0;
    corner.position += side * box.size[k] * axes.col(k);
    corner.feature |= box_side(k, side);
  }
  return corner;
}

/// Name of the feature of a surface that has at most one contact point: the point needs no name to be found
/// again.
inline constexpr std::uint32_t only_feature = 0;

SCREE_HD inline void set_single(Manifold& out, const Vec3& normal, const ContactPoint& point) {
  out.at_edge = false;
  out.normal = normal;
  out.count = 1;
  out.points[0] = point;
}

}  // namespace scree
