// What stands in no glyph: the surfaces of meshes and polyhedra, and the axes of what is round along one, as
// VTK's PolyData, frame by frame. Spheres and boxes are glyphs of the trajectory's points.
#pragma once

#include "core/geometry.hpp"
#include "sim/record/export_frame.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace scree {

/// The hull of a body, by its number in the scene. May throw InputError.
using HullOf = std::function<const Hull&(std::int32_t body)>;

/// Whether the bodies of a shape are in surfaces_of(), or in axes_of().
bool has_surface(Shape shape);
bool has_axis(Shape shape);

/// Which of the two kinds of bodies a file is about: what does not move is written once.
enum class Movement { fixed, not_fixed };

/// Triangles of meshes and faces of polyhedra. Data of the cells: the frame's columns, but for place, size
/// and orientation. Throws InputError where the trajectory does not have what it needs.
std::string surfaces_of(const ExportFrame& frame, Movement movement, const HullOf& hull_of);

/// Of capsules, cylinders and tubes a line along the z axis between the ends of the cylinder, of a capsule
/// the centres of its two balls. Data of the points: their `radius` (m), and the frame's columns, as above.
std::string axes_of(const ExportFrame& frame, Movement movement, const HullOf& hull_of);

}  // namespace scree
