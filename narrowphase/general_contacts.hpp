// Contacts of the shapes that have no closed form in both spaces: triangles of meshes, capsules, cylinders
// and polyhedra, with each other and with all others. On Host alone.
#pragma once

#include "core/bodies.hpp"
#include "core/shape_data.hpp"
#include "narrowphase/contact.hpp"
#include "narrowphase/solid.hpp"

namespace scree {

struct ShapedSolid {
  Shape shape;
  Solid solid;
};

/// Part of a manifold whose point is no contact: where a triangle is nearest, the mesh around it is what
/// touches.
inline constexpr int hidden_part = -1;

struct ContactReach {
  double margin;  ///< largest gap of a contact (m)
  bool hidden =
      false;  ///< whether hidden_part is given too: who searches for a meeting must know how far it is
};

/// Sets everything of the pair's manifolds but i and j, and returns their number, at most max_pair_manifolds.
/// One of the two shapes at least is general; surfaces make no contact with each other. Never NaN; no contact
/// is missed: whichever way a normal was found, the gap along it is exact.
int find_general_contacts(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes,
                          const ContactReach& reach, Manifold* out);

}  // namespace scree
