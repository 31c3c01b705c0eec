// Bodies as users of the library get them: plain numbers, in SI units and the world frame.
#pragma once

#include <array>
#include <cstdint>

namespace scree {

enum class Shape : std::uint8_t {
  sphere,  ///< size[0] is the radius
  box,     ///< size holds the half extents
  plane,   ///< the half space below the body's xy plane; always fixed
  tube,    ///< the inside of a cylinder along the body's z axis, with end caps; never free. It acts on bodies
           ///< whose centre is in it. size[0] and size[1] are its radius, size[2] is half its length
  triangle,    ///< a triangle of a mesh; never free. Its corners, in its xy plane: (-size[0], -size[2]),
               ///< (size[0], -size[2]) and (size[1], size[2]); its longest edge is between the first two
  capsule,     ///< all points within a radius of a segment along the z axis; size holds the half extents
  cylinder,    ///< a solid cylinder along the z axis; size holds the half extents
  polyhedron,  ///< a convex polyhedron; size holds the half extents of the box around it whose middle is the
               ///< centre of mass
};

enum class Mobility : std::uint8_t {
  free,        ///< moved by forces and contacts
  fixed,       ///< never moves
  prescribed,  ///< moves as its `motion` says, whatever impulses act on it
  absent,      ///< not in the scene (yet, or any more): touches nothing, and is not counted
};

using Vector = std::array<double, 3>;  ///< x, y, z

/// One body at one instant. While it is absent, its pose and velocities have no meaning.
struct Body {
  std::int32_t id;  ///< number of the body in the scene, counted from 0; constant during the run
  Shape shape;
  Mobility mobility;
  Vector size;                        ///< lengths that describe the shape, see Shape (m)
  double mass;                        ///< kg; infinite unless the body is free
  Vector position;                    ///< centre of mass (m); of a plane, its point nearest to the origin
  std::array<double, 4> orientation;  ///< unit quaternion w, x, y, z; body frame (principal axes) to world
  Vector velocity;                    ///< velocity of the centre of mass (m/s)
  Vector spin;                        ///< angular velocity (rad/s)
};

/// The force between two bodies in a substep: of a contact, summed over its points, or of an impact.
struct LoadedContact {
  std::int32_t i;  ///< numbers of the two bodies
  std::int32_t j;
  Vector force;  ///< force on j, mean over the last substep (N)
  Vector point;  ///< middle of the points where the force acts (m)
};

}  // namespace scree
