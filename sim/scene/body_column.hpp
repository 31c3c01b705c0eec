// What a column of a file of bodies may say.
#pragma once

#include <string_view>

namespace scree {

/// The columns of a body file, in the order in which runs write them; those from `hull` on, where a body
/// needs them. x, y and z are required, and the sizes that the shapes need.
enum class BodyColumn {
  shape,   ///< sphere, box, capsule, cylinder or polyhedron
  radius,  ///< of a sphere, capsule or cylinder (m); empty for a box
  size_x,  ///< full edge lengths of a box (m), size_z that of a capsule or cylinder; else empty
  size_y,
  size_z,
  x,  ///< of the centre (m)
  y,
  z,
  qw,  ///< orientation, a quaternion of any length but 0; all four or none
  qx,
  qy,
  qz,
  vx,  ///< velocity of the centre (m/s)
  vy,
  vz,
  wx,  ///< spin, world frame (rad/s)
  wy,
  wz,
  mass,      ///< kg; empty: from the material's density
  material,  ///< a name of the scene's materials, or its place among them, from 0
  hull,  ///< of a polyhedron: the OBJ, STL or PLY file whose vertices' hull it is, relative to the body file
  servo_x,  ///< of a servo: the axis along which it moves; with servo_force all four or none
  servo_y,
  servo_z,
  servo_force,  ///< N
};
inline constexpr int body_columns = static_cast<int>(BodyColumn::servo_force) + 1;
std::string_view name_of(BodyColumn column);

/// The column that is so many behind another one.
constexpr BodyColumn after(BodyColumn column, int by) {
  return static_cast<BodyColumn>(static_cast<int>(column) + by);
}

}  // namespace scree
