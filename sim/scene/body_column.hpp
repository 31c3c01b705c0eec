// The columns that a file of bodies may have.
#pragma once

#include <string_view>

namespace scree {

/// The columns of a body file, in the order in which runs write them. Runs write the columns from `hull` on
/// only if a body needs them. Required are x, y and z, and the sizes that the shapes need.
enum class BodyColumn {
  shape,   ///< sphere, box, capsule, cylinder or polyhedron
  radius,  ///< radius of a sphere, capsule or cylinder (m); else empty
  size_x,  ///< full edge lengths of a box (m); of a capsule or cylinder only size_z, its full length; else
           ///< empty
  size_y,
  size_z,
  x,  ///< position of the centre (m); of a polyhedron, of the origin of its points
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
  mass,      ///< mass (kg); empty: from the material's density
  material,  ///< name of one of the scene's materials, or its index among them, from 0
  hull,      ///< OBJ, STL or PLY file, relative to the body file: a polyhedron is the hull of its vertices
  servo_x,   ///< axis along which a servo moves; with servo_force all four or none
  servo_y,
  servo_z,
  servo_force,  ///< force of a servo (N)
};
inline constexpr int body_columns = static_cast<int>(BodyColumn::servo_force) + 1;
std::string_view name_of(BodyColumn column);

/// Returns the column that is `by` columns after another one.
constexpr BodyColumn after(BodyColumn column, int by) {
  return static_cast<BodyColumn>(static_cast<int>(column) + by);
}

}  // namespace scree
