// Families of random and degenerate pairs for the narrow phase: item n of a family is the same everywhere.
#pragma once

#include "core/rng.hpp"
#include "narrowphase/solid.hpp"

#include <cstdint>

namespace scree::oracle {

struct SolidPair {
  Solid a, b;
  double length;  ///< what rounding is relative to: the largest half extent or radius, and the distance from
                  ///< a boundary's own point (m)
  double smallest;  ///< half extent or radius of the bodies that are no boundaries (m)
};

Vec3 random_unit(Random& random);
Quat random_turn(Random& random);

/// Of two boxes.
enum class Family {
  any,
  shallow,         ///< overlaps of a tenth to a millionth of the size
  aligned,         ///< axes parallel, some of them equal cubes
  yaw,             ///< turned about a common normal
  tilted,          ///< by 1e-1 to 1e-12 rad
  crossed_edges,   ///< edge over edge
  parallel_edges,  ///< likewise, at 1e-1 to 1e-12 rad and at 0
  vertex,          ///< vertex over vertex or over anything
  size_ratio,      ///< 1000 to 1, half of the large ones flat
  coincident,      ///< centres
  scaled,          ///< by 1e-6 to 1e6
  far,             ///< a million sizes from the origin
  count
};
const char* name_of(Family family);

/// The boxes are within a fifth of their size of touching, on either side, but for `shallow` and
/// `coincident`.
SolidPair make_pair(Family family, std::uint64_t n);

/// Pairs with closed forms: at all scales from 1e-6 to 1e6, of sizes up to 1000 to 1, near to and far from
/// the origin; most of them within a tenth of their size of touching. `b` is the box of a sphere, and the
/// boundary.
enum class ClosedForm { sphere_sphere, sphere_box, sphere_plane, box_plane, sphere_tube, box_tube, count };
const char* name_of(ClosedForm form);
SolidPair make_pair(ClosedForm form, std::uint64_t n);

}  // namespace scree::oracle
