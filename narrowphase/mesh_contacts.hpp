// The contacts of a mesh's triangle, which takes the mesh around it into account: no normal leaves the mesh's
// normal cone, so that a body that slides over an edge between triangles meets no bump.
#pragma once

#include "narrowphase/general_contacts.hpp"

namespace scree {

/// Finds the contact of a sphere and a triangle in closed form. The normal points from the sphere to the
/// triangle. Returns true if there is a contact.
bool sphere_triangle(const Solid& sphere, const Solid& triangle, const Surroundings& around,
                     const ContactReach& reach, Manifold& out);

/// Finds the contact of any other convex body and a triangle. The body counts as being on the side of the
/// triangle on which its centre is.
bool convex_triangle(const ShapedSolid& body, const ShapeData* data, const Solid& triangle,
                     const Surroundings& around, const ContactReach& reach, Manifold& out);

}  // namespace scree
