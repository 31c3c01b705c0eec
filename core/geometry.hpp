// The shapes that a size cannot tell: hulls, which many bodies share, and how the triangles of a mesh lie
// among each other. They belong to the scene and never change.
#pragma once

#include "core/math.hpp"
#include "core/shape_data.hpp"

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace scree {

/// A convex polyhedron. Its frame has its origin in the centre of mass and its axes along the principal ones.
struct Hull {
  /// A hull has at most so many vertices.
  static constexpr int most_vertices = 128;

  struct Face {
    Vec3 normal;  ///< unit, outward
    int first;    ///< its corners in `corners`, counterclockwise from outside
    int count;
  };
  struct Edge {
    int from, to;     ///< vertices
    int left, right;  ///< faces; seen from outside with `from` below `to`
  };

  std::vector<Vec3> vertices;  ///< m
  std::vector<Face> faces;
  std::vector<int> corners;
  std::vector<Edge> edges;
  double volume = 0;            ///< m^3
  Vec3 moments = Vec3::Zero();  ///< principal, of unit mass (m^2)
  // Where the frame is in that of the points it was made of.
  Vec3 centre = Vec3::Zero();
  Quat axes = Quat::Identity();

  std::span<const int> corners_of(const Face& face) const {
    return {&corners[static_cast<std::size_t>(face.first)], static_cast<std::size_t>(face.count)};
  }
  /// Half extents of the smallest box about the centre of mass that holds it (m).
  Vec3 half_extent() const;
};

/// The hull of points of uniform density. Points inside it, within a face or within an edge are left out, but
/// for what hull_surface() counts as none. Throws InputError, without a place, if there are too few, if one
/// is not finite, if they lie in a plane, or if the hull has too many vertices.
Hull make_hull(std::span<const Vec3> points);

/// Where a mesh's triangle is among the others, in the triangle's frame. A normal of contact n (unit, from
/// the mesh) belongs to one of its edges or vertices if n.d <= 0 for all directions d of that feature: the
/// mesh's normal cone there. Flat and hollow edges have no cone but the faces'.
struct Surroundings {
  struct Feature {
    int first = 0;  ///< its directions
    int count = 0;
    bool owned = false;  ///< this triangle gives its contacts; each feature of a mesh has one owner
  };

  std::array<Feature, 3> edges;     ///< from corner k to corner k + 1
  std::array<Feature, 3> vertices;  ///< corner k
  std::vector<Vec3> directions;     ///< unit; into each triangle at an edge, along each edge from a vertex

  std::span<const Vec3> directions_of(const Feature& feature) const {
    return {directions.data() + feature.first, static_cast<std::size_t>(feature.count)};
  }
};

/// A triangle in place, as Shape::triangle has it.
struct PlacedTriangle {
  Vec3 position;
  Quat orientation;
  Vec3 size;
  std::array<int, 3> corners;  ///< vertices of the mesh, in the order of Shape::triangle
};

/// Corner k of a triangle in its frame; `size` as in Shape.
inline Vec3 triangle_corner(const Vec3& size, int k) {
  return k == 0   ? Vec3(-size.x(), -size.z(), 0)
         : k == 1 ? Vec3(size.x(), -size.z(), 0)
                  : Vec3(size.y(), size.z(), 0);
}

/// Vertices and the triangles between them.
struct TriangleMesh {
  std::vector<Vec3> vertices;                 ///< m
  std::vector<std::array<int, 3>> triangles;  ///< counterclockwise from the front
};

/// Which corners of a mesh count as one.
struct Weld {
  bool on = true;                ///< false: those of equal place alone
  std::optional<double> length;  ///< those nearer than this (m); absent: by the mesh (tolerance::weld_size)
};

/// What was done to a mesh as it was read, and what it is.
struct MeshReport {
  std::int64_t welded = 0;    ///< corners that became one with another
  double farthest = 0;        ///< most that one of them was moved (m)
  std::int64_t split = 0;     ///< triangles that were split where corners lie on their edges
  std::int64_t left_out = 0;  ///< triangles that have no area, or have none now, or are there twice
  std::int64_t open = 0;      ///< edges of one triangle alone
  std::int64_t crowded = 0;   ///< edges of three triangles or more
};

/// Makes the mesh whole: corners that nearly meet become one, at the mean of their places, and triangles are
/// split where corners of others lie on their edges, so that triangles that touch share edges. Triangles that
/// lose their area go. Nothing of it depends on the order of vertices or triangles. A mesh of which nothing
/// nearly meets is as it was, to the bit. Throws InputError, without a place, if corners lie on edges at far
/// more places than a surface has.
void weld(TriangleMesh& mesh, const Weld& how, MeshReport& report);

/// False if the triangle has no area worth the name.
bool place_triangle(const TriangleMesh& mesh, std::size_t triangle, PlacedTriangle& out);

/// The edges of triangles, each once: its vertices, the lower one first, and how many triangles have it.
struct MeshEdge {
  int from, to;
  int count;
};
/// By ascending vertices.
std::vector<MeshEdge> edges_of(std::span<const std::array<int, 3>> triangles);

/// Of each triangle.
std::vector<Surroundings> surroundings_of(const TriangleMesh& mesh,
                                          const std::vector<PlacedTriangle>& placed);

/// All that bodies of a scene refer to. Its parts do not move when others are added.
struct Geometry {
  std::deque<Hull> hulls;
  std::deque<Surroundings> surroundings;
  std::vector<ShapeData> of_body;  ///< by the body's number in the scene
};

}  // namespace scree
