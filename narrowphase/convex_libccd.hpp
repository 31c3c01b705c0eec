// Contacts of convex particles by way of libccd: libccd chooses the direction, a certificate judges it, and
// the contact points come from the same clipping as without libccd. This file is for Host only.
#pragma once

#include "narrowphase/convex_axes.hpp"
#include "narrowphase/libccd.hpp"
#include "narrowphase/stats.hpp"

#include <optional>

namespace scree {

/// Returns whether libccd can be asked about a pair: both are convex particles, and at least one is a
/// capsule, a cylinder or a polyhedron. Excluded are a sphere with a capsule, which has a closed form, and
/// surfaces, which have no inside.
inline bool is_convex_pair(Shape a, Shape b) {
  if (!(is_general(a) || is_general(b)) || is_surface(a) || is_surface(b)) return false;
  return !(a == Shape::sphere && b == Shape::capsule) && !(a == Shape::capsule && b == Shape::sphere);
}

namespace detail {

/// Returns how many support points libccd may ask for in a search for these two bodies.
int support_budget_of(const ConvexBody& a, const ConvexBody& b);

/// Returns the answer of libccd, with its direction in the axes in which the bodies are placed.
libccd::Answer ask_libccd(const ConvexBody& a, const ConvexBody& b, libccd::Method method, int budget);

/// Returns the axis along libccd's direction if it passes the certificate, else none. The overlap along it is
/// exact, and it must not be more than the overlap along the best axis found. There is none either if libccd
/// finds no direction. `size` is as in best_axes().
std::optional<ConvexAxis> certified_axis(const ConvexBody& a, const ConvexBody& b, const ConvexAxes& axes,
                                         double size, libccd::Method method, NarrowPhaseStats& stats);

}  // namespace detail

/// Finds the contacts of a convex pair as find_general_contacts() does, with the direction of libccd. Bodies
/// that are apart stay with the search along axes, because libccd has no distance query. So do bodies for
/// which the certificate refuses libccd's answer; `stats` counts these.
int find_contacts_by_libccd(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes,
                            double margin, libccd::Method method, Manifold* out, NarrowPhaseStats& stats);

/// Compares the separation along the axes of a convex pair with that along the direction of libccd's GJK and
/// EPA, and counts the difference. GJK and EPA are used because they fail less often here than libccd's MPR.
void crosscheck(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes, CrosscheckStats& stats);

}  // namespace scree
