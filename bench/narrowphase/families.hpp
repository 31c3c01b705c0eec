// Families of random and degenerate pairs for the narrow phase. Item n of a family is the same on every
// machine.
#pragma once

#include "core/rng.hpp"
#include "narrowphase/solid.hpp"

#include <cstdint>

namespace scree::oracle {

struct SolidPair {
  Solid a, b;
  double length;    ///< length to which rounding is relative: the largest half extent or radius, or the
                    ///< distance from a boundary's own point (m)
  double smallest;  ///< smallest half extent or radius of the bodies that are not boundaries (m)
};

Vec3 random_unit(Random& random);
Quat random_turn(Random& random);

/// Families of pairs of two boxes.
enum class Family {
  any,
  shallow,         ///< overlaps of a tenth to a millionth of the size
  aligned,         ///< axes parallel; some of the boxes equal cubes
  yaw,             ///< boxes turned about a common normal
  tilted,          ///< boxes tilted by 1e-1 to 1e-12 rad
  crossed_edges,   ///< edge over edge, at a large angle
  parallel_edges,  ///< edge over edge, at angles of 1e-1 to 1e-12 rad and at 0
  vertex,          ///< vertex over vertex or over any feature
  size_ratio,      ///< sizes of 1000 to 1, half of the large boxes flat
  coincident,      ///< both centres at one point
  scaled,          ///< pairs scaled by 1e-6 to 1e6
  far,             ///< pairs a million sizes from the origin
  count
};
const char* name_of(Family family);

/// Makes a pair of boxes. They are within a fifth of their size of touching, overlapping or not, except in
/// the families `shallow` and `coincident`.
SolidPair make_pair(Family family, std::uint64_t n);

/// Pairs with closed forms. They have all scales from 1e-6 to 1e6 and size ratios up to 1000, near the origin
/// and far from it. Most of them are within a tenth of their size of touching. `b` is the box in
/// `sphere_box`, and the boundary in pairs with a boundary.
enum class ClosedForm { sphere_sphere, sphere_box, sphere_plane, box_plane, sphere_tube, box_tube, count };
const char* name_of(ClosedForm form);
SolidPair make_pair(ClosedForm form, std::uint64_t n);

}  // namespace scree::oracle
