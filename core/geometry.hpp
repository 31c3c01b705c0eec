// The shapes that a size alone does not describe: hulls, which many bodies share, and the triangles of a mesh
// with their neighbours. They belong to the scene and never change.
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

/// A convex polyhedron. The origin of its frame is the centre of mass, and the axes are the principal ones.
struct Hull {
  /// The largest number of vertices of a hull.
  static constexpr int most_vertices = 128;

  struct Face {
    Vec3 normal;  ///< outward unit normal
    int first;    ///< index of its first corner in `corners`; these are counterclockwise from outside
    int count;
  };
  struct Edge {
    int from, to;     ///< vertices
    int left, right;  ///< faces on either side, seen from outside with `from` below `to`
  };

  std::vector<Vec3> vertices;  ///< m
  std::vector<Face> faces;
  std::vector<int> corners;
  std::vector<Edge> edges;
  double volume = 0;            ///< m^3
  Vec3 moments = Vec3::Zero();  ///< principal moments of inertia for unit mass (m^2)
  // Origin and orientation of the frame, in the frame of the points that the hull was made of.
  Vec3 centre = Vec3::Zero();
  Quat axes = Quat::Identity();

  std::span<const int> corners_of(const Face& face) const {
    return {&corners[static_cast<std::size_t>(face.first)], static_cast<std::size_t>(face.count)};
  }
  /// Returns the half extents of the smallest box about the centre of mass that holds the hull (m).
  Vec3 half_extent() const;
};

/// Makes the hull of points, with uniform density. Points inside the hull, within a face or within an edge
/// are left out, up to the distance that hull_surface() counts as none. Throws InputError, without a line and
/// column, if there are too few points, if one is not finite, if they lie in a plane, or if the hull has too
/// many vertices.
Hull make_hull(std::span<const Vec3> points);

/// The neighbours of a mesh's triangle, in the triangle's frame. A contact normal n (unit, away from the
/// mesh) belongs to an edge or a vertex of the triangle if n.d <= 0 for all directions d of that feature: n
/// is then in the mesh's normal cone there. At flat and hollow edges, the cone holds only the normals of the
/// faces.
struct Surroundings {
  struct Feature {
    int first = 0;  ///< index of its first direction in `directions`
    int count = 0;
    bool owned = false;  ///< this triangle makes its contacts; each feature of a mesh has one owner
  };

  std::array<Feature, 3> edges;     ///< edge k goes from corner k to corner k + 1
  std::array<Feature, 3> vertices;  ///< vertex k is corner k
  std::vector<Vec3> directions;     ///< unit; into each triangle at an edge, along each edge from a vertex

  std::span<const Vec3> directions_of(const Feature& feature) const {
    return {directions.data() + feature.first, static_cast<std::size_t>(feature.count)};
  }
};

/// A triangle with the position, orientation and size that Shape::triangle defines.
struct PlacedTriangle {
  Vec3 position;
  Quat orientation;
  Vec3 size;
  std::array<int, 3> corners;  ///< numbers of the mesh's vertices, in the order of Shape::triangle
};

/// Returns corner k of a triangle in its frame; `size` is as in Shape.
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

/// The rule by which corners of a mesh count as one.
struct Weld {
  bool on = true;                ///< false: only corners at equal places count as one
  std::optional<double> length;  ///< largest distance of such corners (m); absent: see tolerance::weld_size
};

/// The changes made to a mesh when it was read, and the edges of the result that are open or crowded.
struct MeshReport {
  std::int64_t welded = 0;    ///< corners that were joined to another one
  double farthest = 0;        ///< largest distance that a corner was moved by this (m)
  std::int64_t split = 0;     ///< triangles that were split where corners lie on their edges
  std::int64_t left_out = 0;  ///< triangles that had no area, or lost it, or were there twice
  std::int64_t open = 0;      ///< edges that belong to one triangle only
  std::int64_t crowded = 0;   ///< edges that belong to three triangles or more
};

/// Makes the mesh whole: corners that nearly meet become one, at the mean of their places, and triangles are
/// split where corners of others lie on their edges, so that triangles that touch share edges. Triangles that
/// lose their area are removed. The result does not depend on the order of vertices or triangles. A mesh in
/// which no corners nearly meet stays as it was, to the bit. Throws InputError, without a line and column, if
/// corners lie on edges at far more places than a surface has.
void weld(TriangleMesh& mesh, const Weld& how, MeshReport& report);

/// Places a triangle of the mesh. Returns false if its height is negligible (tolerance::flat).
bool place_triangle(const TriangleMesh& mesh, std::size_t triangle, PlacedTriangle& out);

/// An edge of triangles: its vertices, the lower one first, and how many triangles have it.
struct MeshEdge {
  int from, to;
  int count;
};
/// Returns each edge once, by ascending vertices.
std::vector<MeshEdge> edges_of(std::span<const std::array<int, 3>> triangles);

/// Returns the surroundings of each triangle.
std::vector<Surroundings> surroundings_of(const TriangleMesh& mesh,
                                          const std::vector<PlacedTriangle>& placed);

/// All shapes that bodies of a scene refer to. They do not move in memory when others are added.
struct Geometry {
  std::deque<Hull> hulls;
  std::deque<Surroundings> surroundings;
  std::vector<ShapeData> of_body;  ///< shape data of each body, by its number in the scene
};

}  // namespace scree
