// From the normal of a contact of two convex bodies to its points.
#pragma once

#include "narrowphase/convex_axes.hpp"

namespace scree {

/// A point that two bodies share along a normal.
struct SharedPoint {
  enum class Kind { corner_of_a, corner_of_b, crossing };  ///< of edges
  Kind kind;
  int name_a, name_b;  ///< corner, or where its edge begins; -1: of a face
  Vec3 position;       ///< midway between the surfaces
  double gap;

  std::uint32_t feature() const {
    return static_cast<std::uint32_t>(kind) << 16 | static_cast<std::uint32_t>(name_a & 255) << 8 |
           static_cast<std::uint32_t>(name_b & 255);
  }
};

struct SharedPoints {
  static constexpr int most = 4 * Hull::most_vertices;
  int count = 0;
  SharedPoint point[most];

  void add(const SharedPoint& p) {
    if (count < most) point[count++] = p;
  }
};

/// Of a face, whose outward normal is `normal`, with what faces it of the other body. The face is the first
/// body's if `face_is_a`. `radii`: of the two bodies, in that order. Points nearer to each other than `slack`
/// (m) are one.
void share_face(const Facing& face, const Vec3& normal, const Facing& other, bool face_is_a,
                const double radii[2], double slack, SharedPoints& out);

/// Of two segments or points along a normal from the first to the second.
void share_edges(const Facing& a, const Facing& b, const Vec3& normal, const double radii[2],
                 SharedPoints& out);

/// Leaves those with gaps of at most `margin`, and of these 4 at most: the deepest, the one farthest from it,
/// and those that add most area; as the contact of two boxes. False if none is left.
bool take_points(const SharedPoints& shared, const Vec3& normal, const Vec3& origin, double margin,
                 double slack, Manifold& out);

/// The contact of two bodies along the axes found: of a face, if the best is not clearly better. False only
/// if all is beyond the margin. `origin`: what the bodies' places are relative to.
bool contact_along(const ConvexBody& a, const ConvexBody& b, const ConvexAxes& axes, double margin,
                   double size, const Vec3& origin, Manifold& out);

}  // namespace scree
