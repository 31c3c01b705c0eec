// Bodies as users of the library see them: plain numbers, in SI units and the world frame.
#pragma once

#include <array>
#include <cstdint>

namespace scree {

enum class Shape : std::uint8_t {
  sphere,  ///< size[0] is the radius
  box,     ///< size holds the half extents
  plane,   ///< half space below the body's z axis through its position; always fixed
  tube,  ///< inside of a cylinder along the body's z axis, with end caps; never free. It acts on bodies whose
         ///< centre is in it. size[0] and size[1] are its radius, size[2] is half its length
  triangle,    ///< one of a mesh; never free. Its corners, in its xy plane: (-size[0], -size[2]),
               ///< (size[0], -size[2]) and (size[1], size[2]); its longest edge is between the first two
  capsule,     ///< all that is within a radius of a segment along the z axis; size holds the half extents
  cylinder,    ///< a solid one along the z axis; size holds the half extents
  polyhedron,  ///< a convex one; size holds the half extents of the box around it whose middle is the centre
               ///< of mass
};

enum class Mobility : std::uint8_t {
  free,        ///< moved by forces and contacts
  fixed,       ///< never moves
  prescribed,  ///< moves as its `motion` says, whatever hits it
  absent,      ///< not there (yet, or any more): touches nothing, counts nowhere
};

using Vector = std::array<double, 3>;  ///< x, y, z

/// One body at one instant. Where it is absent, its motion says nothing.
struct Body {
  std::int32_t id;  ///< its number in the scene, counted from 0; the same for the whole run
  Shape shape;
  Mobility mobility;
  Vector size;                        ///< see Shape (m)
  double mass;                        ///< kg; infinite unless it is free
  Vector position;                    ///< centre of mass (m); of a plane, the point of it nearest the origin
  std::array<double, 4> orientation;  ///< unit quaternion w, x, y, z; body frame (principal axes) to world
  Vector velocity;                    ///< of the centre of mass (m/s)
  Vector spin;                        ///< angular velocity (rad/s)
};

/// What two bodies did to each other in a substep: a contact, by all its points together, or an impact.
struct LoadedContact {
  std::int32_t i;  ///< the two bodies
  std::int32_t j;
  Vector force;  ///< on j, mean over the last substep (N)
  Vector point;  ///< the middle of where it acts (m)
};

}  // namespace scree
