// By how much two convex particles overlap, in long double and by definitions: of all directions the one that
// parts them most.
//
// Where the cores (see ConvexBody) are apart, that is their distance. Where they overlap, the surface of the
// difference of the two is nearest to the origin at a point with one normal alone, so in the inside of one of
// its patches: a face with a vertex, an edge with an edge (their normals are tried one by one), the wall of a
// cylinder with a vertex or a rim with an edge (the normals are at right angles to its axis or to the edge: a
// circle of them, sampled and refined), or a rim with a rim (all directions, sampled and refined).
#pragma once

#include "bench/narrowphase/convex_families.hpp"
#include "bench/narrowphase/oracle.hpp"

#include <utility>
#include <vector>

namespace scree::oracle {

class Convex {
 public:
  /// `origin`: what places are relative to.
  Convex(const ShapedSolid& body, const Hull* hull, const Vec3& origin);

  /// Of the body's points along a unit direction.
  Real reach(const Vec& n) const;
  Vec centre;
  Real radius = 0;                         ///< around the core
  std::vector<Vec> points;                 ///< corners of the core
  std::vector<Vec> normals;                ///< unit, outward
  std::vector<std::vector<int>> faces;     ///< corners
  std::vector<std::pair<int, int>> edges;  ///< corners
  bool cylinder = false;
  Vec axis;
  Real disc = 0, half = 0;  ///< of a cylinder

  /// Directions at right angles to which its edges and walls are seen.
  std::vector<Vec> lines() const;
};

/// How far apart two bodies are along a unit direction from the first to the second; negative: overlap.
Real separation_along(const Convex& a, const Convex& b, const Vec& n);

/// Largest separation over all directions, if the bodies overlap: minus the penetration depth. What the
/// search of samples for cylinders finds may be short of it, but never beyond.
Real separation(const Convex& a, const Convex& b);

}  // namespace scree::oracle
