// From one item of `bodies`, or one row of a body file, to the state of one body.
#pragma once

#include "core/bodies.hpp"
#include "core/geometry.hpp"
#include "sim/scene/body_file.hpp"
#include "sim/scene/keys.hpp"

#include <cstdint>

namespace scree {

/// Writes body `id` of the table, the k-th of the entry: everything but its material. The place of a
/// scattered body stays open; that of one that will be emitted is the middle of the emitter's box until then.
/// All draws are from the stream of (seed, id). False if a free body's mass or inertia, or the inverse of
/// one, is not a positive finite number.
/// `hull`: of a polyhedron.
bool make_body(const BodyEntry& entry, std::int64_t k, std::int32_t id, std::uint64_t seed, double density,
               const Hull* hull, BodyTable& bodies);

/// The same of a mesh's triangle.
void make_body(const BodyEntry& entry, const PlacedTriangle& triangle, std::int32_t id, BodyTable& bodies);

/// The same of a row of the entry's file. A shape of the entry is that of each row, its size drawn likewise.
/// A fixed body has no velocity, whatever the row says, and is no servo.
bool make_body(const BodyEntry& entry, const BodyRow& row, std::int32_t id, std::uint64_t seed,
               double density, const Hull* hull, BodyTable& bodies);

/// The motion of one of the entry's bodies.
Motion motion_of(const MotionEntry& entry, std::int32_t body);

}  // namespace scree
