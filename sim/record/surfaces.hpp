// The shapes that glyphs do not show, as PolyData of VTK, frame by frame: the surfaces of meshes and
// polyhedra, and the axes of shapes that are round along an axis. Spheres and boxes are glyphs at the points
// of the trajectory.
#pragma once

#include "core/geometry.hpp"
#include "sim/record/export_frame.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace scree {

/// Returns the hull of a body, by its number in the scene. May throw InputError.
using HullOf = std::function<const Hull&(std::int32_t body)>;

/// Whether bodies of a shape are in surfaces_of(), or in axes_of().
bool has_surface(Shape shape);
bool has_axis(Shape shape);

/// The kinds of bodies, each of which has files of its own: bodies that do not move are written once.
enum class Movement { fixed, not_fixed };

/// Returns the triangles of meshes and the faces of polyhedra. The data of the cells are the columns of the
/// frame without position, size and orientation. Throws InputError if the trajectory does not have what is
/// needed.
std::string surfaces_of(const ExportFrame& frame, Movement movement, const HullOf& hull_of);

/// Returns a line along the z axis of each capsule, cylinder and tube, between the ends of the cylinder, or
/// between the centres of the two balls of a capsule. The data of the points are their `radius` (m) and the
/// columns of the frame, as above.
std::string axes_of(const ExportFrame& frame, Movement movement, const HullOf& hull_of);

}  // namespace scree
