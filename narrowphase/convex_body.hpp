// A convex body in place, in the form that the narrow phase of general shapes uses: a core (a point, a
// segment, a polytope or a cylinder), and all that is within a radius of the core.
#pragma once

#include "core/geometry.hpp"
#include "narrowphase/general_contacts.hpp"

#include <span>
#include <utility>

namespace scree {

/// A corner of a polygon, or an end of a segment.
struct Corner {
  Vec3 at;
  int name;  ///< number of the corner within its body
};

/// The part of a body that faces a direction: a polygon (counterclockwise from outside), a segment or a
/// point.
struct Facing {
  static constexpr int most = Hull::most_vertices;
  int count = 0;
  Corner corner[most];

  void add(const Vec3& at, int name) { corner[count++] = {at, name}; }
  std::span<const Corner> corners() const { return {corner, static_cast<std::size_t>(count)}; }
};

/// A convex body in place. All positions are relative to an origin near the pair (m).
class ConvexBody {
 public:
  ConvexBody(const ShapedSolid& body, const ShapeData* data, const Vec3& origin);

  const Vec3& centre() const { return centre_; }
  const Mat3& axes() const { return axes_; }
  double radius() const { return radius_; }  ///< radius around the core (m)
  double size() const { return size_; }  ///< length that scales tolerances (m); infinite: the body sets none
  double extent() const { return extent_; }  ///< largest half extent (m)
  bool is_cylinder() const { return kind_ == Kind::cylinder; }
  bool is_polytope() const { return kind_ == Kind::polytope; }

  /// Returns the point of the core that is farthest along a direction.
  Vec3 support(const Vec3& along) const;
  /// Returns the same point as support(), except if a whole cap is farthest: then a point of its rim, not its
  /// middle.
  Vec3 corner(const Vec3& along) const;
  static constexpr int most_faces = 2 * Hull::most_vertices - 4;

  /// Returns how far the body reaches along a unit direction.
  double reach(const Vec3& along) const { return support(along).dot(along) + radius_; }

  int faces() const { return static_cast<int>(face_count_); }
  const Vec3& normal(int face) const { return normals_[face]; }  ///< unit vector, outward
  int edges() const { return static_cast<int>(edge_count_); }
  Vec3 edge(int e) const;                      ///< vector along the edge, not normalised
  std::pair<int, int> faces_at(int e) const {  ///< the two faces beside an edge; for a polytope only
    const Hull::Edge& edge = hull_->edges[static_cast<std::size_t>(e)];
    return {edge.left, edge.right};
  }
  const Vec3& edge_start(int e) const;

  Facing face_toward(const Vec3& along, int face) const;  ///< the given face, seen along its normal
  Facing edge_toward(const Vec3& along) const;            ///< the core's segment or point that faces it
  Facing widest_toward(const Vec3& along) const;          ///< a face if nearly normal, else as edge_toward()

  /// Returns the corners of the core, if it has any.
  std::span<const Vec3> vertices() const { return {vertices_, static_cast<std::size_t>(vertex_count_)}; }

 private:
  enum class Kind { point, segment, polytope, triangle, cylinder };

  void take(const Hull& hull, const Vec3& scale);
  Vec3 of_cylinder(const Vec3& along, double middle) const;
  Facing cap_toward(const Vec3& along) const;

  Kind kind_;
  Vec3 centre_;
  Mat3 axes_;
  double radius_ = 0;
  double size_, extent_;
  const Hull* hull_ = nullptr;
  int vertex_count_ = 0, face_count_ = 0, edge_count_ = 0;
  double disc_ = 0, half_ = 0;  // radius and half height of a cylinder
  Vec3 vertices_[Hull::most_vertices];
  Vec3 normals_[most_faces];
};

/// Returns the separation of two bodies along a unit direction from the first to the second (m); negative:
/// overlap.
inline double separation_along(const ConvexBody& a, const ConvexBody& b, const Vec3& direction) {
  return -b.reach(-direction) - a.reach(direction);
}

}  // namespace scree
