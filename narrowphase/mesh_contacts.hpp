// The contacts of a mesh's triangle, which knows the mesh around it: no normal leaves the mesh's normal cone,
// so that what slides over an edge between triangles feels nothing of it.
#pragma once

#include "narrowphase/general_contacts.hpp"

namespace scree {

/// A sphere and a triangle, both in closed form. Normals are from the sphere to the triangle. True if there
/// is a contact.
bool sphere_triangle(const Solid& sphere, const Solid& triangle, const Surroundings& around,
                     const ContactReach& reach, Manifold& out);

/// Any other convex body and a triangle. The body is on the side of the triangle on which its centre is.
bool convex_triangle(const ShapedSolid& body, const ShapeData* data, const Solid& triangle,
                     const Surroundings& around, const ContactReach& reach, Manifold& out);

}  // namespace scree
