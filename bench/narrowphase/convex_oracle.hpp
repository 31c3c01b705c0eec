// The overlap of two convex particles, in long double and by its definition: the separation along the
// direction that separates them most.
//
// If the cores (see ConvexBody) are apart, this is their distance. If they overlap, the surface of the
// difference of the two is nearest to the origin at a point with a unique normal, which is thus inside one of
// the surface's patches. A patch belongs to a face with a vertex or to an edge with an edge (their normals
// are tried one by one), to the wall of a cylinder with a vertex or to a rim with an edge (the normals are at
// right angles to the cylinder's axis or to the edge: a circle of them is sampled and refined), or to a rim
// with a rim (all directions are sampled and refined).
#pragma once

#include "bench/narrowphase/convex_families.hpp"
#include "bench/narrowphase/oracle.hpp"

#include <utility>
#include <vector>

namespace scree::oracle {

class Convex {
 public:
  /// Places in the oracle are relative to `origin`.
  Convex(const ShapedSolid& body, const Hull* hull, const Vec3& origin);

  /// Returns the reach of the body's points along a unit direction.
  Real reach(const Vec& n) const;
  Vec centre;
  Real radius = 0;                         ///< radius of the sphere swept over the core
  std::vector<Vec> points;                 ///< corners of the core
  std::vector<Vec> normals;                ///< normals of the faces, unit, outward
  std::vector<std::vector<int>> faces;     ///< corners of each face
  std::vector<std::pair<int, int>> edges;  ///< corners of each edge
  bool cylinder = false;
  Vec axis;
  Real disc = 0, half = 0;  ///< radius and half length of a cylinder

  /// Returns the directions of the edges, or of a cylinder's axis. Normals of edges and walls are at right
  /// angles to them.
  std::vector<Vec> lines() const;
};

/// Returns the separation of two bodies along a unit direction from the first to the second; it is negative
/// if they overlap.
Real separation_along(const Convex& a, const Convex& b, const Vec& n);

/// Returns the largest separation over all directions, which is minus the penetration depth if the bodies
/// overlap. The sampled search for cylinders may find less than the largest separation, but never more.
Real separation(const Convex& a, const Convex& b);

}  // namespace scree::oracle
