// Convex particles by way of libccd: it chooses the direction, a certificate judges it, and the contact
// points come from the same clipping as without it. On Host alone.
#pragma once

#include "narrowphase/ccd.hpp"
#include "narrowphase/convex_axes.hpp"
#include "narrowphase/stats.hpp"

#include <optional>

namespace scree {

/// Whether libccd can be asked about a pair: convex particles, of which one at least is a capsule, a cylinder
/// or a polyhedron. Not about a sphere and a capsule, which have a closed form, nor about surfaces, which
/// have no inside.
inline bool is_convex_pair(Shape a, Shape b) {
  if (!(is_general(a) || is_general(b)) || is_surface(a) || is_surface(b)) return false;
  return !(a == Shape::sphere && b == Shape::capsule) && !(a == Shape::capsule && b == Shape::sphere);
}

namespace detail {

/// The most supports that it may ask for of these two.
int support_budget_of(const ConvexBody& a, const ConvexBody& b);

/// The answer of libccd, its direction in the frame of the bodies' places.
ccd::Answer ask_ccd(const ConvexBody& a, const ConvexBody& b, ccd::Method method, int budget);

/// The direction of libccd, certified: how much the bodies overlap along it is exact, and it must not be more
/// than along the best axis found. None if libccd has none or it fails. `size` as in best_axes().
std::optional<ConvexAxis> certified_axis(const ConvexBody& a, const ConvexBody& b, const ConvexAxes& axes,
                                         double size, ccd::Method method, NarrowPhaseStats& stats);

}  // namespace detail

/// As find_general_contacts(), of a convex pair. Bodies that are apart stay with the search along axes:
/// libccd has no distance query. So do those whose answer by libccd the certificate refuses, which `stats`
/// counts.
int find_contacts_by_ccd(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes, double margin,
                         ccd::Method method, Manifold* out, NarrowPhaseStats& stats);

/// Asks libccd's GJK and EPA, which fail less often than its MPR here, about a convex pair, and counts in
/// what the answer differs from that of the axes.
void crosscheck(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes, CrosscheckStats& stats);

}  // namespace scree
