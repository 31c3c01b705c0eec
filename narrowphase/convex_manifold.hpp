// The contact points of two convex bodies, found from the normal of their contact.
#pragma once

#include "narrowphase/convex_axes.hpp"

namespace scree {

/// A point that two bodies share along a normal.
struct SharedPoint {
  enum class Kind { corner_of_a, corner_of_b, crossing };  ///< a crossing is one of two edges
  Kind kind;
  int name_a, name_b;  ///< number of the corner, or of the corner where its edge begins; -1 for a face
  Vec3 position;       ///< midway between the surfaces (m)
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

/// Adds the points shared by a face, whose outward normal is `normal`, and the part of the other body that
/// faces it. The face is the first body's if `face_is_a`. `radii` are the radii around the cores of the first
/// and the second body. Points nearer to each other than `slack` (m) count as one.
void share_face(const Facing& face, const Vec3& normal, const Facing& other, bool face_is_a,
                const double radii[2], double slack, SharedPoints& out);

/// Adds the points shared by two segments or points, along a normal from the first body to the second.
void share_edges(const Facing& a, const Facing& b, const Vec3& normal, const double radii[2],
                 SharedPoints& out);

/// Makes a contact of the points with gaps of at most `margin`, and of at most 4 of them: the deepest, the
/// one farthest from it, and those that add most area, as for two boxes. Returns false if no point is left.
bool take_points(const SharedPoints& shared, const Vec3& normal, const Vec3& origin, double margin,
                 double slack, Manifold& out);

/// Finds the contact of two bodies from the axes found: the contact of the face, if the best axis is not
/// clearly better. Returns false only if all points are beyond the margin. `origin` is the point to which the
/// bodies' positions are relative.
bool contact_along(const ConvexBody& a, const ConvexBody& b, const ConvexAxes& axes, double margin,
                   double size, const Vec3& origin, Manifold& out);

}  // namespace scree
