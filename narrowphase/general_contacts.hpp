// Contacts of the shapes that have no closed form in both spaces: triangles of meshes, capsules, cylinders
// and polyhedra, with each other and with all other shapes. They are found on Host alone.
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

/// Value of Manifold::part for a manifold whose point is no contact: a triangle is nearest there, but the
/// mesh around it is what touches.
inline constexpr int hidden_part = -1;

struct ContactReach {
  double margin;        ///< largest gap of a contact (m)
  bool hidden = false;  ///< whether manifolds with hidden_part are returned too: a search for a meeting must
                        ///< know their gap
};

/// Finds the contacts of a pair. It sets everything of the pair's manifolds except i and j, and returns their
/// number, at most max_pair_manifolds. At least one of the two shapes is general; surfaces make no contact
/// with each other. Results are never NaN, and no contact is missed: however a normal was found, the gap
/// along it is exact.
int find_general_contacts(const ShapedSolid& a, const ShapedSolid& b, const PairShapes& shapes,
                          const ContactReach& reach, Manifold* out);

}  // namespace scree
